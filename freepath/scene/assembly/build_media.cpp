#include "freepath/scene/assembly/build_media.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/io/volume.h"
#include "freepath/lights/photometry.h"
#include "freepath/media/phase/parse_phase_function.h"
#include "freepath/scene/assembly/cloud_density.h"
#include "freepath/scene/assembly/entity_kinds.h"
#include "freepath/scene/assembly/grid_voxels.h"
#include "freepath/scene/assembly/scattering_presets.h"
#include "freepath/scene/pbrt/nearest_name.h"

namespace freepath {
namespace {

/// A homogeneous medium reaches so many mean free paths beyond the scene: nothing comes back.
constexpr double kMeanFreePathsAround = 60;
/// But not further than so many times the extent of the scene.
constexpr double kLargestReach = 1e6;

/// What statements of all kinds of media have in common.
class MediumReader {
 public:
  MediumReader(BuildContext& context, const PbrtMedium& medium)
      : context_(context), medium_(medium), list_(medium.parameters) {}

  SceneMedium read(const Box3d& extent) {
    if (medium_.world_from_medium.is_animated()) {
      context_.diagnostics.warn(medium_.location,
                                "moving media are not supported: this one stands as at the start");
    }
    return at_location(medium_.location, [&] {
      constexpr EntityKind<SceneMedium (MediumReader::*)(const Box3d&)> kKinds[] = {
          {"cloud", &MediumReader::cloud},
          {"homogeneous", &MediumReader::homogeneous},
          {"uniformgrid", &MediumReader::uniform_grid},
          {"rgbgrid", &MediumReader::color_grid},
          {"nanovdb", &MediumReader::volume_file},
          {"openvdb", &MediumReader::volume_file},
      };
      const auto make = maker_of(medium_, "medium", kKinds);
      return (this->*make)(extent);
    });
  }

 private:
  const Matrix4d& to_world() const { return medium_.world_from_medium.start; }

  SpectralDistribution coefficient(std::string_view name, const SpectralDistribution& otherwise) {
    if (!list_.type_of(name)) return otherwise;
    return distribution_of(context_, list_.get_spectrum(name, {}), ColorMeaning::kUnbounded, list_,
                           name);
  }

  /// sigma_a and sigma_s, of a preset where one is named.
  void read_coefficients(SceneMediumComponent& component) {
    SpectralDistribution sigma_a(1.0);
    SpectralDistribution sigma_s(1.0);
    const std::string preset = list_.get_string("preset", "");
    if (!preset.empty()) {
      const auto found = find_scattering_preset(preset);
      if (!found) {
        const auto names = scattering_preset_names();
        fail_at(list_.location_of("preset"), "there is no preset {}{}", in_quotes(preset),
                did_you_mean(preset, names));
      }
      const RgbColorSpace& space = rgb_color_space("srgb");
      sigma_a = RgbSpectrum::unbounded(found->sigma_a, space);
      sigma_s = RgbSpectrum::unbounded(found->sigma_prime_s, space);
    }
    if (preset.empty() && context_.options.sigma_a) sigma_a = from_rgb(*context_.options.sigma_a);
    if (preset.empty() && context_.options.sigma_s) sigma_s = from_rgb(*context_.options.sigma_s);
    sigma_a = coefficient("sigma_a", sigma_a);
    sigma_s = coefficient("sigma_s", sigma_s);
    largest_ = sigma_a.largest() + sigma_s.largest();
    component.sigma_a = context_.scene.spectra->add(sigma_a, SpectrumRole::kReflectance);
    component.sigma_s = context_.scene.spectra->add(sigma_s, SpectrumRole::kReflectance);
    component.scale = nonnegative("scale", 1);
  }

  static SpectralDistribution from_rgb(const Rgb& rgb) {
    return RgbSpectrum::unbounded(Vec3d(rgb), rgb_color_space("srgb"));
  }

