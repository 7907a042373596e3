// Shapes that are told in two ways give the same picture.

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/scene/twin_scenes.h"

namespace freepath::testing {
namespace {

const std::string kFog =
    R"(MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [ .2 .2 .2 ] )"
    "\"rgb sigma_s\" [ 2 2 2 ]\n";

/// What shapes are made of.
const char* const kSurfaces[] = {R"(Material "diffuse" )", R"(Material "dielectric" )",
                                 R"(Material "interface" MediumInterface "m" "" )"};

/// The box of box_shape() as bilinear patches; their u and v run so that normals point outwards.
std::string patches() {
  return R"(Shape "bilinearmesh" "point3 P" [ -1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  )"
         R"(1 -1 1  -1 1 1  1 1 1 ] "integer indices" [ 0 2 1 3  4 5 6 7  0 1 4 5  2 6 3 7  )"
         "0 4 2 6  1 3 5 7 ]\n";
}

TEST(SceneShapeTwins, BoxOfTrianglesIsThatOfPatches) {
  const std::string turned = "Rotate 30 1 2 0 Scale .8 .8 .8 ";
  for (const std::string surface : kSurfaces) {
    const std::string begin = fmt::format("{}AttributeBegin {}{}", kFog, surface, turned);
    expect_twins(surface, stage(begin + box_shape(Vec3d(-1), Vec3d(1)) + "AttributeEnd\n"),
                 stage(begin + patches() + "AttributeEnd\n"), 128);
  }
}

/// A sphere of triangles: each of the eight of an octahedron cut in four, again and again.
struct RoundMesh {
  std::vector<Vec3d> points;
  std::vector<int> indices;
};

RoundMesh round_mesh(int levels) {
  RoundMesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                 {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, added] =
          middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.points.size()));
      if (added) mesh.points.push_back((mesh.points[a] + mesh.points[b]).normalized());
      return found->second;
    };
    std::vector<int> finer;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const int a = mesh.indices[i];
      const int b = mesh.indices[i + 1];
      const int c = mesh.indices[i + 2];
      const int ab = middle(a, b);
      const int bc = middle(b, c);
      const int ca = middle(c, a);
      for (const int index : {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca}) {
        finer.push_back(index);
      }
    }
    mesh.indices = std::move(finer);
  }
  return mesh;
}

void write_ply(const std::filesystem::path& path, const RoundMesh& mesh) {
  std::ofstream file(path);
  file << "ply\nformat ascii 1.0\nelement vertex " << mesh.points.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
       << mesh.indices.size() / 3 << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& point : mesh.points) {
    file << point.x << " " << point.y << " " << point.z << "\n";
  }
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    file << "3 " << mesh.indices[i] << " " << mesh.indices[i + 1] << " " << mesh.indices[i + 2]
         << "\n";
  }
}

// Edges of length e cut off e²/8 of the radius at most: 3e-4 of it here.
TEST(SceneShapeTwins, SphereIsNearlyAMeshOfManyTriangles) {
  const TemporaryFile file("round.ply");
  write_ply(file.path(), round_mesh(5));
  for (const std::string surface : {kSurfaces[0], kSurfaces[2]}) {
    const std::string begin = fmt::format("{}AttributeBegin {}", kFog, surface);
    expect_twins(surface, stage(begin + "Shape \"sphere\" AttributeEnd\n"),
                 stage(begin + R"(Shape "plymesh" "string filename" ")" + file.path().string() +
                       "\" AttributeEnd\n"),
                 128, {.absolute = 5e-4, .largest_relative_error = 0.01});
  }
}

// Subdivision draws vertices e²/4 of the radius inwards: 2e-3 of it here.
TEST(SceneShapeTwins, SphereIsNearlyASubdividedMesh) {
  const RoundMesh mesh = round_mesh(4);
  std::string shape = R"(Shape "loopsubdiv" "integer levels" 1 "point3 P" [ )";
  for (const Vec3d& point : mesh.points)
    shape += fmt::format("{} {} {} ", point.x, point.y, point.z);
  shape += R"(] "integer indices" [ )";
  for (const int index : mesh.indices) shape += std::to_string(index) + " ";
  const std::string begin = R"(AttributeBegin Material "diffuse" )";
  expect_twins("subdivided", stage(begin + "Shape \"sphere\" AttributeEnd\n"),
               stage(begin + shape + "] AttributeEnd\n"), 128,
               {.absolute = 2e-3, .largest_relative_error = 0.01});
}

