// The volume within a mesh.
#pragma once
#include "models/values/mesh.h"

inline double volume(const sundog::Mesh& mesh) {
  using glm::dvec3;
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    sum += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return sum;
}
