// Branches of the paths of a PathWavefront into the lobes around a sun.

#include "freepath/paths/path_wavefront.h"

namespace freepath {
namespace {

/// Sets the key of a branch apart from whatever else is drawn in its place.
constexpr uint32_t kBranchKeys = 0x4C4F4245U;

}  // namespace

void PathWavefront::split(std::size_t i, ScenePath& path, const Vec3f& dominant) {
  const float chance = scatterings_.lobe_chance[i];
  std::vector<LobeBranch>& waiting = branches_of(path);
  if (!(chance > 0) || waiting.size() == kMostBranches ||
      path.scatterings >= setup_.max_scatterings) {
    return;
  }
  const Scattering& scattering = scattered_[i];
  const auto vector_of = [&](const std::array<ScatteringStream::Row<float>, 3>& rows) {
    return Vec3f(rows[0][i], rows[1][i], rows[2][i]);
  };
  const auto share_of = [&](float drawn, const Vec3f& direction) {
    return drawn / (drawn + chance * scattering.phase->evaluate(dominant, direction));
  };
  const SampledSpectrum throughput = path.throughput * path.sun_share;
  const float share = share_of(scatterings_.next_pdf[i], vector_of(scatterings_.next));
  if (path.is_branch) {
    path.throughput *= share;
  } else {
    path.sun_share *= share;
  }
  // The other end of the numbers is the shadow ray's.
  if (scatterings_.numbers[kShadowNumber][i] < 1 - chance) return;
  const auto low = static_cast<uint32_t>(setup_.seed);
  const auto high = static_cast<uint32_t>(setup_.seed >> 32);
  const uint32_t key =
      philox({path.sample_key, path.flights, path.pixel, kBranchKeys}, {low, high})[0];
  RandomStream random(setup_.seed, path.pixel, key, stream_number(StreamPurpose::kScatter, 0));
  // Braces keep the order of draws.
  const std::array<float, 2> u{random.uniform(), random.uniform()};
  LobeBranch branch{.origin = vector_of(scatterings_.position),
                    .direction = scattering.phase->sample(dominant, u[0], u[1]).direction,
                    .density = path.density,
                    .sample_key = key,
                    .scatterings = path.scatterings,
                    .media = path.media,
                    .hero = path.hero,
                    .only_hero = path.only_hero,
                    .is_coloured = path.is_coloured};
  branch.pdf = scattering.phase->evaluate(vector_of(scatterings_.direction), branch.direction);
  branch.throughput = throughput * share_of(branch.pdf, branch.direction);
  if (is_black(branch.throughput)) return;
  waiting.push_back(branch);
}

bool PathWavefront::take_lobe_branch(ScenePath& path) {
  if (branches_.empty()) return false;
  std::vector<LobeBranch>& waiting = branches_of(path);
  if (waiting.empty()) return false;
  if (jobs_.layers.on()) {
    jobs_.layers.end_part(path.result, path.scatterings, rgb_of(path, path.radiance, path.rgb));
  }
  const LobeBranch& branch = waiting.back();
  path.sample_key = branch.sample_key;
  path.flights = 0;
  turn(path, branch.origin, branch.origin, branch.direction);
  path.throughput = branch.throughput;
  path.density = branch.density;
  path.scatterings = branch.scatterings;
  path.pdf = branch.pdf;
  path.sun_share = 1;
  path.is_branch = true;
  path.glass = nullptr;  // the light of lamps is not its
  path.is_from_medium = false;
  path.hero = branch.hero;
  path.only_hero = branch.only_hero;
  path.is_coloured = branch.is_coloured;
  path.is_dead = path.is_sent = false;
  set_media(path, branch.media);
  waiting.pop_back();
  return true;
}

}  // namespace freepath
