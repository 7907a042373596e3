#include "freepath/geometry/loop_subdivision.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>

#include "freepath/base/error.h"

namespace freepath {

namespace {

constexpr int kNone = -1;

int next_corner(int corner) { return (corner + 1) % 3; }
int previous_corner(int corner) { return (corner + 2) % 3; }

/// The triangles of one level and who is next to whom. Edge k of a triangle goes from its corner k
/// to the next.
class Level {
 public:
  Level(std::vector<Vec3d> positions, std::vector<int> indices)
      : positions_(std::move(positions)), indices_(std::move(indices)) {
    connect();
  }

  Level refine() const;
  /// Positions and normals on the limit surface.
  TriangleMesh limit() const;

 private:
  int face_count() const { return static_cast<int>(indices_.size() / 3); }
  int vertex(int face, int corner) const { return indices_[std::size_t{3} * face + corner]; }
  int neighbour(int face, int edge) const { return neighbours_[std::size_t{3} * face + edge]; }
  int corner_of(int face, int vertex) const;

  void connect();
  /// The vertices around one: clockwise from anywhere, or from one end of the boundary to the
  /// other, counterclockwise.
  void ring(int centre, std::vector<int>& around) const;
  bool is_boundary(int centre) const;
  Vec3d moved(int centre, double interior_weight, double boundary_weight,
              const std::vector<int>& around) const;
  Vec3d edge_point(int face, int edge) const;
  Vec3d normal(int centre, const std::vector<int>& around) const;

