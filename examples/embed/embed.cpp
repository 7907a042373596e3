// embed VOLUME.vdb: free paths through a file, and through a density that this program computes.

#include <freepath/base/error.h>
#include <freepath/io/volume.h>
#include <freepath/media/density_function.h>
#include <freepath/transport/sampling.h>

#include <cmath>
#include <cstdio>
#include <limits>

using namespace freepath;
namespace {

/// Parallel rays along +x that cross the middle of a box.
RayStream make_rays(const Box3d& box, std::size_t count) {
  RayStream rays;
  rays.resize(count);
  const Vec3d start = box.center() - Vec3d(box.size().x, 0, 0);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][i] = static_cast<float>(start[axis]);
      rays.direction[axis][i] = axis == 0 ? 1.0F : 0.0F;
    }
    rays.t_max[i] = std::numeric_limits<float>::infinity();
    rays.pixel[i] = 0;
    rays.sample[i] = static_cast<uint32_t>(i);  // its random numbers
    rays.stream[i] = 0;
  }
  return rays;
}

void sample(const char* name, const Medium& medium) {
  const RayStream rays = make_rays(medium.world_bounds(), 100'000);
  WalkSettings settings;
  settings.tracker = "auto";
  settings.transmittance = "residual-ratio";
  const FlightStream paths = sample_free_paths(medium, rays, settings);
  const FlightStream light = estimate_transmittance(medium, rays, settings);
  double escaped = 0;
  double transmittance = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    escaped += paths.event[i] == Event::kEscape ? 1 : 0;
    transmittance += light.weight[0][i];
  }
  const double count = static_cast<double>(rays.size());
  std::printf("%s: %.4f of the paths escape, transmittance %.4f\n", name, escaped / count,
              transmittance / count);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: embed VOLUME.vdb\n"), 2;
  const Component from_file{.density = std::make_shared<Field>(load_field(argv[1]).field)};
  sample(argv[1], Medium({from_file}));

  // exp(-|x|²) in the cube [-2,2]³: a ray through the middle sees erf(2) sqrt(pi) = 1.7642.
  const auto gaussian = [](std::span<const Vec3f> positions, std::span<float> densities) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      densities[i] = std::exp(-positions[i].length2());
    }
  };
  const auto bounds = [](const Box3f& part) -> DensityFunction::Bounds {
    Vec3f nearest, farthest;
    for (int axis = 0; axis < 3; ++axis) {
      const float low = part.min[axis], high = part.max[axis];
      nearest[axis] = low > 0 ? low : std::fmin(high, 0.0F);
      farthest[axis] = std::fmax(std::abs(low), std::abs(high));
    }
    return {std::exp(-farthest.length2()), std::exp(-nearest.length2())};
  };
  const Box3f box(Vec3f(-2), Vec3f(2));
  sample("gaussian",
         Medium({{.density = make_function_field("gaussian", {gaussian, bounds, box})}}));
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "embed: %s\n", error.what());
  return 1;
}
