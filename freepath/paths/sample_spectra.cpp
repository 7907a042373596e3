#include "freepath/paths/sample_spectra.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/random.h"
#include "freepath/base/reversed_bits.h"

namespace freepath {
namespace {

/// Wavelengths of a block. What a quadrature over them misses is common to all pixels, and has to
/// be small against the noise of the mean of a picture: 256 are, up to a thousand million paths
/// under daylight. Where walkers are not shared, flights are walked in as many streams as there are
/// sets, and small pictures have fewer.
constexpr int kNodes = 256;
constexpr int kFewestNodes = 64;
constexpr double kManyPixels = 65536;
/// Sets whose voxels are copies of their own take memory, of which a block may have so much.
constexpr uint32_t kFewestSets = 4;
constexpr std::size_t kLargestBlock = std::size_t{256} << 20;  // [bytes]

/// The index in binary, mirrored at the point: [0, 1).
double van_der_corput(uint32_t index) { return reversed_bits(index) * 0x1p-32; }

/// Channels of different extinction.
MediumChannels coloured_channels() {
  MediumChannels coloured;
  coloured.count = 3;
  coloured.components.emplace_back().sigma_s = {1, 2, 3};
  return coloured;
}

/// Whether one path carries channels of different extinction.
bool carries_colours(const WalkSettings& walk) { return shares_paths(coloured_channels(), walk); }

/// Whether so much of a medium glows that its paths find the light without a guide: lines of their
/// own cost half as much again. The volume that counts is that of as many equally bright cells.
bool is_spread(const EmissionCells& cells, const SceneMedium& medium) {
  constexpr double kSpread = 0.05;
  double sum = 0;
  double squares = 0;
  for (const float power : cells.power) {
    sum += power;
    squares += double{power} * power;
  }
  if (squares == 0) return true;
  const Vec3d size = medium.bounds().size();
  return sum * sum / squares * cells.grid.cell_volume() > kSpread * size.x * size.y * size.z;
}

/// Any number of a stream that nothing else uses.
double shift_of(uint64_t seed) {
  RandomStream random(seed, 0xFFFFFFFFU, 0xFFFFFFFFU, 0xFFFFFFFFU);
  return random.uniform();
}

}  // namespace

WavelengthSampler::WavelengthSampler(const PathScene& scene, ColorMode mode, int wavelengths,
                                     const WalkSettings& walk, bool chooses_transmittance,
                                     WavelengthDensity density)
    : scene_(scene),
      mode_(mode),
      wavelengths_(wavelengths),
      walk_(walk),
      chooses_transmittance_(chooses_transmittance),
      density_(density),
      combinations_(scene.media.size()) {
  if (wavelengths < 1 || wavelengths > kMaxChannels) {
    fail("a path carries 1 to {} wavelengths, not {}; CMake's FREEPATH_MAX_CHANNELS sets how many",
         kMaxChannels, wavelengths);
  }
  const SpectrumValues first =
      mode == ColorMode::kRgb ? scene.spectra->in_rgb() : spectra_of_set(0);
  for (const SceneMedium& medium : scene.media) {
    // Extinctions that are equal at the wavelengths of one sample may differ at those of others.
    const bool shares = mode == ColorMode::kRgb || medium.is_grey(*scene.spectra)
                            ? shares_paths(medium.bind(first).channels, walk)
                            : carries_colours(walk);
    if (!shares) paths_per_sample_ = first.channels();
  }
  find_weight_growth(first);
  constant_.resize(scene.media.size());
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    std::shared_ptr<const MediumWalkers> walkers = make_walkers(i, first);
    const bool grey =
        walkers->bound.channels.is_grey() && scene.media[i].is_constant(*scene.spectra);
    if (grey || mode == ColorMode::kRgb) {
      constant_[i] = std::move(walkers);
    } else {
      depends_on_wavelengths_ = true;
    }
  }
  sees_rgb_ = paths_per_sample_ == 1 &&
              (mode == ColorMode::kRgb ||
               std::all_of(scene.media.begin(), scene.media.end(), [&](const SceneMedium& medium) {
                 return medium.is_grey(*scene.spectra);
               }));
  rgb_ = mode == ColorMode::kRgb ? make(first)
                                 : std::make_shared<const SampleSpectra>(
                                       *this, scene.spectra->seen_in_rgb(),
                                       std::vector<std::shared_ptr<const MediumWalkers>>{});
  sets_per_block_ = choose_sets_per_block();
  make_guides();
}

