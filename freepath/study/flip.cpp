#include "freepath/study/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "freepath/base/error.h"

namespace freepath {
namespace {

using Triple = std::array<float, 3>;
/// A channel, row after row.
using Plane = std::vector<float>;

// Linear sRGB → XYZ of its primaries and D65 [IEC61966], and the white that it makes.
constexpr double kXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                               {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                               {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};

double white(int row) { return kXyz[row][0] + kXyz[row][1] + kXyz[row][2]; }

/// XYZ over that of the white.
std::array<double, 3> relative_xyz(const Triple& rgb) {
  std::array<double, 3> xyz;
  for (int row = 0; row < 3; ++row) {
    xyz[row] = (kXyz[row][0] * rgb[0] + kXyz[row][1] * rgb[1] + kXyz[row][2] * rgb[2]) / white(row);
  }
  return xyz;
}

/// Opponent colours, linear in XYZ: brightness, red to green, blue to yellow.
Triple opponent(const Triple& rgb) {
  const auto [x, y, z] = relative_xyz(rgb);
  return {static_cast<float>(116 * y - 16), static_cast<float>(500 * (x - y)),
          static_cast<float>(200 * (y - z))};
}

/// The inverse of `opponent`, to XYZ over that of the white.
std::array<double, 3> xyz_of_opponent(const Triple& colour) {
  const double y = (colour[0] + 16) / 116;
  return {y + colour[1] / 500, y, y - colour[2] / 200};
}

/// XYZ over that of the white → linear sRGB, by Cramer's rule.
Triple rgb_of(const std::array<double, 3>& relative) {
  const auto determinant = [](const double(&m)[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  static const double kWhole = determinant(kXyz);
  Triple rgb;
  for (int column = 0; column < 3; ++column) {
    double replaced[3][3];
    for (int row = 0; row < 3; ++row) {
      for (int other = 0; other < 3; ++other) {
        replaced[row][other] = other == column ? relative[row] * white(row) : kXyz[row][other];
      }
    }
    rgb[column] = static_cast<float>(determinant(replaced) / kWhole);
  }
  return rgb;
}

/// CIELAB with chroma that fades in the dark, as eyes see it [Andersson20, Sec. 4.1.2].
std::array<double, 3> hunt_adjusted_lab(const std::array<double, 3>& relative) {
  constexpr double kDelta = 6.0 / 29;
  const auto f = [](double t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const double y = f(relative[1]);
  const double lightness = 116 * y - 16;
  const double fade = 0.01 * lightness;
  return {lightness, fade * 500 * (f(relative[0]) - y), fade * 200 * (y - f(relative[2]))};
}

/// Distance of colours that is meant for large ones [Andersson20, Eq. 6].
double hyab(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// Weights of a filter's taps from -radius to radius.
using Kernel = std::vector<double>;

template <class Weight>
Kernel make_kernel(int radius, Weight weight) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(weight(static_cast<double>(i)));
  return kernel;
}

double sum_of(const Kernel& kernel) {
  double sum = 0;
  for (const double weight : kernel) sum += weight;
  return sum;
}

struct Extent {
  int width, height;
};

/// Rows by one kernel and columns by another; the picture goes on as its edge does.
Plane filter(const Plane& plane, const Extent& size, const Kernel& rows, const Kernel& columns) {
  const auto pass = [&](const Plane& from, const Kernel& kernel, bool along_rows) {
    const int radius = static_cast<int>(kernel.size() / 2);
    Plane to(from.size());
    tbb::parallel_for(0, size.height, [&](int y) {
      for (int x = 0; x < size.width; ++x) {
        double sum = 0;
        for (int tap = -radius; tap <= radius; ++tap) {
          const int column = along_rows ? std::clamp(x + tap, 0, size.width - 1) : x;
          const int row = along_rows ? y : std::clamp(y + tap, 0, size.height - 1);
          sum += kernel[tap + radius] * from[static_cast<std::size_t>(row) * size.width + column];
        }
        to[static_cast<std::size_t>(y) * size.width + x] = static_cast<float>(sum);
      }
    });
    return to;
  };
  return pass(pass(plane, rows, true), columns, false);
}

/// A term a·√(π/b)·exp(-π² x²/b) of a contrast sensitivity, x in degrees.
struct SensitivityTerm {
  double a, b;
};

/// What eyes see of a channel at a distance [Andersson20, Sec. 4.1.1].
Plane filter_by_sensitivity(const Plane& plane, const Extent& size,
                            const std::vector<SensitivityTerm>& terms, double pixels_per_degree) {
  constexpr double kWidest = 0.04;  // of all terms; one radius serves all channels
  const int radius = static_cast<int>(std::ceil(
      3 * std::sqrt(kWidest / (2 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree));
  Plane sum(plane.size(), 0.0F);
  double whole = 0;
  for (const auto& [a, b] : terms) {
    const Kernel kernel = make_kernel(radius, [&, b = b](double i) {
      const double x = i / pixels_per_degree;
      return std::exp(-std::numbers::pi * std::numbers::pi * x * x / b);
    });
    const double weight = a * std::sqrt(std::numbers::pi / b);
    whole += weight * sum_of(kernel) * sum_of(kernel);
    const Plane part = filter(plane, size, kernel, kernel);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += static_cast<float>(weight) * part[i];
    }
  }
  for (float& value : sum) value = static_cast<float>(value / whole);
  return sum;
}

/// A picture on its way through the metric.
struct Look {
  std::vector<std::array<double, 3>> lab;  ///< As seen at a distance.
  Plane edges, points;                     ///< How strongly each pixel is one.
};

/// Lengths of the responses to a filter along x and along y.
Plane feature_strength(const Plane& brightness, const Extent& size, const Kernel& across,
                       const Kernel& along) {
  const Plane x = filter(brightness, size, across, along);
  const Plane y = filter(brightness, size, along, across);
  Plane strength(x.size());
  for (std::size_t i = 0; i < strength.size(); ++i) strength[i] = std::hypot(x[i], y[i]);
  return strength;
}

/// Makes the positive weights sum to 1, and the negative ones to -1.
void balance(Kernel& kernel) {
  double positive = 0;
  double negative = 0;
  for (const double weight : kernel) (weight > 0 ? positive : negative) += weight;
  for (double& weight : kernel) weight /= weight > 0 ? positive : -negative;
}

void find_features(const Plane& brightness, const Extent& size, double pixels_per_degree,
                   Look& look) {
  constexpr double kFeatureWidth = 0.082;  // degrees
  const double sigma = 0.5 * kFeatureWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const auto gauss = [&](double i) { return std::exp(-i * i / (2 * sigma * sigma)); };
  Kernel smooth = make_kernel(radius, gauss);
  const double sum = sum_of(smooth);
  for (double& weight : smooth) weight /= sum;
  Kernel edge = make_kernel(radius, [&](double i) { return -i * gauss(i); });
  Kernel point =
      make_kernel(radius, [&](double i) { return (i * i / (sigma * sigma) - 1) * gauss(i); });
  balance(edge);
  balance(point);
  look.edges = feature_strength(brightness, size, edge, smooth);
  look.points = feature_strength(brightness, size, point, smooth);
}

Look look_at(std::span<const float> picture, const Extent& size, const FlipViewing& viewing) {
  const std::size_t pixels = picture.size() / 3;
  std::array<Plane, 3> planes;
  for (Plane& plane : planes) plane.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    Triple rgb;
    for (int channel = 0; channel < 3; ++channel) {
      // The order of the arguments makes a NaN black.
      rgb[channel] = std::min(1.0F, std::max(0.0F, picture[3 * i + channel]));
    }
    const Triple colour = opponent(rgb);
    for (int channel = 0; channel < 3; ++channel) planes[channel][i] = colour[channel];
  }
  Look look;
  Plane brightness(pixels);
  for (std::size_t i = 0; i < pixels; ++i) brightness[i] = (planes[0][i] + 16) / 116;
  find_features(brightness, size, viewing.pixels_per_degree, look);
  const std::vector<SensitivityTerm> terms[3] = {
      {{1, 0.0047}}, {{1, 0.0053}}, {{34.1, 0.04}, {13.5, 0.025}}};
  for (int channel = 0; channel < 3; ++channel) {
    planes[channel] =
        filter_by_sensitivity(planes[channel], size, terms[channel], viewing.pixels_per_degree);
  }
  look.lab.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    Triple rgb = rgb_of(xyz_of_opponent({planes[0][i], planes[1][i], planes[2][i]}));
    for (float& value : rgb) value = std::clamp(value, 0.0F, 1.0F);
    look.lab[i] = hunt_adjusted_lab(relative_xyz(rgb));
  }
  return look;
}

/// Colour difference in [0, 1]: most of the range for those that pictures have
/// [Andersson20, Eq. 7].
double redistributed(double difference) {
  constexpr double kPower = 0.7;
  constexpr double kLimit = 0.4;    // share of the kLargest difference,
  constexpr double kTarget = 0.95;  // and where it is mapped to
  static const double kLargest = std::pow(
      hyab(hunt_adjusted_lab(relative_xyz({0, 1, 0})), hunt_adjusted_lab(relative_xyz({0, 0, 1}))),
      kPower);
  const double raised = std::pow(difference, kPower);
  const double limit = kLimit * kLargest;
  if (raised < limit) return kTarget / limit * raised;
  return kTarget + (raised - limit) / (kLargest - limit) * (1 - kTarget);
}

void check_sizes(std::span<const float> reference, std::span<const float> test,
                 const Extent& size) {
  const auto values = static_cast<std::size_t>(size.width) * size.height * 3;
  if (reference.size() == values && test.size() == values) return;
  fail("pictures of {} and {} values are no two of {}x{} pixels", reference.size(), test.size(),
       size.width, size.height);
}

double luminance(const float* rgb) {
  return kXyz[1][0] * rgb[0] + kXyz[1][1] * rgb[1] + kXyz[1][2] * rgb[2];
}

/// x (A x + B) / (x (C x + D) + E): ACES' curve, fitted, for values scaled by 0.6 first.
struct ToneCurve {
  double a = 0.36 * 2.51, b = 0.6 * 0.03, c = 0.36 * 2.43, d = 0.6 * 0.59, e = 0.14;

  float operator()(double x) const {
    if (!(x > 0)) return 0;
    if (x > 1e6) return static_cast<float>(std::min(1.0, a / c));
    return static_cast<float>(std::min(1.0, x * (a * x + b) / (x * (c * x + d) + e)));
  }
  /// Where it reaches y.
  double inverse(double y) const {
    const double p = a - y * c;
    const double q = b - y * d;
    return (-q + std::sqrt(q * q + 4 * p * y * e)) / (2 * p);
  }
};

/// The exposures to look at [stops].
std::vector<double> exposures_of(std::span<const float> reference, const ToneCurve& curve) {
  constexpr double kShown = 0.85;  // where the curve takes the brightest and the median
  std::vector<double> values;
  for (std::size_t i = 0; i + 2 < reference.size(); i += 3) {
    const double value = luminance(&reference[i]);
    if (std::isfinite(value)) values.push_back(value);
  }
  if (values.empty()) return {0};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double brightest = *std::max_element(values.begin(), values.end());
  if (!(brightest > 0)) return {0};
  constexpr double kDarkest = 0x1p-12;  // of the brightest: a black median has no exposure
  const double median = std::max(*middle, brightest * kDarkest);
  const double first = std::log2(curve.inverse(kShown) / brightest);
  const double last = std::log2(curve.inverse(kShown) / median);
  const int count = std::max(2, static_cast<int>(std::ceil(last - first)));
  std::vector<double> exposures;
  exposures.reserve(count);
  for (int i = 0; i < count; ++i) exposures.push_back(first + (last - first) * i / (count - 1));
  return exposures;
}

}  // namespace

std::vector<float> flip(std::span<const float> reference, std::span<const float> test, int width,
                        int height, const FlipViewing& viewing) {
  const Extent size{width, height};
  check_sizes(reference, test, size);
  const Look expected = look_at(reference, size, viewing);
  const Look found = look_at(test, size, viewing);
  std::vector<float> differences(expected.lab.size());
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const double colour = redistributed(hyab(expected.lab[i], found.lab[i]));
    const double edge = std::abs(expected.edges[i] - found.edges[i]);
    const double point = std::abs(expected.points[i] - found.points[i]);
    const double feature = std::sqrt(std::max(edge, point) / std::numbers::sqrt2);
    const double both = std::pow(colour, 1 - std::min(1.0, feature));
    differences[i] = static_cast<float>(std::clamp(both, 0.0, 1.0));
  }
  return differences;
}

std::vector<float> high_range_flip(std::span<const float> reference, std::span<const float> test,
                                   int width, int height, const FlipViewing& viewing) {
  check_sizes(reference, test, {width, height});
  const ToneCurve curve;
  std::vector<float> largest(reference.size() / 3, 0.0F);
  for (const double exposure : exposures_of(reference, curve)) {
    const double scale = std::exp2(exposure);
    const auto shown = [&](std::span<const float> picture) {
      std::vector<float> values;
      for (const float value : picture) values.push_back(curve(scale * value));
      return values;
    };
    const std::vector<float> differences =
        flip(shown(reference), shown(test), width, height, viewing);
    for (std::size_t i = 0; i < largest.size(); ++i) {
      largest[i] = std::max(largest[i], differences[i]);
    }
  }
  return largest;
}

}  // namespace freepath
