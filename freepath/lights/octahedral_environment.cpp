#include "freepath/lights/octahedral_environment.h"

#include <numeric>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/lights/photometry.h"

namespace freepath {

OctahedralEnvironment::OctahedralEnvironment(const Image& image, const Vec3f& luminance_weights,
                                             const std::string& name)
    : size_(image.width) {
  check_octahedral(image, name);
  radiance_ = light_colours(image, name);
  const auto size = static_cast<std::size_t>(size_);
  std::vector<double> importance(size * size);
  for (int row = 0; row < size_; ++row) {
    for (int column = 0; column < size_; ++column) {
      // Some spaces give blue a negative luminance, yet it is light.
      const Vec3f& colour = radiance_[texel(column, row)];
      constexpr float kLeast = 1e-3F;
      importance[texel(column, row)] =
          std::max(colour.dot(luminance_weights), kLeast * (colour.x + colour.y + colour.z));
    }
  }
  const double solid_angle = 4 * std::numbers::pi / (static_cast<double>(size_) * size_);
  fluence_ = solid_angle * std::accumulate(importance.begin(), importance.end(), 0.0);
  draws_ = {std::move(importance), std::vector<double>(size, solid_angle)};
}

}  // namespace freepath
