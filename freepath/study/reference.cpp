#include "freepath/study/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/base/version.h"
#include "freepath/io/content_digest.h"
#include "freepath/io/image.h"

namespace freepath {
namespace {

namespace fs = std::filesystem;

/// Apart from those of the runs, whatever their seed.
constexpr uint64_t kReferenceSeed = 0x9E3779B97F4A7C15U;

Reference read_reference(const std::string& file, const RenderTarget& target) {
  Reference reference;
  const Image image = read_image(file);
  if (image.width != target.width || image.height != target.height) {
    fail("{}: the reference has {}x{} pixels and the pictures have {}x{}; give --size {}x{}", file,
         image.width, image.height, target.width, target.height, image.width, image.height);
  }
  reference.estimates = estimates_of(image, file, reference.variance_known);
  if (!are_same(reference.estimates.chromaticities.value_or(RgbChromaticities()),
                target.chromaticities.value_or(RgbChromaticities()))) {
    fail("{}: the reference and the pictures have R, G and B of different colour spaces", file);
  }
  const auto& samples = reference.estimates.samples;
  const auto without = std::count(samples.begin(), samples.end(), 0.0F);
  if (without > 0) {
    fail("{}: {}; render it again, with more time", file,
         counted(without, "pixel of the reference has no sample",
                 "pixels of the reference have no sample"));
  }
  const auto is_infinite = [](float variance) { return !std::isfinite(variance); };
  const auto& variance = reference.estimates.variance;
  if (std::any_of(variance.begin(), variance.end(), is_infinite)) {
    fail("{}: the variance of the reference is infinite; render it by another method", file);
  }
  reference.origin = file;
  if (!reference.variance_known) {
    reference.origin += ", taken for exact: it has neither variances nor halves";
  }
  return reference;
}

/// What tells one reference from all others.
std::string key_of(const RenderTarget& target, const ReferencePlan& plan,
                   const Configuration& configuration) {
  const bool nearest = configuration.interpolation == Interpolation::kNearest;
  ContentDigest digest;
  digest.add(fmt::format("freepath {}", version()));
  // Another build may compute another picture.
  constexpr const char* kThisProgram = "/proc/self/exe";
  std::error_code ignored;
  if (fs::exists(kThisProgram, ignored)) digest.add_file(kThisProgram);
  digest.add(target.digest);
  digest.add(fmt::format("{}x{}", target.width, target.height));
  digest.add(nearest ? "nearest" : "trilinear");
  digest.add(fmt::format("{} {} {} {}", configuration.tracker, configuration.transmittance,
                         plan.time, plan.samples));
  return digest.hex();
}

Reference make_reference(const RenderTarget& target, const ReferencePlan& plan,
                         const Configuration& configuration, RenderSettings settings,
                         const ProgressFunction& progress) {
  settings.samples = plan.samples;
  settings.time_limit = plan.time;
  settings.whole_passes = true;
  settings.layers = {Layer::kVariance, Layer::kSamples};
  settings.walk.tracker = configuration.tracker;
  settings.walk.transmittance = configuration.transmittance;
  settings.walk.interpolation = configuration.interpolation;
  settings.walk.seed = kReferenceSeed;
  const auto& render = target.render_reference ? target.render_reference : target.render;
  const RenderResult result = render(settings, progress);
  if (result.interrupted) return {};
  Reference reference{.estimates = estimates_of(result.film)};
  const std::vector<float>& variance = reference.estimates.variance;
  if (!std::all_of(variance.begin(), variance.end(), [](float v) { return std::isfinite(v); })) {
    fail("the reference by {} has an infinite variance; take another method or file for it",
         configuration.tracker);
  }
  reference.origin =
      fmt::format("made with {} and {}, {} per pixel in {:.1f} s", configuration.tracker,
                  configuration.transmittance, counted(result.samples, "sample"), result.seconds);
  return reference;
}

}  // namespace

std::string standard_reference_cache() {
  const auto variable = [](const char* name) {
    const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
    return std::string(value != nullptr ? value : "");
  };
  const std::string cache = variable("XDG_CACHE_HOME");
  const std::string home = variable("HOME");
  if (!cache.empty()) return (fs::path(cache) / "freepath" / "references").string();
  if (!home.empty()) return (fs::path(home) / ".cache" / "freepath" / "references").string();
  return {};
}

Reference get_reference(const RenderTarget& target, const ReferencePlan& plan,
                        const Configuration& configuration, RenderSettings settings,
                        const ProgressFunction& progress) {
  if (!plan.file.empty()) return read_reference(plan.file, target);
  std::string cached;
  if (!plan.cache.empty()) {
    cached = (fs::path(plan.cache) / (key_of(target, plan, configuration) + ".exr")).string();
    std::error_code ignored;
    if (fs::exists(cached, ignored)) {
      try {
        Reference reference = read_reference(cached, target);
        reference.origin = "found in " + cached;
        return reference;
      } catch (const Error&) {
        // Damaged: it is made again, and replaced.
      }
    }
  }
  Reference reference = make_reference(target, plan, configuration, std::move(settings), progress);
  if (!cached.empty() && !reference.estimates.mean.empty()) {
    try {
      std::error_code ignored;
      fs::create_directories(plan.cache, ignored);
      write_exr(cached, to_image(reference.estimates));
      reference.origin += ", kept in " + cached;
    } catch (const Error& error) {
      reference.origin += fmt::format(", not kept: {}", error.what());
    }
  }
  return reference;
}

}  // namespace freepath
