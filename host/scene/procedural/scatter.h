// Places on a surface, strewn by chance.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "models/values/mesh.h"

namespace sundog {

struct Scatter {
  double density = 1;  // places for each square unit
  std::uint64_t seed = 1;
  glm::dvec2 scale{1, 1};  // the range of sizes
  double turn = 360;       // degrees about the axis, from 0
  bool upright = false;    // the axis is y, else the surface's normal
  double steepest = 180;   // degrees between y and the normal of triangles that carry places
};

/// A mesh where it lies.
struct Ground {
  const Mesh& mesh;
  glm::dmat4 place{1};
};

/// Sizes, rotations and places on the ground, in the ground's coordinates; `index` is a number in [0, 1) by
/// which to choose.
struct ScatteredPlace {
  glm::dmat4 place{1};
  double index = 0;
};

/// The places; more than `limit` are none, and `wanted` says how many there would be. Equal inputs give equal
/// places, in the order of the triangles, evenly by their area.
std::vector<ScatteredPlace> scatter(const Scatter& how, std::span<const Ground> grounds, std::size_t limit,
                                    double& wanted);

}  // namespace sundog
