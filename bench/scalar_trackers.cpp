#include "bench/scalar_trackers.h"

#include <span>
#include <utility>

#include "bench/scalar_free_paths.h"
#include "bench/scalar_loop.h"
#include "bench/scalar_transmittance.h"
#include "freepath/base/error.h"

namespace freepath::bench {
namespace {

using RunFunction = void (*)(const ScalarMedium&, const RayStream&, std::vector<ScalarFlight>&);

/// A method's loops.
struct Loop {
  const char* name;
  int channels;
  RunFunction trilinear;
  RunFunction stochastic;
};

template <class Method>
constexpr Loop loop(const char* name) {
  return {name, Method::kChannelCount, fly_all<Method, Interpolation::kTrilinear>,
          fly_all<Method, Interpolation::kStochastic>};
}

constexpr Loop kFreePaths[] = {
    loop<ScalarDelta>("delta"),
    loop<ScalarWeightedDelta>("weighted-delta"),
    loop<ScalarMultiVolume>("multi-volume"),
    loop<ScalarDecomposition>("decomposition"),
    loop<ScalarWeightedDecomposition>("weighted-decomposition"),
    loop<ScalarSpectral<1>>("spectral"),
    loop<ScalarSpectral<kChannels>>("spectral"),
    loop<ScalarSpectralDecomposition<1>>("spectral-decomposition"),
    loop<ScalarSpectralDecomposition<kChannels>>("spectral-decomposition"),
    loop<ScalarDelta>("hero-wavelength"),
    loop<ScalarDelta>("per-wavelength"),
};

constexpr Loop kTransmittance[] = {
    loop<ScalarRatio>("ratio"),
    loop<ScalarDeltaTransmittance>("delta"),
    loop<ScalarResidualRatio>("residual-ratio"),
    loop<ScalarNextFlight>("next-flight"),
};

const Loop* find_loop(const std::string& method, bool free_paths, int channels) {
  const auto loops =
      free_paths ? std::span<const Loop>(kFreePaths) : std::span<const Loop>(kTransmittance);
  for (const Loop& loop : loops) {
    if (loop.name == method && loop.channels == channels) return &loop;
  }
  return nullptr;
}

}  // namespace

bool has_scalar_loop(const std::string& method, bool free_paths, int channels) {
  return find_loop(method, free_paths, channels) != nullptr;
}

std::shared_ptr<const ScalarMedium> make_scalar_medium(const Medium& medium) {
  return std::make_shared<ScalarMedium>(medium);
}

ScalarWalk::ScalarWalk(std::shared_ptr<const ScalarMedium> medium, const ScalarSettings& settings)
    : medium_(std::move(medium)) {
  const Loop* loop = find_loop(settings.method, settings.free_paths, settings.channels);
  if (loop == nullptr) {
    fail("there is no scalar loop '{}' of {} channels", settings.method, settings.channels);
  }
  if (medium_->components.size() > 1 && settings.method != "multi-volume") {
    fail("the scalar loop '{}' takes one component alone", settings.method);
  }
  const bool trilinear = settings.interpolation == Interpolation::kTrilinear;
  function_ = trilinear ? loop->trilinear : loop->stochastic;
}

void ScalarWalk::run(const RayStream& rays, std::vector<ScalarFlight>& flights) const {
  function_(*medium_, rays, flights);
}

}  // namespace freepath::bench