uint32_t WavelengthSampler::choose_sets_per_block() const {
  if (mode_ == ColorMode::kRgb) return 1;
  const double pixels = double(scene_.camera->width()) * scene_.camera->height();
  const int nodes = depends_on_wavelengths_ && pixels < kManyPixels ? kFewestNodes : kNodes;
  auto sets = std::bit_ceil(static_cast<uint32_t>((nodes + wavelengths_ - 1) / wavelengths_));
  std::size_t bytes = 0;
  for (const SceneMedium& medium : scene_.media) bytes += medium.bytes_of_set(wavelengths_);
  while (sets > kFewestSets && sets * bytes > kLargestBlock) sets /= 2;
  return sets;
}

uint32_t WavelengthSampler::set_of(uint32_t pixel, uint32_t sample, SampleShare share) const {
  const uint32_t round = share.is_one() ? sample : share.round_of(sample);
  if (sets_per_block_ == 1) return round;
  const uint32_t block = round / sets_per_block_;
  // Of a stream that nothing else uses.
  RandomStream random(walk_.seed, pixel, block, 0xFFFFFFFEU);
  const uint32_t bits = reversed_bits(sample) ^ random.bits();
  return block * sets_per_block_ + (bits >> (32 - std::countr_zero(sets_per_block_)));
}

void WavelengthSampler::find_weight_growth(const SpectrumValues& first) {
  for (const SceneMedium& medium : scene_.media) {
    // Wavelengths of other samples may differ more than those of the first.
    const bool known = mode_ == ColorMode::kRgb || medium.is_grey(*scene_.spectra);
    const MediumChannels all = known ? medium.bind(first).channels : coloured_channels();
    const WeightGrowth growth =
        freepath::weight_growth(paths_per_sample_ == 1 ? all : all.only(0), walk_);
    if (growth.per_flight > weight_growth_.per_flight) weight_growth_ = growth;
  }
}

BoundMedium WavelengthSampler::bound_in_rgb(std::size_t medium) const {
  if (mode_ == ColorMode::kRgb) return constant_[medium]->bound;
  return scene_.media[medium].bind(scene_.spectra->in_rgb());
}

void WavelengthSampler::make_guides() {
  // What is made for R, G and B serves any wavelengths: a guide need not be exact, and where it
  // does not lead, paths still go.
  for (std::size_t i = 0; i < scene_.media.size(); ++i) {
    std::unique_ptr<const EmissionGuide>& guide = guides_.emplace_back();
    const std::shared_ptr<const MediumWalkers>& walkers = constant_[i];
    if (walkers && !walkers->bound.channels.emits()) {
      glow_is_spread_.push_back(true);
      continue;
    }
    guide = std::make_unique<const EmissionGuide>(bound_in_rgb(i), scene_.origin);
    glow_is_spread_.push_back(is_spread(guide->cells(), scene_.media[i]));
    if (!(guide->power() > 0)) guide.reset();
  }
}

SpectrumValues WavelengthSampler::spectra_of_set(uint32_t set) const {
  const double node =
      static_cast<double>(set % sets_per_block_) + van_der_corput(set / sets_per_block_);
  double u = shift_of(walk_.seed) + node / (static_cast<double>(sets_per_block_) * wavelengths_);
  u -= std::floor(u);
  return scene_.spectra->at(
      sample_wavelengths<kMaxChannels>(u, density_, static_cast<std::size_t>(wavelengths_)));
}

std::shared_ptr<const MediumWalkers> WavelengthSampler::make_walkers(
    std::size_t medium, const SpectrumValues& spectra) const {
  auto result = std::make_shared<MediumWalkers>();
  result->bound = scene_.media[medium].bind(spectra);
  add_walkers(*result, scene_.media[medium].is_homogeneous());
  return result;
}

