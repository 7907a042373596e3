#pragma once
/// @file Every kind of material in several forms, on a surface that lies askew.

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "freepath/materials/material.h"
#include "freepath/materials/textures/texture_table.h"
#include "freepath/spectra/named_spectra.h"
#include "freepath/spectra/rgb_color_space.h"
#include "freepath/spectra/spectrum_table.h"

namespace freepath::testing {

struct NamedMaterial {
  std::string name;
  Material material;
  bool exact_pdf = true;  ///< sample() draws by the density that evaluate() gives.
  double eta = 1;         ///< Of the inside relative to the outside, where light gets there.
};

/// Spectra, textures and materials of a scene. Not to be moved: contexts refer to it.
class MaterialWorld {
 public:
  MaterialWorld() {
    add_opaque();
    add_transparent();
    add_coated();
    add_mixed();
    rgb_ = table_.in_rgb();
    spectral_ = table_.at(sample_wavelengths<kMaxChannels>(0.3, WavelengthDensity::kVisible, 4));
  }
  MaterialWorld(const MaterialWorld&) = delete;
  MaterialWorld& operator=(const MaterialWorld&) = delete;

  const std::vector<NamedMaterial>& materials() const { return materials_; }
  SurfaceContext in_rgb() const { return {rgb_, textures_}; }
  SurfaceContext spectral(int hero) const { return {spectral_, textures_, hero}; }

  SpectrumId grey(double value) { return table_.add(value, SpectrumRole::kReflectance); }
  SpectrumId index(double value) { return table_.add(value, SpectrumRole::kIndex); }
  TextureTable& textures() { return textures_; }
  /// After spectra or textures were added.
  void update() {
    rgb_ = table_.in_rgb();
    spectral_ = table_.at(sample_wavelengths<kMaxChannels>(0.3, WavelengthDensity::kVisible, 4));
  }

  /// Gold, whose spectra give it a colour.
  ComplexIndex gold() {
    return {add(named_spectrum("metal-Au-eta"), SpectrumRole::kReflectance),
            add(named_spectrum("metal-Au-k"), SpectrumRole::kReflectance)};
  }
  SpectrumId flint() const { return flint_; }

  SampledSpectrum eta_of_flint(const SurfaceContext& context) const {
    return context.spectra[flint_];
  }

 private:
  SpectrumId add(SpectralDistribution::Kind spectrum, SpectrumRole role) {
    return table_.add(SpectralDistribution(std::move(spectrum)), role);
  }
  void add(std::string name, Material material, bool exact_pdf = true, double eta = 1) {
    materials_.push_back({std::move(name), std::move(material), exact_pdf, eta});
  }

