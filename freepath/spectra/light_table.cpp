#include "freepath/spectra/light_table.h"

#include <algorithm>
#include <cstddef>

#include "freepath/spectra/reflectance_table.h"

namespace freepath {
namespace {

constexpr int kCells = ReflectanceTable::kSize - 1;  // along an axis
constexpr std::size_t kAllCells = std::size_t{3} * kCells * kCells;

/// A reflectance of half the table's range: of half the largest component.
constexpr double kHalf = 0.5;

/// Below it 1 / x would leave the floats.
constexpr float kBlack = 1e-30F;

bool is_grey(const Vec3f& rgb) { return rgb.x == rgb.y && rgb.y == rgb.z; }

}  // namespace

/// Colours between four nodes.
struct LightTable::Cell {
  std::array<std::array<float, 3>, 4> polynomials;  ///< At (0, 0), (1, 0), (0, 1), (1, 1).
  /// The colours of the spectra for a largest component of 1: coefficients of 1, x, y, xy, x², y².
  /// The fourth number fills the lanes.
  std::array<std::array<float, 4>, 6> colours;

  std::array<float, 3> polynomial(float x, float y) const {
    std::array<float, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = (polynomials[0][i] * (1 - x) + polynomials[1][i] * x) * (1 - y) +
             (polynomials[2][i] * (1 - x) + polynomials[3][i] * x) * y;
    }
    return c;
  }
};

LightTable::LightTable(const RgbColorSpace& space)
    : space_(space), cells_(std::make_unique<std::atomic<const Cell*>[]>(kAllCells)) {
  // By midpoints at half nanometres, 3e-6 from the mean over all wavelengths.
  constexpr double kStep = 0.5;
  for (double lambda = kShortestWavelength + kStep / 2; lambda < kLongestWavelength;
       lambda += kStep) {
    const double weight = space.illuminant()(lambda) * kStep / kLuminousIntegral;
    wavelengths_.push_back({static_cast<float>(SigmoidPolynomial::coordinate(lambda)),
                            Vec3f(space.from_xyz(color_matching(lambda) * weight))});
  }
}

LightTable::~LightTable() {
  for (std::size_t i = 0; i < kAllCells; ++i) delete cells_[i].load();
}

void LightTable::set_colours(Cell& cell) const {
  std::array<std::array<Vec3d, 3>, 3> seen;  // at y, x = 0, 1/2, 1
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      const Light light{
          2, cell.polynomial(0.5F * static_cast<float>(column), 0.5F * static_cast<float>(row))};
      Vec3d& sum = seen[row][column];
      sum = Vec3d(0);
      for (const SeenWavelength& one : wavelengths_) sum += Vec3d(one.rgb * light(one.u));
    }
  }
  // The bilinear part goes through the corners; bulges 4 h x(1 - x) have the mean height h of their
  // three parallels. What is left is of third order.
  Vec3d across(0);
  Vec3d down(0);
  for (std::size_t i = 0; i < 3; ++i) {
    across += (seen[i][1] - (seen[i][0] + seen[i][2]) * 0.5) * (4.0 / 3);
    down += (seen[1][i] - (seen[0][i] + seen[2][i]) * 0.5) * (4.0 / 3);
  }
  const Vec3d& origin = seen[0][0];
  const std::array<Vec3d, 6> coefficients = {origin,
                                             seen[0][2] - origin + across,
                                             seen[2][0] - origin + down,
                                             seen[2][2] - seen[0][2] - seen[2][0] + origin,
                                             -across,
                                             -down};
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const Vec3f c(coefficients[i]);
    cell.colours[i] = {c.x, c.y, c.z, 0};
  }
}

const LightTable::Cell* LightTable::make_cell(int largest, int column, int row) const {
  auto cell = std::make_unique<Cell>();
  for (std::size_t corner = 0; corner < 4; ++corner) {
    Vec3d rgb;
    rgb[largest] = kHalf;
    rgb[(largest + 1) % 3] = kHalf * (column + static_cast<int>(corner & 1)) / kCells;
    rgb[(largest + 2) % 3] = kHalf * (row + static_cast<int>(corner >> 1)) / kCells;
    const SigmoidPolynomial polynomial = space_.reflectances()(rgb);
    for (std::size_t i = 0; i < 3; ++i) {
      cell->polynomials[corner][i] = static_cast<float>(polynomial.c[i]);
    }
  }
  set_colours(*cell);
  std::atomic<const Cell*>& home = cells_[(largest * kCells + row) * kCells + column];
  const Cell* present = nullptr;
  // Where another thread was faster, its cell is the same and stays.
  if (home.compare_exchange_strong(present, cell.get(), std::memory_order_acq_rel)) {
    return cell.release();
  }
  return present;
}

inline LightTable::CellPoint LightTable::point_of(const Vec3f& rgb, float size) const {
  // Of equal components the last is the largest, as in ReflectanceTable.
  const int largest = rgb.z >= size ? 2 : rgb.y >= size ? 1 : 0;
  const float scale = kCells / size;
  const float x = rgb[largest == 2 ? 0 : largest + 1] * scale;
  const float y = rgb[largest == 0 ? 2 : largest - 1] * scale;
  // Written so that a NaN has a cell too.
  const int column = x < kCells - 1 ? static_cast<int>(x) : kCells - 1;
  const int row = y < kCells - 1 ? static_cast<int>(y) : kCells - 1;
  const Cell* cell =
      cells_[(largest * kCells + row) * kCells + column].load(std::memory_order_acquire);
  if (cell == nullptr) cell = make_cell(largest, column, row);
  return {cell, x - static_cast<float>(column), y - static_cast<float>(row)};
}

LightTable::Light LightTable::light(const Vec3f& rgb) const {
  const float size = std::max({rgb.x, rgb.y, rgb.z});
  if (size < kBlack) return {};
  if (is_grey(rgb)) return {2 * size, {}};
  const CellPoint at = point_of(rgb, size);
  return {2 * size, at.cell->polynomial(at.x, at.y)};
}

Vec3f LightTable::seen(const Vec3f& rgb) const {
  const float size = std::max({rgb.x, rgb.y, rgb.z});
  if (size < kBlack) return Vec3f(0);
  if (is_grey(rgb)) return rgb;
  const CellPoint at = point_of(rgb, size);
  const float x = at.x;
  const float y = at.y;
  const auto& c = at.cell->colours;
  std::array<float, 4> sum;
  for (std::size_t i = 0; i < 4; ++i) {
    sum[i] = c[0][i] + (c[1][i] + c[3][i] * y + c[4][i] * x) * x + (c[2][i] + c[5][i] * y) * y;
  }
  return Vec3f(sum[0], sum[1], sum[2]) * size;
}

}  // namespace freepath
