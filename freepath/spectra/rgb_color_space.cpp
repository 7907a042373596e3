#include "freepath/spectra/rgb_color_space.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/nearest_name.h"
#include "freepath/spectra/illuminants.h"
#include "freepath/spectra/reflectance_table.h"

namespace freepath {
namespace {

constexpr RgbPrimaries kRec709 = RgbChromaticities().primaries;
constexpr RgbPrimaries kP3 = {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}};
constexpr RgbPrimaries kRec2020 = {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}};
constexpr RgbPrimaries kAcesAp0 = {{0.7347, 0.2653}, {0.0000, 1.0000}, {0.0001, -0.0770}};
constexpr RgbPrimaries kAcesAp1 = {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}};
constexpr Chromaticity kAcesWhite = {0.32168, 0.33767};

constexpr auto kColorSpaceNames =
    std::to_array<std::string_view>({"srgb", "dci-p3", "rec2020", "aces-cg", "aces2065-1"});

/// Each nanometre's share in the colour goes to the two nodes beside it as if the reflectance were
/// linear between them.
std::array<Vec3d, RgbColorSpace::kNodes> reflectance_weights_of(const LinearSpectrum& illuminant,
                                                                const Matrix3d& xyz_to_rgb) {
  std::array<Vec3d, RgbColorSpace::kNodes> weights;
  weights.fill(Vec3d(0));
  for (std::size_t i = 0; i < kObserverNodes; ++i) {
    const double wavelength = observer_node(i);
    const Vec3d rgb = observer_weight(i) * illuminant(wavelength) * xyz_to_rgb;
    const double position = (wavelength - kShortestWavelength) / RgbColorSpace::kNodeDistance;
    const auto left = std::min(static_cast<std::size_t>(position), weights.size() - 2);
    const double share = position - static_cast<double>(left);
    weights[left] += rgb * (1 - share);
    weights[left + 1] += rgb * share;
  }
  return weights;
}

}  // namespace

RgbColorSpace::RgbColorSpace(std::string name, const RgbPrimaries& primaries,
                             const LinearSpectrum& illuminant)
    : name_(std::move(name)),
      primaries_(primaries),
      illuminant_(normalized_to_luminance(illuminant)),
      white_(chromaticity_of(observe(illuminant_))),
      rgb_to_xyz_(rgb_to_xyz_matrix(primaries_, white_)),
      xyz_to_rgb_(rgb_to_xyz_.inverse(true)),
      weights_(reflectance_weights_of(illuminant_, xyz_to_rgb_)),
      reflectances_(std::make_unique<const ReflectanceTable>(*this)) {}

RgbColorSpace::~RgbColorSpace() = default;

std::span<const std::string_view> rgb_color_space_names() { return kColorSpaceNames; }

const RgbColorSpace& rgb_color_space(std::string_view name) {
  if (name == "srgb") {
    static const RgbColorSpace kSpace("srgb", kRec709, illuminant_d65());
    return kSpace;
  }
  if (name == "dci-p3") {
    static const RgbColorSpace kSpace("dci-p3", kP3, illuminant_d65());
    return kSpace;
  }
  if (name == "rec2020") {
    static const RgbColorSpace kSpace("rec2020", kRec2020, illuminant_d65());
    return kSpace;
  }
  if (name == "aces-cg") {
    static const RgbColorSpace kSpace("aces-cg", kAcesAp1, daylight(kAcesWhite));
    return kSpace;
  }
  if (name == "aces2065-1") {
    static const RgbColorSpace kSpace("aces2065-1", kAcesAp0, daylight(kAcesWhite));
    return kSpace;
  }
  const std::string_view nearest = nearest_name(name, kColorSpaceNames);
  if (nearest.empty()) fail("there is no colour space '{}'", name);
  fail("there is no colour space '{}'; did you mean '{}'?", name, nearest);
}

}  // namespace freepath
