#include "freepath/io/volume_write.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "freepath/io/volume.h"
#include "tests/io/volume_files.h"

namespace freepath {
namespace {

using namespace testing_volumes;  // NOLINT(google-build-using-namespace)

Field sample_field(const std::string& name, float scale) {
  BrickMapBuilder builder(Vec3i(-20, 0, 0), Vec3i(60, 40, 40), 8);
  for (int i = 0; i < 300; ++i) {
    builder.set_voxel(Vec3i(i % 81 - 20, i % 37, i % 23), scale * static_cast<float>(i + 1));
  }
  builder.add_constant_brick(Vec3i(5, 3, 4), 0.5F);
  Field field{name, std::move(builder).finish(), Matrix4d()};
  field.index_to_world.setScale(Vec3d(0.25));
  field.index_to_world[3][1] = 7;
  return field;
}

void expect_same_voxels(const Field& a, const Field& b, float tolerance) {
  for (int x = -22; x <= 62; ++x) {
    for (int y = -2; y <= 42; ++y) {
      for (int z = -2; z <= 42; ++z) {
        const float expected = a.voxels.value(Vec3i(x, y, z));
        ASSERT_NEAR(b.voxels.value(Vec3i(x, y, z)), expected, tolerance * expected);
      }
    }
  }
}

TEST(VolumeWrite, WhatIsWrittenIsReadBack) {
  const TemporaryFolder folder;
  const Field density = sample_field("density", 0.01F), heat = sample_field("temperature", 1);
  const Field* const fields[] = {&density, &heat};
  for (const bool half : {false, true}) {
    write_vdb(folder / "a.vdb", fields, {.half = half});
    const auto infos = list_grids(folder / "a.vdb");
    ASSERT_EQ(infos.size(), 2U);
    EXPECT_EQ(infos[0].type, half ? "half" : "float");
    EXPECT_EQ(infos[0].grid_class, "fog volume");
    for (const Field* field : fields) {
      LoadOptions options;
      options.selection.name = field->name;
      const LoadedField loaded = load_field(folder / "a.vdb", options);
      EXPECT_EQ(loaded.field.index_to_world, field->index_to_world);
      EXPECT_EQ(loaded.active_tiles, 1U);
      expect_same_voxels(*field, loaded.field, half ? 0x1p-11F : 0);
    }
  }
}

TEST(VolumeWrite, NothingButTheFileIsLeft) {
  const TemporaryFolder folder;
  const Field field = sample_field("density", 1);
  const Field* const fields[] = {&field};
  write_vdb(folder / "a.vdb", fields);
  const auto files = std::distance(std::filesystem::directory_iterator(folder.path()), {});
  EXPECT_EQ(files, 1);
}

TEST(VolumeWrite, AFailureLeavesTheOldFileAndNoPart) {
  const TemporaryFolder folder;
  Field field = sample_field("density", 1);
  const Field* const fields[] = {&field};
  write_vdb(folder / "a.vdb", fields);
  const Bytes before = read_bytes(folder / "a.vdb");
  field.index_to_world.setScale(Vec3d(0));  // can't be inverted, hence not be written
  EXPECT_THROW(write_vdb(folder / "a.vdb", fields), Error);
  EXPECT_THROW(write_vdb(folder / "b.vdb", fields), Error);
  EXPECT_EQ(read_bytes(folder / "a.vdb"), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(VolumeWrite, BadPlacesAreErrors) {
  const TemporaryFolder folder;
  const Field field = sample_field("density", 1);
  const Field* const fields[] = {&field};
  EXPECT_NE(error_of([&] { write_vdb(folder / "none" / "a.vdb", fields); }).find("a.vdb"),
            std::string::npos);
  EXPECT_NE(error_of([&] { write_vdb(folder.path(), fields); }).find("is a directory"),
            std::string::npos);
  EXPECT_THROW(write_vdb(folder / "a.vdb", {}), Error);
}

}  // namespace
}  // namespace freepath
