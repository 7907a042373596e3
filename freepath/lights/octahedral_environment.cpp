#include "freepath/lights/octahedral_environment.h"

#include <numeric>

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
  const double texels = static_cast<double>(size_) * size_;
  double sum = std::accumulate(importance.begin(), importance.end(), 0.0);
  fluence_ = 4 * std::numbers::pi * sum / texels;
  if (sum == 0) {  // a black image is sampled uniformly
    std::fill(importance.begin(), importance.end(), 1.0);
    sum = texels;
  }
  std::vector<double> row_sums(size);
  columns_.reserve(importance.size());
  for (std::size_t row = 0; row < size; ++row) {
    const std::span<const double> pixels(importance.data() + row * size, size);
    row_sums[row] = std::accumulate(pixels.begin(), pixels.end(), 0.0);
    if (row_sums[row] > 0) {
      const std::vector<AliasEntry> table = make_alias_table(pixels);
      columns_.insert(columns_.end(), table.begin(), table.end());
    } else {
      columns_.insert(columns_.end(), size, AliasEntry{1, 0});  // a row that is never chosen
    }
  }
  rows_ = make_alias_table(row_sums);
  pdf_.reserve(importance.size());
  for (const double value : importance) {
    pdf_.push_back(static_cast<float>(value / sum * texels / (4 * std::numbers::pi)));
  }
}

}  // namespace freepath