  void add_opaque() {
    const SpectrumId color =
        add(RgbSpectrum::reflectance({0.8, 0.4, 0.2}, table_.space()), SpectrumRole::kReflectance);
    add("diffuse", DiffuseMaterial{color});
    add("paper", DiffuseTransmissionMaterial{color, grey(0.3), 0.9F});
    add("smooth gold", ConductorMaterial{gold(), {}});
    add("rough gold", ConductorMaterial{gold(), {0.05F, 0.05F, true}});
    add("very rough gold", ConductorMaterial{gold(), {0.8F, 0.8F, false}});
    add("brushed gold", ConductorMaterial{gold(), {0.15F, 0.5F, false}});
    add("conductor by reflectance",
        ConductorMaterial{NormalReflectance{color}, {0.3F, 0.3F, false}});
  }
  void add_transparent() {
    add("smooth glass", DielectricMaterial{index(1.5), {}}, true, 1.5);
    add("rough glass", DielectricMaterial{index(1.5), {0.04F, 0.04F, true}}, true, 1.5);
    add("very rough glass", DielectricMaterial{index(1.5), {0.7F, 0.7F, false}}, true, 1.5);
    add("brushed glass", DielectricMaterial{index(1.5), {0.15F, 0.4F, false}}, true, 1.5);
    add("rough air in glass", DielectricMaterial{index(1 / 1.33), {0.3F, 0.3F, false}}, true,
        1 / 1.33);
    add("rough nothing", DielectricMaterial{index(1), {0.3F, 0.3F, false}});
    add("thin glass", ThinDielectricMaterial{index(1.5)});
    add("smooth flint", DielectricMaterial{flint(), {}});
    add("rough flint", DielectricMaterial{flint(), {0.3F, 0.3F, false}});
    add("thin flint", ThinDielectricMaterial{flint()});
  }
  void add_coated() {
    const SpectrumId color =
        add(RgbSpectrum::reflectance({0.8, 0.4, 0.2}, table_.space()), SpectrumRole::kReflectance);
    // Deep walks, so that what both techniques cut off is nothing.
    Coating coating{index(1.5), {}, 0.01F, SpectrumId{}, 0.0F, 200, 1};
    const Roughness rough{0.3F, 0.3F, false};
    add("coated diffuse", CoatedDiffuseMaterial{coating, color}, false);
    add("coated gold", CoatedConductorMaterial{coating, gold(), {}}, false);
    add("coated rough gold", CoatedConductorMaterial{coating, gold(), rough}, false);
    coating.roughness = rough;
    add("rough coated diffuse", CoatedDiffuseMaterial{coating, color}, false);
    add("rough coated gold", CoatedConductorMaterial{coating, gold(), {}}, false);
    add("rough coated rough gold", CoatedConductorMaterial{coating, gold(), rough}, false);
    coating.samples = 2;
    coating.albedo = grey(0.9);
    coating.thickness = 0.5F;
    coating.g = 0.4F;
    add("rough milky diffuse", CoatedDiffuseMaterial{coating, color}, false);
    coating.roughness = {};
    add("milky diffuse", CoatedDiffuseMaterial{coating, color}, false);
    add("milky gold", CoatedConductorMaterial{coating, gold(), {}}, false);
    coating.eta = flint();
    add("flint coated diffuse", CoatedDiffuseMaterial{coating, color}, false);
  }
  void add_mixed() {
    const auto named = [&](const std::string& name) {
      for (const NamedMaterial& entry : materials_) {
        if (entry.name == name) return std::make_shared<const Material>(entry.material);
      }
      throw std::logic_error(name);
    };
    const auto inner = std::make_shared<const Material>(
        MixMaterial{named("rough glass"), named("rough gold"), 0.5F});
    add("mix", MixMaterial{inner, named("diffuse"), 0.3F}, true, 1.5);
  }

  SpectrumTable table_{rgb_color_space("srgb")};
  TextureTable textures_;
  SpectrumId flint_ = add(named_spectrum("glass-F5"), SpectrumRole::kIndex);
  SpectrumValues rgb_, spectral_;
  std::vector<NamedMaterial> materials_;
};

/// A point of a surface that lies askew, dpdu neither normal nor unit.
inline SurfacePoint askew_point() {
  SurfacePoint point;
  point.position = {1, 2, 3};
  point.normal = Vec3f(0.3F, -0.5F, 0.8F).normalized();
  point.shading_normal = point.normal;
  point.dpdu = Vec3f(2, 1, -0.3F);
  return point;
}

/// Its frame, as the materials define it.
inline Vec3f on_surface(const SurfacePoint& point, double cosine, double azimuth) {
  const Vec3f& z = point.normal;
  const Vec3f x = (point.dpdu - z * z.dot(point.dpdu)).normalized();
  const Vec3f y = z.cross(x);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return (x * static_cast<float>(sine * std::cos(azimuth)) +
          y * static_cast<float>(sine * std::sin(azimuth)) + z * static_cast<float>(cosine))
      .normalized();
}

/// Cosines of the directions that paths come from, on both sides.
inline constexpr double kCosines[] = {0.95, 0.5, 0.15, -0.9, -0.6, -0.2};

}  // namespace freepath::testing
