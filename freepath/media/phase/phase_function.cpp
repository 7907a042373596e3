#include "freepath/media/phase/phase_function.h"

#include <cmath>

#include "freepath/base/error.h"

namespace freepath {
namespace {

void require_g(const char* name, float g) {
  if (!(std::abs(g) < 1.0F)) fail("{}: g must lie between -1 and 1, and is {}", name, g);
}

float mean_cosine_of(const HenyeyGreenstein& function) { return function.g(); }
template <class T>
float mean_cosine_of(const T& function) {
  return function.mean_cosine();
}

}  // namespace

PhaseFunction PhaseFunction::henyey_greenstein(float g) {
  require_g("henyey-greenstein", g);
  return PhaseFunction(HenyeyGreenstein(g));
}

PhaseFunction PhaseFunction::draine(float g, float alpha) {
  require_g("draine", g);
  if (!(alpha >= 0.0F && std::isfinite(alpha))) {
    fail("draine: alpha must be 0 or more, and is {}", alpha);
  }
  return PhaseFunction(Draine(g, alpha));
}

PhaseFunction PhaseFunction::droplets(float diameter) {
  if (!(diameter > 0.0F && diameter <= Droplets::kLargestDiameter)) {
    fail("droplets: the diameter must be above 0 and at most {} micrometres, and is {}",
         Droplets::kLargestDiameter, diameter);
  }
  return PhaseFunction(Droplets(diameter));
}

PhaseFunction PhaseFunction::tabulated(std::span<const PhaseTablePoint> points) {
  if (const auto fault = find_fault(points)) {
    fail("phase table, point {}: {}", fault->point, fault->what);
  }
  return PhaseFunction(TabulatedPhase(points));
}

PhaseFunction PhaseFunction::mixture(const std::vector<std::pair<float, PhaseFunction>>& parts) {
  constexpr double kTolerance = 1e-4;
  double sum = 0.0;
  for (const auto& part : parts) {
    if (!(part.first >= 0.0F && std::isfinite(part.first))) {
      fail("a mixture of phase functions: the weight {} is negative or not finite", part.first);
    }
    sum += part.first;
  }
  if (!(std::abs(sum - 1.0) <= kTolerance)) {
    fail("a mixture of phase functions: the weights must sum to 1, and sum to {:.6g}", sum);
  }
  std::vector<PhaseMixture::Part> lobes;
  double begin = 0.0;
  for (const auto& [weight, function] : parts) {
    if (weight == 0.0F) continue;
    const double share = weight / sum;
    lobes.push_back({static_cast<float>(share), static_cast<float>(begin), function});
    begin += share;
  }
  if (lobes.size() == 1) return lobes.front().function;
  return PhaseFunction(PhaseMixture(std::move(lobes)));
}

float PhaseFunction::evaluate_other(const Vec3f& before, const Vec3f& after) const {
  return std::visit([&](const auto& function) { return function.evaluate(before, after); },
                    function_);
}

PhaseSample PhaseFunction::sample_other(const Vec3f& before, float u1, float u2) const {
  return std::visit([&](const auto& function) { return function.sample(before, u1, u2); },
                    function_);
}

float PhaseFunction::mean_cosine() const {
  return std::visit([](const auto& function) { return mean_cosine_of(function); }, function_);
}

}  // namespace freepath