TEST(SceneShapeTwins, InstancesAreTheShapesWrittenOut) {
  const std::string things =
      R"(AttributeBegin Material "diffuse" "rgb reflectance" [ .7 .2 .1 ] )"
      "Translate -.2 0 0 Shape \"sphere\" \"float radius\" .4 AttributeEnd\n"
      R"(AttributeBegin Material "dielectric" Translate .5 .3 0 Shape "sphere" "float radius" )"
      ".3 AttributeEnd\n" +
      medium_box("m", Vec3d(-0.9, -0.2, -0.5), Vec3d(-0.65, 0.9, 0.5));
  const char* const transforms[] = {"Translate -.7 .5 0 Rotate 40 0 1 0 ",
                                    "Translate .6 -.8 .5 Scale 1.3 .8 1 ",
                                    "Translate .9 .7 .2 Scale -.6 .6 .6 "};
  std::string written = kFog;
  std::string instances = kFog + "ObjectBegin \"things\"\n" + things + "ObjectEnd\n";
  for (const std::string transform : transforms) {
    written += fmt::format("AttributeBegin {}{}AttributeEnd\n", transform, things);
    instances +=
        fmt::format("AttributeBegin {}ObjectInstance \"things\" AttributeEnd\n", transform);
  }
  expect_twins("instances", stage(written), stage(instances));
}

// A light shines to the side of its normal. A mirror takes the normal of a mesh along, and turns
// that of a quadric over, as in pbrt.
TEST(SceneShapeTwins, LightsThatAreTurnedOverAreThoseThatAreReversed) {
  const std::string light =
      R"(Material "diffuse" AreaLightSource "diffuse" "rgb L" [ 4 4 4 ] Translate 0 1.2 0 )";
  const auto scene = [&](const std::string& shape) {
    return stage("AttributeBegin " + light + shape +
                 R"( AttributeEnd AttributeBegin Material "diffuse" Shape "sphere" )"
                 "\"float radius\" 0.5 AttributeEnd\n");
  };
  const std::string disk = R"(Shape "disk")";
  const std::string triangles =
      R"(Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] )";
  const std::string up = R"("integer indices" [ 0 1 2  0 2 3 ])";
  const std::string down = R"("integer indices" [ 0 2 1  0 3 2 ])";
  const std::string flat = "Rotate -90 1 0 0 ";  // z becomes y
  const std::string mirror = "Scale 1 1 -1 ";
  const auto expect_same = [&](const char* name, const std::string& a, const std::string& b) {
    expect_twins(name, scene(a), scene(b), 128);
  };
  expect_same("disk", flat + "ReverseOrientation " + disk, "Rotate 90 1 0 0 " + disk);
  expect_same("mirrored disk", flat + "ReverseOrientation " + disk,
              flat + "ReverseOrientation " + mirror + disk);
  expect_same("mesh", flat + "ReverseOrientation " + triangles + up, flat + triangles + down);
  expect_same("mirrored mesh", flat + triangles + down, flat + mirror + triangles + up);
}

// A file of triangles and quads is two meshes, which shine each for itself.
TEST(SceneShapeTwins, LightOfAFileHasFacesOfAllKinds) {
  const auto write = [](const TemporaryFile& file, const std::string& faces, int count) {
    std::ofstream(file.path()) << "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\n"
                                  "property float y\nproperty float z\nelement face "
                               << count
                               << "\nproperty list uchar int vertex_indices\nend_header\n"
                                  "-1 -1 0\n0 -1 0\n0 1 0\n-1 1 0\n1 -1 0\n1 1 0\n"
                               << faces;
  };
  const TemporaryFile mixed("mixed.ply");
  const TemporaryFile triangles("triangles.ply");
  write(mixed, "3 0 1 2\n3 0 2 3\n4 1 4 5 2\n", 3);
  write(triangles, "3 0 1 2\n3 0 2 3\n3 1 4 5\n3 1 5 2\n", 4);
  const auto scene = [](const TemporaryFile& file) {
    return stage(R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [ 3 3 3 ] )"
                 R"("bool twosided" true Translate 0 -0.6 0 Rotate 60 1 1 0 )"
                 R"(Shape "plymesh" "string filename" ")" +
                 file.path().string() + "\" AttributeEnd\n");
  };
  expect_twins("faces", scene(mixed), scene(triangles), 128);
}

// Media lie on the side away from the normal, or on the other where the shape is reversed.
TEST(SceneShapeTwins, ReversedBoundarySwapsTheSidesOfMedia) {
  const std::string box = box_shape(Vec3d(-1), Vec3d(1));
  const std::string begin = kFog + R"(AttributeBegin Material "interface" )";
  expect_twins(
      "reversed", stage(begin + R"(MediumInterface "m" "" )" + box + "AttributeEnd\n"),
      stage(begin + R"(ReverseOrientation MediumInterface "" "m" )" + box + "AttributeEnd\n"), 128);
}

}  // namespace
}  // namespace freepath::testing
