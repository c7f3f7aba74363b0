// Mountains from noise, a picture of heights or a formula: a grid over a rectangle.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "formula/lower.h"
#include "scene/description.h"

namespace sundog {

struct Terrain {
  std::uint64_t seed = 1;
  glm::dvec2 size{10, 10};  // along x and z, about the origin
  double height = 2;        // height of the highest point above the lowest, which is at y = 0
  double feature = 4;       // width of the largest hills
  double ridges = 0.7;      // 0: rolling hills, 1: sharp ridges over flat valleys
  int octaves = 9;          // each half the size of the previous
  int cells = 256;          // along the longer side: up to 2 cells^2 triangles
  /// Replaces the noise: the mean of red, green and blue times `height` above y = 0, with the top towards -z.
  std::optional<Image> picture{};
  /// Replaces the noise: y at the point p of the rectangle, unscaled; yields one value.
  std::optional<LoweredPattern> formula{};
};

/// A smooth sheet that faces up, with u along x and v along -z. Heights are a sum of gradient noise whose
/// octaves count less in valleys (Musgrave, in Ebert et al. 2003, "Texturing and Modeling", chapter 16).
/// Throws GenerateError if a formula has no height up to 1e6 at some point.
Mesh make_terrain(const Terrain& terrain);

}  // namespace sundog
