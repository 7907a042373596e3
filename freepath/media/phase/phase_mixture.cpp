#include "freepath/media/phase/phase_mixture.h"

#include <cstddef>
#include <utility>

#include "freepath/media/phase/phase_function.h"
#include "freepath/media/phase/stretched.h"

namespace freepath {

PhaseMixture::PhaseMixture(std::vector<Part> parts)
    : parts_(std::make_shared<const std::vector<Part>>(std::move(parts))) {}

float PhaseMixture::evaluate(const Vec3f& before, const Vec3f& after) const {
  float sum = 0.0F;
  for (const Part& part : *parts_) sum += part.weight * part.function.evaluate(before, after);
  return sum;
}

PhaseSample PhaseMixture::sample(const Vec3f& before, float u1, float u2) const {
  // The azimuth pays for the choice: it needs fewer digits than the angle from a peak.
  const std::vector<Part>& parts = *parts_;
  std::size_t i = parts.size() - 1;
  while (i > 0 && u2 < parts[i].begin) --i;
  const Part& part = parts[i];
  const Vec3f direction =
      part.function.sample(before, u1, stretched(u2, part.begin, part.weight)).direction;
  return {direction, evaluate(before, direction)};
}

float PhaseMixture::mean_cosine() const {
  float sum = 0.0F;
  for (const Part& part : *parts_) sum += part.weight * part.function.mean_cosine();
  return sum;
}

}  // namespace freepath
