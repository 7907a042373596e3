// array_call VOLUME.vdb RAYS OUT: free paths of rays in one call, as a program that embeds the
// library makes it; bench/python_call compares Python's with it. RAYS holds floats, six for each
// ray: origin and direction. OUT gets distances as floats. Prints the seconds that the thread has
// run in the call.

#include <cstdio>
#include <fstream>
#include <limits>
#include <vector>

#include "bench/timing.h"
#include "freepath/base/error.h"
#include "freepath/io/volume.h"
#include "freepath/transport/sampling.h"

using namespace freepath;
namespace {

std::vector<float> read_floats(const char* path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) fail("{}: can't be read", path);
  std::vector<float> values(static_cast<std::size_t>(file.tellg()) / sizeof(float));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(float)));
  return values;
}

RayStream rays_of(const std::vector<float>& values, const Vec3d& origin) {
  RayStream rays;
  rays.resize(values.size() / 6);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][i] = static_cast<float>(double{values[6 * i + axis]} - origin[axis]);
      rays.direction[axis][i] = values[6 * i + 3 + axis];
    }
    rays.t_max[i] = std::numeric_limits<float>::infinity();
    rays.pixel[i] = 0;
    rays.sample[i] = static_cast<uint32_t>(i);
    rays.stream[i] = 0;
  }
  return rays;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) return std::fprintf(stderr, "usage: array_call VOLUME.vdb RAYS OUT\n"), 2;
  const Medium medium({Component{.density = std::make_shared<Field>(load_field(argv[1]).field)}});
  WalkSettings settings;
  settings.origin = medium.world_bounds().center();
  const RayStream rays = rays_of(read_floats(argv[2]), settings.origin);
  const double begin = bench::thread_seconds();
  const FlightStream flights = sample_free_paths(medium, rays, settings);
  std::printf("%.6f\n", bench::thread_seconds() - begin);
  std::ofstream out(argv[3], std::ios::binary);
  out.write(reinterpret_cast<const char*>(flights.t.data()),
            static_cast<std::streamsize>(rays.size() * sizeof(float)));
  return out ? 0 : 1;
} catch (const Error& error) {
  std::fprintf(stderr, "array_call: %s\n", error.what());
  return 1;
}
