// Computes flat faces of caps, lathes and boxes and a rounded box's distance for the header's structs.
#include "models/values/solids.h"

namespace sundog {

void want_positive(double size, const char* name) {
  want(size > 0 && std::isfinite(size), fmt::format("a {} above 0, found {}", name, size));
}

FlatFaces cap_faces(double bottom_radius, double top_radius) {
  const dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  FlatFaces faces;
  if (bottom_radius > 0) faces.push_back({y, -y, bottom_radius * x, bottom_radius * z});
  if (top_radius > 0) faces.push_back({y, y, top_radius * x, top_radius * z});
  return faces;
}

FlatFaces ring_faces(const Revolution& revolution) {
  FlatFaces faces;
  for (const dvec2& ring : revolution.rings())
    faces.push_back({{0, 1, 0}, {0, ring.y, 0}, {ring.x, 0, 0}, {0, 0, ring.x}});
  return faces;
}

FlatFaces box_faces(const dvec3& half, double round) {
  FlatFaces faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      dvec3 n(0), u(0), v(0);
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      n[axis] = 1;
      u[next] = half[next] - round;
      v[last] = half[last] - round;
      faces.push_back({n, side * half[axis] * n, u, v});
    }
  return faces;
}

double box_distance(const dvec3& p, const dvec3& half, double round) {
  const dvec3 out = glm::abs(p) - (half - round);
  return glm::length(glm::max(out, dvec3(0))) + std::min(std::max({out.x, out.y, out.z}), 0.0) - round;
}

}  // namespace sundog