void WavelengthSampler::add_walkers(MediumWalkers& walkers, bool is_homogeneous) const {
  WalkSettings settings = walk_;
  // Which has no variance where the least extinction is all there is.
  if (chooses_transmittance_ && is_homogeneous) settings.transmittance = "residual-ratio";
  settings.origin = scene_.origin;
  const MediumChannels& channels = walkers.bound.channels;
  if (paths_per_sample_ == 1) {
    walkers.walkers.emplace_back(*walkers.bound.medium, channels, settings);
  } else {
    for (int c = 0; c < channels.count; ++c) {
      walkers.walkers.emplace_back(*walkers.bound.medium, channels.only(c), settings);
    }
  }
}

std::shared_ptr<const Medium> WavelengthSampler::combined_medium(
    MediumId combination, const std::vector<std::shared_ptr<const Medium>>& media) const {
  {
    const std::shared_lock lock(mutex_);
    const auto found = combined_media_.find(combination);
    if (found != combined_media_.end() && found->second.media == media) {
      return found->second.medium;
    }
  }
  std::shared_ptr<const Medium> medium = combine_media(media);
  const std::unique_lock lock(mutex_);
  combined_media_[combination] = {media, medium};
  return medium;
}

std::shared_ptr<const MediumWalkers> WavelengthSampler::make_combination(
    MediumId combination, const SampleSpectra& colors) const {
  auto result = std::make_shared<MediumWalkers>();
  std::vector<std::shared_ptr<const Medium>> media;
  std::string names;
  for (const MediumId member : combinations_.members(combination)) {
    const BoundMedium& bound = colors.media[member]->bound;
    media.push_back(bound.medium);
    names += (names.empty() ? "'" : ", '") + scene_.media[member].name() + "'";
    MediumChannels& channels = result->bound.channels;
    channels.count = bound.channels.count;
    for (uint32_t k = 0; k < bound.channels.components.size(); ++k) {
      channels.components.push_back(bound.channels.components[k]);
      result->origins.push_back({member, k});
    }
  }
  try {
    result->bound.medium = combined_medium(combination, media);
    add_walkers(*result, false);
  } catch (const Error& error) {
    fail(
        "the media {} overlap at a place and can't be rendered together ({}); let the boundary of "
        "one name the other as what is outside",
        names, error.what());
  }
  return result;
}

std::shared_ptr<const MediumWalkers> WavelengthSampler::combine(MediumId combination,
                                                                const SampleSpectra& colors) const {
  const std::vector<MediumId> members = combinations_.members(combination);
  const bool is_constant = std::all_of(members.begin(), members.end(), [&](MediumId member) {
    return constant_[member] != nullptr;
  });
  if (is_constant) {
    const std::shared_lock lock(mutex_);
    const auto found = constant_combinations_.find(combination);
    if (found != constant_combinations_.end()) return found->second;
  }
  // Builders run in parallel: no task of rendering may come in between.
  std::shared_ptr<const MediumWalkers> made;
  tbb::this_task_arena::isolate([&] { made = make_combination(combination, colors); });
  if (!is_constant) return made;
  const std::unique_lock lock(mutex_);
  return constant_combinations_.try_emplace(combination, std::move(made)).first->second;
}

const MediumWalkers& SampleSpectra::combination(MediumId medium) const {
  {
    const std::shared_lock lock(mutex_);
    const auto found = combinations_.find(medium);
    if (found != combinations_.end()) return *found->second;
  }
  std::shared_ptr<const MediumWalkers> made = factory_.combine(medium, *this);
  const std::unique_lock lock(mutex_);
  return *combinations_.try_emplace(medium, std::move(made)).first->second;
}

std::shared_ptr<const SampleSpectra> WavelengthSampler::make(SpectrumValues spectra) const {
  std::vector<std::shared_ptr<const MediumWalkers>> media;
  for (std::size_t i = 0; i < scene_.media.size(); ++i) {
    media.push_back(constant_[i] ? constant_[i] : make_walkers(i, spectra));
  }
  return std::make_shared<const SampleSpectra>(*this, std::move(spectra), std::move(media));
}

std::shared_ptr<const SampleSpectra> WavelengthSampler::colors_of_set(uint32_t set) const {
  return mode_ == ColorMode::kRgb ? rgb_ : make(spectra_of_set(set));
}

}  // namespace freepath
