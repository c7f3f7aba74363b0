// Divides the six faces evenly, projects their points, which are shared along edges, onto the unit sphere,
// and alternates the diagonals.
#include "scene/procedural/cube_grid.h"

#include <unordered_map>

#include "scene/procedural/random.h"

namespace sundog::procedural {

namespace {

// Grid points keyed by integer coordinates, so that adjacent faces share their edge.
class Points {
 public:
  Points(int cells, const glm::dvec3& stretch) : cells_(cells), stretch_(stretch) {}

  unsigned index(const glm::ivec3& at, std::vector<glm::dvec3>& directions) {
    const int key = (at.x * (cells_ + 1) + at.y) * (cells_ + 1) + at.z;
    const auto [found, added] = known_.try_emplace(key, static_cast<unsigned>(directions.size()));
    if (added) {
      const auto part = [&](int i) { return (2.0 * i / cells_ - 1.0); };
      directions.push_back(
          normalized({part(at.x) * stretch_.x, part(at.y) * stretch_.y, part(at.z) * stretch_.z}));
    }
    return found->second;
  }

 private:
  int cells_;
  glm::dvec3 stretch_;
  std::unordered_map<int, unsigned> known_;
};

}  // namespace

CubeGrid make_cube_grid(int cells, const glm::dvec3& stretch) {
  CubeGrid grid;
  Points points(cells, stretch);
  for (int face = 0; face < 6; face++) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool far_side = face % 2 == 1;
    for (int j = 0; j < cells; j++) {
      for (int i = 0; i < cells; i++) {
        const auto corner = [&](int di, int dj) {
          glm::ivec3 at{0, 0, 0};
          at[axis] = far_side ? cells : 0;
          at[u] = i + di;
          at[v] = j + dj;
          return points.index(at, grid.directions);
        };
        unsigned a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
        if (!far_side) std::swap(b, d);
        // Alternate diagonals to avoid directional bias.
        if ((i + j) % 2 == 0) {
          grid.triangles.push_back({a, b, c});
          grid.triangles.push_back({a, c, d});
        } else {
          grid.triangles.push_back({a, b, d});
          grid.triangles.push_back({b, c, d});
        }
      }
    }
  }
  return grid;
}

}  // namespace sundog::procedural
