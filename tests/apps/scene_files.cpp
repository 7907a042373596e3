#include "tests/apps/scene_files.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>

#include "freepath/io/image.h"
#include "freepath/io/volume_write.h"
#include "tests/media/make_field.h"

namespace freepath::testing {

namespace {

constexpr int kEdge = 16;

}  // namespace

float ball(const Vec3i& voxel) {
  const Vec3d offset = Vec3d(voxel) + Vec3d(0.5);
  const double inside = 1 - offset.length2() / 64;
  return inside > 0 ? static_cast<float>(2 * inside) : 0.0F;
}

void write_cube(const std::string& file, const Density& density, const Matrix4d& index_to_world) {
  const std::shared_ptr<Field> field =
      make_field(Vec3i(-kEdge / 2), Vec3i(kEdge / 2 - 1), density, index_to_world);
  field->name = "density";
  write_vdb(file, std::array<const Field*, 1>{field.get()});
}

void write_environment(const std::string& file, float value, float odd_value) {
  Image image{.width = 16, .height = 8, .channels = {"R", "G", "B"}};
  image.values.assign(image.pixel_count() * 3, value);
  image.pixel(5, 3)[1] = odd_value;
  write_exr(file, image);
}

void write_text(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

void truncate_file(const std::string& file, double part) {
  const auto size = static_cast<double>(std::filesystem::file_size(file));
  std::filesystem::resize_file(file, static_cast<uintmax_t>(size * part));
}

}  // namespace freepath::testing
