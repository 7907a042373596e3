#include "freepath/scene/assembly/build_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

#include "freepath/base/counted.h"
#include "freepath/base/error.h"
#include "freepath/scene/assembly/build_media.h"
#include "freepath/scene/assembly/entity_kinds.h"
#include "freepath/spectra/white_balance.h"
#include "freepath/transport/auto_tracker.h"
#include "freepath/transport/walker.h"

namespace freepath {
namespace {

std::optional<double> given_float(const ParameterList& list, std::string_view name) {
  if (!list.type_of(name)) return {};
  return list.get_float(name, 0);
}

/// Parameters that change nothing in a picture of ours.
void pass_over(const ParameterList& list, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) list.type_of(name);
}

void warn_if_given(BuildContext& context, const ParameterList& list, std::string_view name,
                   std::string_view why) {
  if (!list.type_of(name)) return;
  context.diagnostics.warn(list.location_of(name), fmt::format("'{}' {}", name, why));
}

std::optional<ScreenWindow> screen_window(const ParameterList& list) {
  const std::span<const double> window = list.get_floats("screenwindow");
  if (window.empty()) return {};
  if (window.size() != 4) {
    fail_at(list.location_of("screenwindow"),
            "'screenwindow' has {}; it needs x minimum, x maximum, y minimum, y maximum",
            counted(window.size(), "value"));
  }
  return ScreenWindow{window[0], window[1], window[2], window[3]};
}

/// The part of a film that is rendered. pbrt's order is x0, x1, y0, y1.
std::optional<Crop> read_crop(BuildContext& context, const ParameterList& list,
                              const FilmSize& size) {
  const std::span<const int> bounds = list.get_integers("pixelbounds");
  const std::span<const double> window = list.get_floats("cropwindow");
  if (bounds.empty() && window.empty()) return {};
  const std::string_view name = bounds.empty() ? "cropwindow" : "pixelbounds";
  const SourceLocation& where = list.location_of(name);
  if (!bounds.empty() && !window.empty()) {
    context.diagnostics.warn(where, "'cropwindow' is left out, since there is 'pixelbounds'");
  }
  if (std::max(bounds.size(), window.size()) != 4) {
    fail_at(where, "'{}' needs x0, x1, y0, y1", name);
  }
  Crop crop{.fractions = true};
  if (bounds.empty()) {
    crop = {window[0], window[2], window[1], window[3], true};
  } else {
    const double x = 1.0 / size.width;
    const double y = 1.0 / size.height;
    crop = {bounds[0] * x, bounds[2] * y, bounds[1] * x, bounds[3] * y, true};
  }
  const Crop given = crop;
  for (double* const value : {&crop.x0, &crop.y0, &crop.x1, &crop.y1}) {
    *value = std::clamp(*value, 0.0, 1.0);
  }
  if (crop.x0 != given.x0 || crop.y0 != given.y0 || crop.x1 != given.x1 || crop.y1 != given.y1) {
    context.diagnostics.warn(where, fmt::format("'{}' reaches beyond the film: what is on it is "
                                                "rendered",
                                                name));
  }
  at_location(where, [&] { return pixel_window(crop, size.width, size.height); });
  return crop;
}

/// How long the shutter is open.
float exposure_time(const BuildContext& context) {
  if (!context.pbrt.camera) return 1;
  const ParameterList& camera = context.pbrt.camera->parameters;
  const double open = camera.get_float("shutteropen", 0);
  const double close = camera.get_float("shutterclose", 1);
  if (!(close > open)) {
    fail_at(camera.location_of("shutterclose"),
            "the shutter opens at {} and closes at {}: no light would reach the film", open, close);
  }
  return static_cast<float>(close - open);
}

WavelengthBuckets read_buckets(const ParameterList& list) {
  constexpr int kMost = 1000;
  WavelengthBuckets buckets;
  buckets.count = list.get_integer("nbuckets", 16);
  if (buckets.count < 1 || buckets.count > kMost) {
    fail_at(list.location_of("nbuckets"), "'nbuckets' is {}: it must be 1 to {}", buckets.count,
            kMost);
  }
  buckets.first = list.get_float("lambdamin", kShortestWavelength);
  buckets.last = list.get_float("lambdamax", kLongestWavelength);
  if (!(buckets.first < buckets.last)) {
    fail_at(list.location_of("lambdamax"), "wavelengths from {} to {} nm are no interval",
            buckets.first, buckets.last);
  }
  return buckets;
}

/// What light of a temperature looks like through a film that is balanced for it.
void read_sensor(BuildContext& context, const ParameterList& list, PictureSettings& picture) {
  const auto positive = [&](std::string_view name, double otherwise) {
    const double value = list.get_float(name, otherwise);
    if (!(value > 0)) {
      fail_at(list.location_of(name), "'{}' is {}: it must be more than 0", name, value);
    }
    return value;
  };
  // 'imagingratio' is the product of both others.
  const double exposure = positive("exposuretime", picture.exposure_scale);
  const double iso = positive("iso", 100);
  picture.exposure_scale = static_cast<float>(positive("imagingratio", exposure * iso / 100));
  const std::string sensor = list.get_string("sensor", "cie1931");
  const bool observer = sensor == "cie1931";
  constexpr double kCameraWhite = 6500;  // [K], of pbrt's measured sensors
  const double temperature = list.get_float("whitebalance", observer ? 0 : kCameraWhite);
  if (!observer) {
    context.diagnostics.warn(
        list.location_of("sensor"),
        fmt::format("the measured responses of the sensor {} are not part of freepath: an ideal "
                    "camera with the responses of the observer 'cie1931', balanced for {} K, takes "
                    "its place; hues are closer to the eye's, and the brightness of the whole "
                    "picture may differ",
                    in_quotes(sensor), temperature));
  }
  if (temperature == 0) return;
  picture.white_balance = at_location(list.location_of("whitebalance"), [&] {
    return white_balance(temperature, context.scene.spectra->space());
  });
}

void read_film(BuildContext& context, FilmSize& size, PictureSettings& picture) {
  if (!context.pbrt.film) return;
  const PbrtEntity& film = *context.pbrt.film;
  const ParameterList& list = film.parameters;
  constexpr std::string_view kKnown[] = {"rgb", "gbuffer", "spectral"};
  if (std::find(std::begin(kKnown), std::end(kKnown), film.type) == std::end(kKnown)) {
    fail_unknown_type(film, "film", kKnown);
  }
  if (film.type == "spectral") picture.buckets = read_buckets(list);
  size.width = list.get_integer("xresolution", size.width);
  size.height = list.get_integer("yresolution", size.height);
  if (size.width < 1 || size.height < 1 || double(size.width) * size.height > 1e9) {
    fail_at(film.location, "a film of {} x {} pixels can't be rendered", size.width, size.height);
  }
  picture.file_name = list.get_string("filename", "");
  read_sensor(context, list, picture);
  warn_if_given(context, list, "maxcomponentvalue",
                "is left out: to clip samples would bias the picture");
  picture.all_layers = film.type == "gbuffer";
  picture.crop = read_crop(context, list, size);
  pass_over(list, {"diagonal", "savefp16", "coordinatesystem"});
  list.report_unused(context.diagnostics);
}

void read_sampler(BuildContext& context, PictureSettings& picture) {
  if (!context.pbrt.sampler) return;
  const PbrtEntity& sampler = *context.pbrt.sampler;
  const ParameterList& list = sampler.parameters;
  constexpr std::string_view kKnown[] = {"independent", "halton",  "sobol",     "zsobol",
                                         "paddedsobol", "pmj02bn", "stratified"};
  if (std::find(std::begin(kKnown), std::end(kKnown), sampler.type) == std::end(kKnown)) {
    fail_unknown_type(sampler, "sampler", kKnown);
  }
  const bool independent = sampler.type == "independent";
  context.scene.samples = independent ? SampleKind::kIndependent : SampleKind::kSobol;
  if (!independent && sampler.type != "sobol" && sampler.type != "paddedsobol") {
    context.diagnostics.warn(
        sampler.location,
        fmt::format("the sampler '{}' is the one of padded Sobol' points here", sampler.type));
  }
  const auto count = [&](std::string_view name, int otherwise) {
    const int samples = list.get_integer(name, otherwise);
    if (samples < 1) {
      fail_at(list.location_of(name), "'{}' is {}: there have to be samples", name, samples);
    }
    return static_cast<int64_t>(samples);
  };
  int64_t samples = 0;
  if (sampler.type == "stratified") {
    samples = count("xsamples", 4) * count("ysamples", 4);
    pass_over(list, {"jitter"});
  } else {
    samples = count("pixelsamples", 16);
  }
  if (samples > std::numeric_limits<int>::max()) {
    fail_at(sampler.location, "{} samples of a pixel are too many", samples);
  }
  picture.samples = static_cast<uint32_t>(samples);
  picture.seed = static_cast<uint64_t>(list.get_integer("seed", static_cast<int>(picture.seed)));
  pass_over(list, {"randomization"});
  list.report_unused(context.diagnostics);
}

/// A tracker or estimator with its options; empty where none is named.
std::string method_name(const ParameterList& list, std::string_view name,
                        std::span<const MethodInfo> known) {
  std::string text = list.get_string(name, "");
  if (!text.empty()) {
    at_location(list.location_of(name), [&] { return parse_method(text, known); });
  }
  return text;
}

std::optional<Interpolation> read_interpolation(const ParameterList& list) {
  const std::string name = list.get_string("interpolation", "");
  if (name.empty()) return {};
  if (name == "nearest") return Interpolation::kNearest;
  if (name == "stochastic") return Interpolation::kStochastic;
  if (name == "trilinear") return Interpolation::kTrilinear;
  fail_at(list.location_of("interpolation"),
          "there is no interpolation {}; known are nearest, stochastic, trilinear",
          in_quotes(name));
}

void read_integrator(BuildContext& context, PictureSettings& picture) {
  if (!context.pbrt.integrator) return;
  const PbrtEntity& integrator = *context.pbrt.integrator;
  const ParameterList& list = integrator.parameters;
  constexpr std::string_view kKnown[] = {"volpath", "path"};
  if (std::find(std::begin(kKnown), std::end(kKnown), integrator.type) == std::end(kKnown)) {
    context.diagnostics.warn(integrator.location, fmt::format("the integrator {} is 'volpath' here",
                                                              in_quotes(integrator.type)));
  }
  const int depth = list.get_integer("maxdepth", 5);
  if (depth < 0) fail_at(list.location_of("maxdepth"), "'maxdepth' is {}", depth);
  picture.max_scatterings = static_cast<uint32_t>(depth);
  if (list.get_bool("regularize", false)) {
    context.diagnostics.warn(list.location_of("regularize"),
                             "'regularize' is left out: it would bias the picture");
  }
  picture.tracker = method_name(list, "tracker", tracker_choices());
  picture.transmittance = method_name(list, "transmittance", transmittance_infos());
  picture.interpolation = read_interpolation(list);
  pass_over(list, {"lightsampler"});
  list.report_unused(context.diagnostics);
}

PixelFilter make_filter(BuildContext& context) {
  if (!context.pbrt.filter) return PixelFilter();
  const PbrtEntity& filter = *context.pbrt.filter;
  const ParameterList& list = filter.parameters;
  const auto with_radii = [&](auto model) {
    model.x_radius = list.get_float("xradius", model.x_radius);
    model.y_radius = list.get_float("yradius", model.y_radius);
    return model;
  };
  const auto make = [&]() -> FilterModel {
    if (filter.type == "box") return with_radii(BoxFilter());
    if (filter.type == "triangle") return with_radii(TriangleFilter());
    if (filter.type == "gaussian") {
      GaussianFilter model = with_radii(GaussianFilter());
      model.sigma = list.get_float("sigma", model.sigma);
      return model;
    }
    if (filter.type == "mitchell") {
      MitchellFilter model = with_radii(MitchellFilter());
      model.b = list.get_float("B", model.b);
      model.c = list.get_float("C", model.c);
      return model;
    }
    if (filter.type == "sinc") {
      SincFilter model = with_radii(SincFilter());
      model.tau = list.get_float("tau", model.tau);
      return model;
    }
    constexpr std::string_view kKnown[] = {"box", "gaussian", "mitchell", "sinc", "triangle"};
    fail_unknown_type(filter, "pixel filter", kKnown);
  };
  const FilterModel model = make();
  list.report_unused(context.diagnostics);
  return at_location(filter.location, [&] { return PixelFilter(model); });
}

CameraModel make_camera_model(const PbrtEntity& camera) {
  const ParameterList& list = camera.parameters;
  const auto read_lens = [&](Lens& lens) {
    lens.radius = list.get_float("lensradius", lens.radius);
    lens.focal_distance = list.get_float("focaldistance", lens.focal_distance);
  };
  if (camera.type == "perspective") {
    PerspectiveCamera model;
    model.fov = list.get_float("fov", model.fov);
    model.frame_aspect_ratio = given_float(list, "frameaspectratio");
    model.screen_window = screen_window(list);
    read_lens(model.lens);
    return model;
  }
  if (camera.type == "orthographic") {
    OrthographicCamera model;
    model.frame_aspect_ratio = given_float(list, "frameaspectratio");
    model.screen_window = screen_window(list);
    read_lens(model.lens);
    return model;
  }
  if (camera.type == "spherical") {
    SphericalCamera model;
    const std::string mapping = list.get_string("mapping", "equalarea");
    if (mapping != "equalarea" && mapping != "equirectangular") {
      fail_at(list.location_of("mapping"),
              "there is no mapping {}; known are equalarea, equirectangular", in_quotes(mapping));
    }
    model.mapping =
        mapping == "equalarea" ? SphericalMapping::kEqualArea : SphericalMapping::kEquirectangular;
    return model;
  }
  constexpr std::string_view kKnown[] = {"perspective", "orthographic", "spherical"};
  fail_unknown_type(camera, "camera", kKnown);
}

}  // namespace

