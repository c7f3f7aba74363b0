// Distributes random places over a surface.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "models/values/mesh.h"

namespace sundog {

struct Scatter {
  double density = 1;  // places per square unit
  std::uint64_t seed = 1;
  glm::dvec2 scale{1, 1};  // the range of sizes
  double turn = 360;       // maximum rotation about the axis, in degrees
  bool upright = false;    // the axis is y; otherwise the surface's normal
  double steepest = 180;   // maximum angle between y and normals of triangles that carry places, degrees
};

/// A mesh and its placement.
struct Ground {
  const Mesh& mesh;
  glm::dmat4 place{1};
};

/// A transform with position, rotation and size on the ground, in the ground's coordinates; `index` in [0, 1)
/// selects the object.
struct ScatteredPlace {
  glm::dmat4 place{1};
  double index = 0;
};

/// The places, or none if there would be more than `limit`; `wanted` receives their number. Equal inputs give
/// equal places, in the order of the triangles, evenly by area.
std::vector<ScatteredPlace> scatter(const Scatter& how, std::span<const Ground> grounds, std::size_t limit,
                                    double& wanted);

}  // namespace sundog
