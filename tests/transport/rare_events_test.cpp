// Events far rarer than one in 2^24, by every method. Nobody can wait for them: the paths here are
// those, out of a thousand million samples, whose random words come out below 2^8, so that what
// decides is uniform in [0, 2^-24) and an event of probability p happens with probability 2^24 p.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "freepath/base/random.h"
#include "freepath/transport/walker.h"
#include "tests/statistics.h"
#include "tests/transport/walk_fixtures.h"

namespace freepath::testing {
namespace {

constexpr uint32_t kPixel = 7;  // repeat_ray()'s
constexpr float kLength = 8;    // of a super-voxel, along the ray

/// Samples whose flight draws a small number for something; philox() finds them.
struct SmallWords {
  uint32_t block;
  uint32_t stream;
  int word;
  std::vector<uint32_t> samples;
};

// The optical depth to the first tentative collision: below 2^-24.
const SmallWords kSmallDepth{
    0, 0, 0, {9248753,   10910901,  16312209,  18790318,  19005033,  39861701,  43854874,
              50671716,  95488926,  96097379,  115411475, 126124857, 131739083, 135125386,
              141319997, 146314078, 161662748, 178369200, 187352755, 200315628, 206803449,
              260710388, 312564118, 313999438, 350506814, 355689447, 400397587, 412514758,
              427583124, 439193088, 450244339, 465496968, 484835046, 499140642, 500922418,
              504132710, 513156421, 522659096, 551197778, 554624237, 567957668, 572942585,
              586214746, 599799652, 605865867, 614902838, 624428326, 692541238}};

// The choice of the event there.
const SmallWords kSmallEvent{
    0, 0, 1, {18714696,  21729302,  24547607,  32847703,  42458746,  48869912,  63651134,
              76855498,  83262559,  95960569,  104333453, 118569528, 126994056, 131143685,
              155817874, 168637549, 240572562, 242549376, 247286985, 272683856, 283982586,
              302168448, 317858243, 336359433, 352583605, 366761180, 379727635, 394284956,
              400909618, 404970665, 405088625, 407155432, 408403021, 420138438, 432423344,
              440726674, 461840194, 469008224, 529986255, 538911149, 542262270, 550803273,
              571685451, 574051015, 587480764, 644153536, 658898492, 659227792}};

// The choice of the component that scatters there.
const SmallWords kSmallComponent{
    1U | 1U << 29, 0, 0, {36132395,  60084638,  77141649,  78941117,  101585660, 143157340,
                          146589893, 178669742, 186900017, 200948832, 201667399, 206180227,
                          223374988, 223986601, 249468544, 297399441, 318322552, 321848528,
                          324686388, 358932449, 401844410, 402030690, 415633396, 416392213,
                          421125527, 425603435, 439924494, 444005172, 480687358, 488114213,
                          495034916, 503196935, 504462537, 527260473, 534868515, 535334544,
                          552107977, 554538617, 566394835, 566599902, 590390013, 618885018,
                          620529374, 650551969, 653510482, 664071281, 681942575, 695672573}};

// The optical depth that is drawn anew at a distance of 16, after the first draw.
const SmallWords kSmallRenewed{
    1U | 3U << 29,
    std::bit_cast<uint32_t>(2 * kLength),
    0,
    {15618213,  24774062,  29055849,  36208731,  48324282,  48495385,  63095104,  96151905,
     98719318,  100972968, 120775013, 121963067, 128764467, 131721873, 150160411, 152771355,
     162922144, 167946644, 197454227, 206282917, 207960799, 212371718, 212608777, 225352507,
     236984157, 274956270, 308022097, 361132836, 365163671, 393496320, 434842859, 445898832,
     490139476, 518091074, 531165437, 531491927, 542381299, 565698752, 568638116, 578993370,
     581141820, 583234692, 585502547, 597645287, 626855591, 667365733, 668552304, 668969092}};

TEST(RareEvents, TheSamplesDrawSmallNumbers) {
  for (const SmallWords* small : {&kSmallDepth, &kSmallEvent, &kSmallComponent, &kSmallRenewed}) {
    ASSERT_GE(small->samples.size(), 40U);
    for (const uint32_t sample : small->samples) {
      EXPECT_LT(philox({small->block, small->stream, sample, kPixel}, {0, 0})[small->word], 256U);
    }
  }
}

/// Whether so many of the samples may be hit by what has the probability p.
void expect_hits(std::size_t hits, const SmallWords& small, double p, const std::string& name) {
  const std::size_t count = small.samples.size();
  EXPECT_GT(binomial_two_sided_p(hits, count, std::min(1.0, std::ldexp(p, 24))), 1e-6)
      << name << ": " << hits << " of " << count << " at p = " << p;
}

/// One flight along x for each sample.
RayStream rays_of(const SmallWords& small, float length) {
  RayStream rays = repeat_ray(Vec3f(-0.5F, 1, 1), Vec3f(1, 0, 0), length, small.samples.size());
  std::copy(small.samples.begin(), small.samples.end(), rays.sample.begin());
  return rays;
}

std::vector<std::string> names_of(std::span<const MethodInfo> infos) {
  std::vector<std::string> names;
  for (const MethodInfo& info : infos) names.emplace_back(info.name);
  return names;
}

/// Methods that meet no null collisions.
bool is_in_double(const std::string& name) {
  return name == "closed-form" || name == "regular" || name == "ray-marching";
}

FlightStream fly(const Medium& medium, const std::string& tracker, const RayStream& rays) {
  WalkSettings settings;
  settings.tracker = tracker;
  settings.interpolation = Interpolation::kNearest;
  settings.absorption = Absorption::kAnalog;
  FlightStream flights;
  WalkStatistics statistics;
  Walker(medium, settings, 0).free_paths(rays, flights, statistics);
  return flights;
}

/// How many of the first values, which are those of flights, are such.
template <class Values, class Value>
std::size_t count_in(const Values& values, std::size_t flights, Value value) {
  return static_cast<std::size_t>(
      std::count(values.begin(), values.begin() + std::ptrdiff_t(flights), value));
}

/// A component of 8 × 8 × 8 voxels for each super-voxel along x, whose density `of(i, voxel)` says.
Component layers(int count, const std::function<float(int, const Vec3i&)>& of, float sigma_a,
                 float sigma_s) {
  Component component;
  component.density = make_field(Vec3i(0), Vec3i(8 * count - 1, 7, 7),
                                 [&](const Vec3i& p) { return of(p.x / 8, p); });
  component.sigma_a = Rgb(sigma_a);
  component.sigma_s = Rgb(sigma_s);
  return component;
}

constexpr float kContrasts[] = {1e-12F, 1e-9F, 5e-9F, 2e-8F, 5e-8F};

// A faint haze in which one voxel is dense: nearly every tentative collision is null.
TEST(RareEvents, HazeBesideADenseVoxelCollidesAsOftenAsItShould) {
  for (const float haze : kContrasts) {
    const Component component = layers(
        1, [&](int, const Vec3i& p) { return p == Vec3i(7) ? 1.0F : haze; }, 4.0F, 6.0F);
    const Medium medium({component}, 8);
    const RayStream rays = rays_of(kSmallEvent, kLength);
    for (const std::string& tracker : names_of(tracker_infos())) {
      if (is_in_double(tracker)) continue;
      const FlightStream flights = fly(medium, tracker, rays);
      const std::size_t passed = count_in(flights.event, rays.size(), Event::kEscape);
      expect_hits(rays.size() - passed, kSmallEvent, haze, tracker);
    }
    WalkSettings settings;
    settings.transmittance = "delta";
    settings.interpolation = Interpolation::kNearest;
    FlightStream flights;
    WalkStatistics statistics;
    Walker(medium, settings, 0).transmittance(rays, flights, statistics);
    expect_hits(count_in(flights.weight[0], rays.size(), 0.0F), kSmallEvent, haze,
                "delta transmittance");
  }
}

TEST(RareEvents, AFaintMediumCollidesAsOftenAsItShould) {
  for (const float depth : kContrasts) {
    const auto one = [](int, const Vec3i&) { return 1.0F; };
    const Medium medium({layers(1, one, 0, depth / kLength)}, 8);
    const RayStream rays = rays_of(kSmallDepth, 1e6F);
    for (const std::string& tracker : names_of(tracker_infos())) {
      const FlightStream flights = fly(medium, tracker, rays);
      expect_hits(count_in(flights.event, rays.size(), Event::kScatter), kSmallDepth, depth,
                  tracker);
    }
  }
}

// Whichever of the two is rare.
TEST(RareEvents, ScatteringBesideAbsorptionIsChosenAsOftenAsItShould) {
  for (const float share : kContrasts) {
    for (const bool scattering : {true, false}) {
      const auto one = [](int, const Vec3i&) { return 1.0F; };
      const float much = 10;
      const float little = much * share;
      const Medium medium({layers(1, one, scattering ? much : little, scattering ? little : much)},
                          8);
      const RayStream rays = rays_of(kSmallEvent, kLength);
      for (const std::string& tracker : names_of(tracker_infos())) {
        if (is_in_double(tracker)) continue;
        const FlightStream flights = fly(medium, tracker, rays);
        expect_hits(
            count_in(flights.event, rays.size(), scattering ? Event::kScatter : Event::kAbsorb),
            kSmallEvent, share, tracker);
      }
    }
  }
}

// The first of two components, and the last.
TEST(RareEvents, AFaintComponentScattersAsOftenAsItShould) {
  for (const float share : kContrasts) {
    for (const int faint : {0, 1}) {
      std::vector<Component> components;
      for (int k = 0; k < 2; ++k) {
        components.push_back(layers(
            1, [&](int, const Vec3i&) { return k == faint ? share : 1.0F; }, 0, 10));
      }
      const Medium medium(components, 8);
      for (const std::string& tracker : names_of(tracker_infos())) {
        if (is_in_double(tracker)) continue;
        // One look-up a collision: the component is drawn with the rate.
        const SmallWords& small = tracker == "multi-volume" ? kSmallEvent : kSmallComponent;
        const FlightStream flights = fly(medium, tracker, rays_of(small, kLength));
        EXPECT_EQ(count_in(flights.event, small.samples.size(), Event::kScatter),
                  small.samples.size())
            << tracker;
        expect_hits(count_in(flights.component, small.samples.size(), faint), small, share,
                    tracker);
      }
    }
  }
}

// What is left of an optical depth has the digits of what was drawn. The bounds of the second layer
// are those of the first too, whose voxels a filter may read from there.
TEST(RareEvents, HazeBehindADenseLayerCollidesAsOftenAsItShould) {
  for (const float depth : kContrasts) {
    const float dense = 1.0F / 64;  // lets nearly all pass, and leaves 24 bits of what is left
    const Component component = layers(
        3, [&](int layer, const Vec3i&) { return layer == 0 ? 1.0F : depth / dense; }, 0,
        dense / kLength);
    const Medium medium({component}, 8);
    const RayStream rays = rays_of(kSmallRenewed, 3 * kLength);
    for (const std::string& tracker : names_of(tracker_infos())) {
      if (is_in_double(tracker)) continue;
      const FlightStream flights = fly(medium, tracker, rays);
      std::size_t hits = 0;
      std::size_t reached = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (flights.t[i] < 2 * kLength) continue;
        ++reached;
        if (flights.event[i] == Event::kScatter) ++hits;
      }
      EXPECT_GT(reached, rays.size() * 9 / 10) << tracker;
      EXPECT_GT(binomial_two_sided_p(hits, reached, std::min(1.0, std::ldexp(double(depth), 24))),
                1e-6)
          << tracker << ": " << hits << " of " << reached << " at a depth of " << depth;
    }
  }
}

}  // namespace
}  // namespace freepath::testing