  float nonnegative(std::string_view name, double otherwise) {
    const double value = list_.get_float(name, otherwise);
    if (value < 0)
      fail_at(list_.location_of(name), "'{}' is {}: it may not be negative", name, value);
    return static_cast<float>(value);
  }

  PhaseFunction phase() {
    const std::string text = list_.get_string("phase", "");
    if (!text.empty()) {
      if (list_.type_of("g")) {
        fail_at(list_.location_of("phase"), "give a medium 'phase' or 'g', not both");
      }
      return at_location(list_.location_of("phase"), [&] {
        const auto folder = std::filesystem::path(*list_.location_of("phase").file).parent_path();
        PhaseFunction phase = parse_phase_function(text, folder);
        for (const auto& file : phase_function_files(text, folder)) context_.files.push_back(file);
        return phase;
      });
    }
    if (context_.options.phase && !list_.type_of("g")) return *context_.options.phase;
    const double g = list_.get_float("g", 0);
    return at_location(list_.location_of("g"),
                       [&] { return PhaseFunction::henyey_greenstein(static_cast<float>(g)); });
  }

  /// Emission by a spectrum, of a luminance of 1 but for colours: pbrt's rule for lights.
  void read_emission(SceneMediumComponent& component, double scale) {
    if (!list_.type_of("Le")) return;
    const SpectralDistribution radiance = distribution_of(context_, list_.get_spectrum("Le", {}),
                                                          ColorMeaning::kIlluminant, list_, "Le");
    component.radiance = context_.scene.spectra->add(radiance, SpectrumRole::kIlluminant);
    component.radiance_scale = static_cast<float>(scale * photometric_scale(radiance));
  }

  /// Thermal emission by a field of temperatures.
  void read_temperature(std::shared_ptr<const Field> field, SceneMediumComponent& component) {
    TemperatureEmission emission;
    emission.field = std::move(field);
    emission.scale = list_.get_float("temperaturescale", 1);
    emission.offset = list_.get_float("temperatureoffset", list_.get_float("temperaturecutoff", 0));
    component.temperature = emission;
  }

  SceneMedium cloud(const Box3d& /*extent*/) {
    SceneMediumComponent component;
    read_coefficients(component);
    component.phase = phase();
    CloudDensity density;
    density.density = nonnegative("density", 1);
    density.wispiness = nonnegative("wispiness", 1);
    density.frequency = list_.get_float("frequency", 5);
    density.p0 = list_.get_point("p0", Vec3d(0));
    density.p1 = list_.get_point("p1", Vec3d(1));
    return {medium_.name,
            medium_of(make_cloud_field(medium_.name, density, to_world()), component, false),
            {component}};
  }

  SceneMedium homogeneous(const Box3d& extent) {
    SceneMediumComponent component;
    read_coefficients(component);
    component.phase = phase();
    read_emission(component, nonnegative("Lescale", 1));
    const double sigma_t = largest_ * component.scale;
    const double size = std::max(extent.size().length(), 1e-6);
    const double smallest = smallest_sigma_t(component);
    const double reach =
        smallest > 0 ? std::min(kMeanFreePathsAround / smallest, kLargestReach * size) : size;
    const Box3d box(extent.min - Vec3d(reach + size), extent.max + Vec3d(reach + size));
    return SceneMedium::homogeneous(medium_.name, component, box, Matrix4d(),
                                    static_cast<float>(sigma_t));
  }

  /// The least extinction over the rendered wavelengths that is not 0.
  double smallest_sigma_t(const SceneMediumComponent& component) const {
    const SpectrumTable& table = *context_.scene.spectra;
    double smallest = 0;
    for (double wavelength = kShortestWavelength; wavelength <= kLongestWavelength;
         wavelength += 5) {
      const double sigma_t = component.scale * (table.spectrum(component.sigma_a)(wavelength) +
                                                table.spectrum(component.sigma_s)(wavelength));
      if (sigma_t > 0 && (smallest == 0 || sigma_t < smallest)) smallest = sigma_t;
    }
    return smallest;
  }

