#include "freepath/spectra/light_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "freepath/spectra/reflectance_table.h"

namespace freepath {
namespace {

constexpr int kCells = ReflectanceTable::kSize - 1;  // along an axis
constexpr std::size_t kAllCells = std::size_t{3} * kCells * kCells;

/// A reflectance of half the table's range: of half the largest component.
constexpr double kHalf = 0.5;

bool is_grey(const Vec3f& rgb) { return rgb.x == rgb.y && rgb.y == rgb.z; }

/// Weights of a parabola's values at 0, 1/2 and 1.
std::array<float, 3> parabola(float x) {
  return {(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)};
}

}  // namespace

/// Colours between four nodes.
struct LightTable::Cell {
  std::array<std::array<float, 3>, 4> polynomials;  ///< At (0, 0), (1, 0), (0, 1), (1, 1).
  /// Colours of the spectra for a largest component of 1, at x, y = 0, 1/2, 1; x fastest.
  std::array<Vec3f, 9> colours;

  std::array<float, 3> polynomial(float x, float y) const {
    std::array<float, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = (polynomials[0][i] * (1 - x) + polynomials[1][i] * x) * (1 - y) +
             (polynomials[2][i] * (1 - x) + polynomials[3][i] * x) * y;
    }
    return c;
  }
};

float LightTable::Light::operator()(float u) const {
  const float x = (c[0] * u + c[1]) * u + c[2];
  return scale * (0.5F + 0.5F * x / std::sqrt(1 + x * x));
}

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
  for (std::size_t place = 0; place < 9; ++place) {
    const Light light{2, cell->polynomial(0.5F * static_cast<float>(place % 3),
                                          0.5F * static_cast<float>(place / 3))};
    Vec3d sum(0);
    for (const SeenWavelength& seen : wavelengths_) sum += Vec3d(seen.rgb * light(seen.u));
    cell->colours[place] = Vec3f(sum);
  }
  std::atomic<const Cell*>& home = cells_[(largest * kCells + row) * kCells + column];
  const Cell* present = nullptr;
  // Where another thread was faster, its cell is the same and stays.
  if (home.compare_exchange_strong(present, cell.get(), std::memory_order_acq_rel)) {
    return cell.release();
  }
  return present;
}

LightTable::Place LightTable::place_of(const Vec3f& rgb, float size) const {
  // Of equal components the last is the largest, as in ReflectanceTable.
  const int largest = rgb.z >= size ? 2 : rgb.y >= size ? 1 : 0;
  const float x = rgb[(largest + 1) % 3] / size * kCells;
  const float y = rgb[(largest + 2) % 3] / size * kCells;
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
  if (is_grey(rgb)) return {2 * size, {}};
  const Place place = place_of(rgb, size);
  return {2 * size, place.cell->polynomial(place.x, place.y)};
}

Vec3f LightTable::seen(const Vec3f& rgb) const {
  if (is_grey(rgb)) return rgb;
  const float size = std::max({rgb.x, rgb.y, rgb.z});
  const Place place = place_of(rgb, size);
  const std::array<float, 3> columns = parabola(place.x);
  const std::array<float, 3> rows = parabola(place.y);
  Vec3f sum(0);
  for (std::size_t i = 0; i < 9; ++i) {
    sum += place.cell->colours[i] * (columns[i % 3] * rows[i / 3]);
  }
  return sum * size;
}

}  // namespace freepath
