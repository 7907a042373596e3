#include "freepath/scene/assembly/build_lights.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/io/image.h"
#include "freepath/scene/assembly/entity_kinds.h"

namespace freepath {
namespace {

/// Reads one statement.
class LightReader {
 public:
  LightReader(BuildContext& context, const ParameterList& list, const Matrix4d& to_world)
      : context_(context), list_(list), to_world_(to_world) {}

  LightDescription read(const PbrtEntity& light) {
    constexpr EntityKind<LightDescription (LightReader::*)()> kKinds[] = {
        {"distant", &LightReader::distant},       {"goniometric", &LightReader::goniometric},
        {"infinite", &LightReader::infinite},     {"point", &LightReader::point},
        {"projection", &LightReader::projection}, {"spot", &LightReader::spot},
    };
    const auto make = maker_of(light, "light", kKinds);
    return (this->*make)();
  }

  SpectrumId spectrum(std::string_view name) {
    const RgbColorSpace& space = context_.scene.spectra->space();
    const SpectralDistribution light = list_.type_of(name)
                                           ? distribution_of(context_, list_.get_spectrum(name, {}),
                                                             ColorMeaning::kIlluminant, list_, name)
                                           : SpectralDistribution(space.illuminant());
    return context_.scene.spectra->add(light, SpectrumRole::kIlluminant);
  }
  double scale() { return list_.get_float("scale", 1); }
  std::optional<double> given(std::string_view name) {
    if (!list_.type_of(name)) return {};
    return list_.get_float(name, 0);
  }
  std::string name() const { return to_string(list_.location()); }

  LightImage image(std::string_view parameter) {
    const std::string path = file_of(context_, list_, parameter).string();
    return LightImage{path, read_scene_image(context_, path, list_.location_of(parameter))};
  }

 private:
  std::optional<PortalCorners> portal() {
    const std::vector<Vec3d> corners = list_.get_points("portal");
    if (corners.empty()) return {};
    if (corners.size() != 4) {
      fail_at(list_.location_of("portal"), "a portal has 4 corners, not {}", corners.size());
    }
    PortalCorners result;
    for (int i = 0; i < 4; ++i) result[i] = corners[i] * to_world_;
    return result;
  }

  LightDescription infinite() {
    if (list_.type_of("filename")) {
      if (list_.type_of("L")) {
        fail_at(list_.location_of("L"), "give an infinite light 'L' or 'filename', not both");
      }
      return ImageInfiniteLight{.name = name(),
                                .image = image("filename"),
                                .mapping = SphereMapping::kOctahedral,
                                .scale = scale(),
                                .illuminance = given("illuminance"),
                                .light_to_world = to_world_,
                                .portal = portal()};
    }
    return ConstantInfiniteLight{.name = name(),
                                 .radiance = spectrum("L"),
                                 .scale = scale(),
                                 .illuminance = given("illuminance"),
                                 .portal = portal()};
  }

  LightDescription distant() {
    return DistantLight{.name = name(),
                        .radiance = spectrum("L"),
                        .scale = scale(),
                        .illuminance = given("illuminance"),
                        .from = list_.get_point("from", Vec3d(0, 0, 0)),
                        .to = list_.get_point("to", Vec3d(0, 0, 1)),
                        .light_to_world = to_world_};
  }

  LightDescription point() {
    return PointLight{.name = name(),
                      .intensity = spectrum("I"),
                      .scale = scale(),
                      .power = given("power"),
                      .from = list_.get_point("from", Vec3d(0, 0, 0)),
                      .light_to_world = to_world_};
  }

  LightDescription spot() {
    return SpotLight{.name = name(),
                     .intensity = spectrum("I"),
                     .scale = scale(),
                     .power = given("power"),
                     .from = list_.get_point("from", Vec3d(0, 0, 0)),
                     .to = list_.get_point("to", Vec3d(0, 0, 1)),
                     .cone_angle = list_.get_float("coneangle", 30),
                     .cone_delta_angle = list_.get_float("conedeltaangle", 5),
                     .light_to_world = to_world_};
  }

  LightDescription goniometric() {
    GoniometricLight light;
    light.name = name();
    light.intensity = spectrum("I");
    if (list_.type_of("filename")) light.image = image("filename");
    light.scale = scale();
    light.power = given("power");
    light.light_to_world = to_world_;
    return light;
  }

  LightDescription projection() {
    if (!list_.type_of("filename")) {
      fail_at(list_.location(), "a projection light needs 'filename': the image that it shows");
    }
    ProjectionLight light;
    light.name = name();
    light.image = image("filename");
    light.fov = list_.get_float("fov", 90);
    light.scale = scale();
    light.power = given("power");
    light.light_to_world = to_world_;
    return light;
  }

  BuildContext& context_;
  const ParameterList& list_;
  Matrix4d to_world_;
};

}  // namespace

std::vector<LightDescription> build_lights(BuildContext& context) {
  std::vector<LightDescription> lights;
  for (const PbrtLight& light : context.pbrt.lights) {
    if (light.world_from_light.is_animated()) {
      context.diagnostics.warn(light.location,
                               "moving lights are not supported: this one stands as at the start");
    }
    lights.push_back(
        LightReader(context, light.parameters, light.world_from_light.start).read(light));
    light.parameters.report_unused(context.diagnostics);
  }
  return lights;
}

AreaEmission build_emission(BuildContext& context, const PbrtAreaLight& light) {
  if (light.type != "diffuse") {
    fail_unknown_type(light, "area light", std::array<std::string_view, 1>{"diffuse"});
  }
  LightReader reader(context, light.parameters, Matrix4d());
  AreaEmission emission;
  emission.name = reader.name();
  const ParameterList& list = light.parameters;
  if (list.type_of("filename")) {
    if (list.type_of("L")) {
      fail_at(list.location_of("L"), "give an area light 'L' or 'filename', not both");
    }
    emission.image = reader.image("filename");
  } else {
    emission.radiance = reader.spectrum("L");
  }
  emission.scale = reader.scale();
  emission.power = reader.given("power");
  emission.two_sided = list.get_bool("twosided", false);
  list.report_unused(context.diagnostics);
  return emission;
}

}  // namespace freepath