  std::shared_ptr<const Field> voxels(const VoxelLayout& layout, std::string_view name) {
    return read_voxels(list_, layout, name, medium_.name + "." + std::string(name));
  }

  SceneMedium uniform_grid(const Box3d& /*extent*/) {
    const VoxelLayout layout = read_voxel_layout(list_, to_world());
    SceneMediumComponent component;
    read_coefficients(component);
    component.phase = phase();
    const auto density = voxels(layout, "density");
    if (list_.type_of("temperature")) {
      if (list_.type_of("Le")) {
        fail_at(list_.location_of("Le"), "give a grid 'Le' or 'temperature', not both");
      }
      if (list_.type_of("Lescale")) {
        fail_at(list_.location_of("Lescale"),
                "a grid 'Lescale' is not supported where there is 'temperature'");
      }
      read_temperature(voxels(layout, "temperature"), component);
      component.radiance_scale = 1;
    } else {
      read_emission(component, 1);
      if (list_.type_of("Lescale")) component.radiance_field = voxels(layout, "Lescale");
    }
    return {medium_.name, medium_of(density, component, true), {component}};
  }

  std::vector<RgbSpectrum> colors(const VoxelLayout& layout, std::string_view name,
                                  ColorMeaning meaning) {
    if (!list_.type_of(name)) return {};
    const std::vector<SpectrumValue> values = list_.get_spectra(name);
    check_voxel_count(list_, name, values.size(), layout);
    const RgbColorSpace& black = rgb_color_space("srgb");
    std::vector<RgbSpectrum> spectra(values.size(), RgbSpectrum::unbounded(Vec3d(0), black));
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto* const rgb = std::get_if<RgbValue>(&values[i]);
      if (rgb == nullptr) fail_at(list_.location_of(name), "'{}' has to be of type rgb", name);
      if (!(rgb->r >= 0 && rgb->g >= 0 && rgb->b >= 0)) {
        fail_at(list_.location_of(name), "'{}' is ({}, {}, {}) in voxel {}", name, rgb->r, rgb->g,
                rgb->b, i);
      }
    }
    tbb::parallel_for(std::size_t{0}, values.size(), [&](std::size_t i) {
      const auto& value = std::get<RgbValue>(values[i]);
      const RgbColorSpace& space = rgb_color_space(name_of(value.color_space));
      const Vec3d rgb(value.r, value.g, value.b);
      spectra[i] = meaning == ColorMeaning::kIlluminant ? RgbSpectrum::illuminant(rgb, space)
                                                        : RgbSpectrum::unbounded(rgb, space);
    });
    return spectra;
  }

  SceneMedium color_grid(const Box3d& /*extent*/) {
    const VoxelLayout layout = read_voxel_layout(list_, to_world());
    auto grid = std::make_shared<ColorVoxels>();
    grid->super_voxel = context_.options.super_voxel;
    grid->counts = layout.counts;
    grid->index_to_world = layout.index_to_world;
    grid->sigma_a = colors(layout, "sigma_a", ColorMeaning::kUnbounded);
    grid->sigma_s = colors(layout, "sigma_s", ColorMeaning::kUnbounded);
    grid->radiance = colors(layout, "Le", ColorMeaning::kIlluminant);
    if (grid->sigma_a.empty() && grid->sigma_s.empty()) {
      fail("an rgbgrid needs 'sigma_a' or 'sigma_s'");
    }
    if (!grid->radiance.empty() && grid->sigma_a.empty()) {
      fail_at(list_.location_of("Le"), "'Le' needs 'sigma_a': what does not absorb does not emit");
    }
    // As in pbrt, a grid that is not given is 1 everywhere.
    const RgbSpectrum one = RgbSpectrum::unbounded(Vec3d(1), rgb_color_space("srgb"));
    if (grid->sigma_a.empty()) grid->sigma_a.assign(layout.voxels(), one);
    if (grid->sigma_s.empty()) grid->sigma_s.assign(layout.voxels(), one);
    grid->scale = nonnegative("scale", 1);
    grid->radiance_scale = nonnegative("Lescale", 1);
    grid->phase = phase();
    return {medium_.name, std::shared_ptr<const ColorVoxels>(std::move(grid))};
  }

