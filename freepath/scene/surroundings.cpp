#include "freepath/scene/surroundings.h"

#include <algorithm>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/io/image.h"
#include "freepath/lights/sky.h"
#include "freepath/spectra/rgb_color_space.h"
#include "freepath/spectra/rgb_spectrum.h"

namespace freepath {
namespace {

void check_radiance(const Rgb& radiance) {
  if (is_finite(radiance) && std::min({radiance.x, radiance.y, radiance.z}) >= 0) return;
  fail("the radiance of the environment is {},{},{}; it must be finite and not negative",
       radiance.x, radiance.y, radiance.z);
}

}  // namespace

Surroundings make_surroundings(const LightOptions& options, UpAxis up,
                               std::vector<std::string>* warnings) {
  Surroundings result;
  if (options.sun) result.sun.emplace(options.sun_parameters, up);
  if (const auto* radiance = std::get_if<Rgb>(&options.environment)) {
    check_radiance(*radiance);
    result.environment = *radiance;
  } else if (const auto* file = std::get_if<std::string>(&options.environment)) {
    Image image = read_image(*file);
    std::string warning = mend_invalid_pixels(image, *file, options.invalid);
    if (!warning.empty() && warnings != nullptr) warnings->push_back(std::move(warning));
    result.environment = ImageEnvironment(image, up, *file);
  } else {
    result.environment = make_sky(options.sun_parameters, up);
  }
  return result;
}

std::vector<LightDescription> to_lights(const Surroundings& surroundings, SpectrumTable& table) {
  std::vector<LightDescription> lights;
  if (!surroundings.environment) {
    // The sun alone.
  } else if (const auto* radiance = std::get_if<Rgb>(&*surroundings.environment)) {
    check_radiance(*radiance);
    const RgbSpectrum light = RgbSpectrum::illuminant(Vec3d(*radiance), rgb_color_space("srgb"));
    lights.emplace_back(ConstantInfiniteLight{
        .name = "the environment", .radiance = table.add(light, SpectrumRole::kIlluminant)});
  } else {
    lights.emplace_back(
        EnvironmentLight{.environment = std::get<ImageEnvironment>(*surroundings.environment)});
  }
  if (surroundings.sun) lights.emplace_back(SunLight{.sun = *surroundings.sun});
  return lights;
}

}  // namespace freepath