PictureSettings build_picture(BuildContext& context, FilmSize& size) {
  PictureSettings picture;
  for (const auto& option : context.pbrt.options.own()) {
    std::string name;
    for (const char c : option->name) {
      if (c != '_') name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    if (name == "seed") {
      if (const auto* const values = std::get_if<std::vector<int>>(&option->values)) {
        picture.seed = static_cast<uint64_t>(values->front());
        continue;
      }
    }
    context.diagnostics.warn(option->location,
                             fmt::format("the option '{}' is left out", option->name));
  }
  picture.exposure_scale = exposure_time(context);
  read_film(context, size, picture);
  read_sampler(context, picture);
  read_integrator(context, picture);
  return picture;
}

void build_camera(BuildContext& context, const FilmSize& size) {
  context.scene.filter = make_filter(context);
  if (!context.pbrt.camera) {
    PbrtCamera standard;
    context.scene.camera.emplace(PerspectiveCamera(), Matrix4d(), size.width, size.height);
    return;
  }
  const PbrtCamera& camera = *context.pbrt.camera;
  if (camera.camera_from_world.is_animated()) {
    context.diagnostics.warn(camera.location,
                             "a moving camera is not supported: it stands as at the start");
  }
  const CameraModel model = make_camera_model(camera);
  pass_over(camera.parameters, {"shutteropen", "shutterclose"});
  camera.parameters.report_unused(context.diagnostics);
  context.scene.camera = at_location(camera.location, [&] {
    return Camera(model, camera.camera_from_world.start.inverse(), size.width, size.height);
  });
  context.scene.camera_media.add(medium_of(context, camera.medium), 1);
}

}  // namespace freepath