  std::vector<Vec3d> positions_;
  std::vector<int> indices_;
  std::vector<int> neighbours_;  // for each edge of each triangle the triangle beyond
  std::vector<int> edges_;       // for each edge of each triangle its number
  std::vector<int> first_face_;  // for each vertex one triangle around it
  std::vector<bool> boundary_;   // for each vertex
  int edge_count_ = 0;
};

int Level::corner_of(int face, int wanted) const {
  for (int corner = 0; corner < 3; ++corner) {
    if (vertex(face, corner) == wanted) return corner;
  }
  return kNone;
}

void Level::connect() {
  neighbours_.assign(indices_.size(), kNone);
  edges_.assign(indices_.size(), kNone);
  first_face_.assign(positions_.size(), kNone);
  std::unordered_map<uint64_t, std::size_t> open;  // edges by their ends, to where they were seen
  open.reserve(indices_.size());
  const auto key = [](int from, int to) {
    return uint64_t{static_cast<uint32_t>(from)} << 32 | static_cast<uint32_t>(to);
  };
  for (int face = 0; face < face_count(); ++face) {
    for (int edge = 0; edge < 3; ++edge) {
      const int from = vertex(face, edge);
      const int to = vertex(face, next_corner(edge));
      const std::size_t here = std::size_t{3} * face + edge;
      first_face_[from] = face;
      if (!open.emplace(key(from, to), here).second) {
        fail(
            "the edge from vertex {} to vertex {} belongs to triangle {} and to another in the "
            "same sense; turn one of them over, or part them",
            from, to, face);
      }
      const auto opposite = open.find(key(to, from));
      if (opposite == open.end()) {
        edges_[here] = edge_count_++;
        continue;
      }
      const std::size_t there = opposite->second;
      neighbours_[here] = static_cast<int>(there / 3);
      neighbours_[there] = face;
      edges_[here] = edges_[there];
    }
  }
  boundary_.assign(positions_.size(), false);
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    boundary_[i] = is_boundary(static_cast<int>(i));
  }
}

bool Level::is_boundary(int centre) const {
  int face = first_face_[centre];
  if (face == kNone) return true;
  do {
    face = neighbour(face, corner_of(face, centre));
  } while (face != kNone && face != first_face_[centre]);
  return face == kNone;
}

void Level::ring(int centre, std::vector<int>& around) const {
  around.clear();
  int face = first_face_[centre];
  if (face == kNone) return;
  if (!boundary_[centre]) {
    do {
      const int corner = corner_of(face, centre);
      around.push_back(vertex(face, next_corner(corner)));
      face = neighbour(face, corner);
    } while (face != first_face_[centre]);
    return;
  }
  for (int beyond = face; beyond != kNone; beyond = neighbour(face, corner_of(face, centre))) {
    face = beyond;
  }
  around.push_back(vertex(face, next_corner(corner_of(face, centre))));
  while (face != kNone) {
    const int edge = previous_corner(corner_of(face, centre));
    around.push_back(vertex(face, edge));
    face = neighbour(face, edge);
  }
}

/// The centre with a weight on each vertex around it, on the boundary on the outer two.
Vec3d Level::moved(int centre, double interior_weight, double boundary_weight,
                   const std::vector<int>& around) const {
  const Vec3d& p = positions_[centre];
  if (around.empty()) return p;
  if (boundary_[centre]) {
    return p * (1 - 2 * boundary_weight) +
           (positions_[around.front()] + positions_[around.back()]) * boundary_weight;
  }
  Vec3d sum(0);
  for (const int other : around) sum += positions_[other];
  return p * (1 - static_cast<double>(around.size()) * interior_weight) + sum * interior_weight;
}

double vertex_weight(std::size_t edges) {
  return edges == 3 ? 3.0 / 16 : 3.0 / (8.0 * static_cast<double>(edges));
}

Vec3d Level::edge_point(int face, int edge) const {
  const int from = vertex(face, edge);
  const int to = vertex(face, next_corner(edge));
  const Vec3d ends = positions_[from] + positions_[to];
  const int beyond = neighbour(face, edge);
  if (beyond == kNone) return ends * 0.5;
  const int here = vertex(face, previous_corner(edge));
  const int there = vertex(beyond, previous_corner(corner_of(beyond, to)));
  return ends * 0.375 + (positions_[here] + positions_[there]) * 0.125;
}

Level Level::refine() const {
  const std::size_t old_count = positions_.size();
  std::vector<Vec3d> positions(old_count + edge_count_);
  std::vector<int> around;
  for (std::size_t i = 0; i < old_count; ++i) {
    const int centre = static_cast<int>(i);
    ring(centre, around);
    positions[i] = moved(centre, vertex_weight(around.size()), 1.0 / 8, around);
  }
  std::vector<int> indices;
  indices.reserve(4 * indices_.size());
  for (int face = 0; face < face_count(); ++face) {
    std::array<int, 3> middle{};
    for (int edge = 0; edge < 3; ++edge) {
      const int number = edges_[std::size_t{3} * face + edge];
      middle[edge] = static_cast<int>(old_count) + number;
      positions[old_count + number] = edge_point(face, edge);
    }
    for (int corner = 0; corner < 3; ++corner) {
      // Each corner keeps its place, and with it the default texture coordinates.
      std::array<int, 3> child{};
      child[corner] = vertex(face, corner);
      child[next_corner(corner)] = middle[corner];
      child[previous_corner(corner)] = middle[previous_corner(corner)];
      indices.insert(indices.end(), child.begin(), child.end());
    }
    indices.insert(indices.end(), {middle[0], middle[1], middle[2]});
  }
  return Level(std::move(positions), std::move(indices));
}

/// The cross product of two tangents.
Vec3d Level::normal(int centre, const std::vector<int>& around) const {
  const std::size_t n = around.size();
  if (n < 2) return Vec3d(0, 0, 1);
  const auto at = [&](std::size_t k) { return positions_[around[k]]; };
  Vec3d s(0);
  Vec3d t(0);
  if (!boundary_[centre]) {
    for (std::size_t k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
      s += at(k) * std::cos(angle);
      t += at(k) * std::sin(angle);
    }
    return s.cross(t);
  }
  const Vec3d& p = positions_[centre];
  s = at(n - 1) - at(0);
  if (n == 2) {
    t = at(0) + at(1) - p * 2;
  } else if (n == 3) {
    t = at(1) - p;
  } else if (n == 4) {
    t = at(1) * 2 + at(2) * 2 - at(0) - at(3) - p * 2;
  } else {
    const double theta = std::numbers::pi / static_cast<double>(n - 1);
    t = (at(0) + at(n - 1)) * -std::sin(theta);
    for (std::size_t k = 1; k + 1 < n; ++k) {
      t += at(k) * ((2 - 2 * std::cos(theta)) * std::sin(static_cast<double>(k) * theta));
    }
  }
  return s.cross(t);
}

TriangleMesh Level::limit() const {
  TriangleMesh mesh;
  mesh.indices = indices_;
  Level on_limit = *this;
  std::vector<int> around;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const int centre = static_cast<int>(i);
    ring(centre, around);
    const auto n = static_cast<double>(around.size());
    const double weight = around.empty() ? 0 : 1 / (n + 3 / (8 * vertex_weight(around.size())));
    on_limit.positions_[i] = moved(centre, weight, 1.0 / 5, around);
  }
  // The tangents are those of the polygon that the limit positions make, as in pbrt.
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const int centre = static_cast<int>(i);
    ring(centre, around);
    mesh.normals.emplace_back(on_limit.normal(centre, around));
  }
  mesh.positions = std::move(on_limit.positions_);
  return mesh;
}

}  // namespace

TriangleMesh subdivide_loop(std::span<const Vec3d> positions, std::span<const int> indices,
                            int levels) {
  if (levels < 0 || levels > 12) {
    fail("{} levels of subdivision; give 0 to 12, each makes four triangles of one", levels);
  }
  TriangleMesh mesh;
  mesh.positions.assign(positions.begin(), positions.end());
  mesh.indices.assign(indices.begin(), indices.end());
  SurfaceShape shape;
  shape.geometry = mesh;
  check(shape);
  Level level(std::move(mesh.positions), std::move(mesh.indices));
  for (int i = 0; i < levels; ++i) level = level.refine();
  return level.limit();
}

}  // namespace freepath
