// Any bytes as a PLY file, packed or not: a mesh whose faces refer to vertices that there are, or
// an Error.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "freepath/geometry/ply_file.h"
#include "tests/fuzz/fuzz_checks.h"

namespace freepath::fuzz {
namespace {

void check_indices(const std::vector<int>& indices, std::size_t corners, std::size_t vertices) {
  require(indices.size() % corners == 0, "faces are whole");
  for (const int index : indices) {
    require(index >= 0 && static_cast<std::size_t>(index) < vertices, "vertices are there");
  }
}

void check_ply(std::string_view bytes) {
  const std::string name = "mesh.ply";
  attempt(name, [&] {
    const PlyMesh mesh = parse_ply(bytes, name);
    const std::size_t vertices = mesh.positions.size();
    check_indices(mesh.triangles, 3, vertices);
    check_indices(mesh.quads, 4, vertices);
    require(mesh.normals.empty() || mesh.normals.size() == vertices, "each has a normal or none");
    require(mesh.uvs.empty() || mesh.uvs.size() == vertices, "each has a uv or none");
    require(!mesh.shapes().empty(), "a mesh is a shape");
  });
}

}  // namespace
}  // namespace freepath::fuzz

// The name is libFuzzer's. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  freepath::fuzz::check_ply({reinterpret_cast<const char*>(data), size});
  return 0;
}