  std::shared_ptr<const Field> grid(const std::filesystem::path& file, const std::string& name) {
    LoadOptions options;
    options.selection.name = name;
    options.scalar_only = true;
    options.invalid = context_.options.invalid;
    LoadedField loaded = load_field(file, options);
    for (const std::string& warning : loaded.warnings) {
      context_.diagnostics.warn(medium_.location, warning);
    }
    auto field = std::make_shared<Field>(std::move(loaded.field));
    field->index_to_world = field->index_to_world * to_world();
    return field;
  }

  bool has_grid(const std::filesystem::path& file, const std::string& name) const {
    const std::vector<GridInfo> grids = list_grid_heads(file);
    return std::any_of(grids.begin(), grids.end(),
                       [&](const GridInfo& info) { return info.name == name; });
  }

  SceneMedium volume_file(const Box3d& /*extent*/) {
    const std::filesystem::path file = file_of(context_, list_, "filename");
    const std::string density_name = list_.get_string("gridname", "density");
    const std::string temperature_name = list_.get_string("temperaturename", "temperature");
    SceneMediumComponent component;
    read_coefficients(component);
    component.phase = phase();
    const auto density = grid(file, density_name);
    const double radiance_scale = nonnegative("Lescale", nonnegative("LeScale", 1));
    if (radiance_scale > 0 &&
        (list_.type_of("temperaturename") || has_grid(file, temperature_name))) {
      read_temperature(grid(file, temperature_name), component);
      component.radiance_scale = static_cast<float>(radiance_scale);
    } else {
      read_emission(component, radiance_scale);
    }
    for (const char* name : {"temperaturescale", "temperatureoffset", "temperaturecutoff"}) {
      list_.get_float(name, 0);  // of no use without temperatures, but no mistake
    }
    return {medium_.name, medium_of(density, component, false), {component}};
  }

  /// @param clipped whether it ends at the faces of its outer voxels
  std::shared_ptr<const Medium> medium_of(const std::shared_ptr<const Field>& density,
                                          const SceneMediumComponent& values, bool clipped) const {
    Component component;
    component.density = density;
    component.sigma_s = Rgb(static_cast<float>(largest_ * values.scale));
    Medium medium({component}, context_.options.super_voxel);
    float densest = 0;
    for (const WalkPart& part : medium.parts()) {
      for (const float maximum : part.cells.maxima) densest = std::max(densest, maximum);
    }
    if (!std::isfinite(densest * component.sigma_s[0])) {
      fail("the extinction, a density of {} times {}, is too large for a float", densest,
           largest_ * values.scale);
    }
    return std::make_shared<const Medium>(clipped ? medium.clipped_to_voxels() : std::move(medium));
  }

  BuildContext& context_;
  const PbrtMedium& medium_;
  const ParameterList& list_;
  double largest_ = 0;  // sigma_t
};

}  // namespace

void name_media(BuildContext& context) {
  MediumId next = 0;
  for (const PbrtMedium& medium : context.pbrt.media) context.media[medium.name] = next++;
}

MediumId medium_of(const BuildContext& context, const std::string& name) {
  return name.empty() ? kVacuum : context.media.at(name);
}

void build_media(BuildContext& context, const Box3d& extent) {
  for (const PbrtMedium& medium : context.pbrt.media) {
    context.scene.media.push_back(MediumReader(context, medium).read(extent));
    medium.parameters.report_unused(context.diagnostics);
  }
}

}  // namespace freepath
