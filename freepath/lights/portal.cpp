#include "freepath/lights/portal.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "freepath/base/error.h"

namespace freepath {
namespace {

/// The point of [low, high] where an increasing function, linear between whole numbers, reaches a
/// target.
template <class Function>
double reach(const Function& integral, double low, double high, double target) {
  auto first = static_cast<int>(std::floor(low));
  auto last = static_cast<int>(std::ceil(high));
  while (last - first > 1) {
    const int middle = first + (last - first) / 2;
    (integral(static_cast<double>(middle)) <= target ? first : last) = middle;
  }
  const double left = std::max(low, static_cast<double>(first));
  const double right = std::min(high, static_cast<double>(last));
  const double before = integral(left);
  const double within = integral(right) - before;
  const double share = within > 0 ? std::clamp((target - before) / within, 0.0, 1.0) : 0.5;
  return left + (right - left) * share;
}

}  // namespace

Portal::Portal(const PortalCorners& corners, const Vec3d& origin,
               const std::function<double(const Vec3f&)>& brightness, int cells,
               const std::string& name)
    : first_(corners[0] - origin), opposite_(corners[2] - origin), cells_(cells) {
  const Vec3d across = corners[3] - corners[0];
  const Vec3d up = corners[1] - corners[0];
  const double width = across.length();
  const double height = up.length();
  constexpr double kTolerance = 1e-3;  // as a fraction of a side
  const bool rectangle = width > 0 && height > 0 && std::isfinite(width * height) &&
                         std::abs(across.dot(up)) <= kTolerance * width * height &&
                         (corners[2] - corners[3] - up).length() <= kTolerance * height &&
                         (corners[2] - corners[1] - across).length() <= kTolerance * width;
  if (!rectangle) fail("{}: the four corners of its portal are not those of a rectangle", name);
  const Vec3d x = across / width;
  const Vec3d z = x.cross(up).normalized();
  x_ = Vec3f(x);
  z_ = Vec3f(z);
  y_ = Vec3f(z.cross(x));
  const auto size = static_cast<std::size_t>(cells);
  values_.resize(size * size);
  for (std::size_t row = 0; row < size; ++row) {
    const double b = std::numbers::pi * ((static_cast<double>(row) + 0.5) / cells - 0.5);
    for (std::size_t column = 0; column < size; ++column) {
      const double a = std::numbers::pi * ((static_cast<double>(column) + 0.5) / cells - 0.5);
      const Vec3d local = Vec3d(std::tan(a), std::tan(b), 1).normalized();
      const Vec3d direction = Vec3d(x_) * local.x + Vec3d(y_) * local.y + Vec3d(z_) * local.z;
      const double solid_angle = (1 - local.x * local.x) * (1 - local.y * local.y) / local.z;
      values_[row * size + column] = brightness(Vec3f(direction)) * solid_angle;
    }
  }
  const double mean =
      std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(values_.size());
  constexpr double kUniformPart = 0.05;
  for (double& value : values_) value = mean > 0 ? value / mean + kUniformPart : 1;
  sums_.assign((size + 1) * (size + 1), 0.0);
  for (std::size_t row = 0; row < size; ++row) {
    double sum = 0;
    for (std::size_t column = 0; column < size; ++column) {
      sum += values_[row * size + column];
      sums_[(row + 1) * (size + 1) + column + 1] = sums_[row * (size + 1) + column + 1] + sum;
    }
  }
}

double Portal::angle_in_cells(float across, float ahead) const {
  return cells_ * (0.5 + std::atan2(across, ahead) / std::numbers::pi);
}

int Portal::cell_of(double coordinate) const {
  return std::clamp(static_cast<int>(coordinate), 0, cells_ - 1);
}

std::optional<Portal::Window> Portal::window_from(const Vec3f& from) const {
  const Vec3f first = to_local(first_ - from);
  const Vec3f opposite = to_local(opposite_ - from);
  const float ahead = 0.5F * (first.z + opposite.z);
  if (!(ahead > 0)) return {};
  const Window window{angle_in_cells(first.x, ahead), angle_in_cells(first.y, ahead),
                      angle_in_cells(opposite.x, ahead), angle_in_cells(opposite.y, ahead)};
  if (!(window.u0 < window.u1 && window.v0 < window.v1)) return {};
  return window;
}

double Portal::integral(double u, double v) const {
  const int column = cell_of(u);
  const int row = cell_of(v);
  const double fu = u - column;
  const double fv = v - row;
  const std::size_t stride = static_cast<std::size_t>(cells_) + 1;
  const double* upper = &sums_[row * stride + column];
  const double* lower = upper + stride;
  return (upper[0] * (1 - fu) + upper[1] * fu) * (1 - fv) +
         (lower[0] * (1 - fu) + lower[1] * fu) * fv;
}

float Portal::pdf(const Vec3f& from, const Vec3f& direction) const {
  const Vec3f d = to_local(direction);
  if (!(d.z > 0)) return 0;
  const std::optional<Window> seen = window_from(from);
  if (!seen) return 0;
  const Window& window = *seen;
  const double u = angle_in_cells(d.x, d.z);
  const double v = angle_in_cells(d.y, d.z);
  if (u < window.u0 || u > window.u1 || v < window.v0 || v > window.v1) return 0;
  const double total = integral(window);
  // 1 - x² and 1 - y² of a unit vector, which do not cancel near the portal's plane.
  const float not_x = d.y * d.y + d.z * d.z;
  const float not_y = d.x * d.x + d.z * d.z;
  const double cells_per_steradian = d.z / (std::numbers::pi * std::numbers::pi * not_x * not_y) *
                                     static_cast<double>(cells_) * cells_;
  return total > 0 ? static_cast<float>(value(cell_of(u), cell_of(v)) / total * cells_per_steradian)
                   : 0;
}

std::optional<Vec3f> Portal::sample(const Vec3f& from, float u0, float u1) const {
  const std::optional<Window> seen = window_from(from);
  if (!seen) return {};
  const Window& window = *seen;
  const double total = integral(window);
  const double u = reach(
      [&](double to) {
        return integral({window.u0, window.v0, to, window.v1});
      },
      window.u0, window.u1, u0 * total);
  // All of a column of cells has the same distribution along v.
  const int column = cell_of(u);
  const auto along = [&](double to) {
    return integral({static_cast<double>(column), window.v0, column + 1.0, to});
  };
  const double v = reach(along, window.v0, window.v1, u1 * along(window.v1));
  const double a = std::numbers::pi * (u / cells_ - 0.5);
  const double b = std::numbers::pi * (v / cells_ - 0.5);
  // (tan a, tan b, 1), times both cosines so that it is finite.
  const Vec3d local =
      Vec3d(std::sin(a) * std::cos(b), std::cos(a) * std::sin(b), std::cos(a) * std::cos(b))
          .normalized();
  return Vec3f(Vec3d(x_) * local.x + Vec3d(y_) * local.y + Vec3d(z_) * local.z);
}

}  // namespace freepath
