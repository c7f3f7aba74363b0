// Mountains from noise, from a picture of heights or by a formula: a grid over a rectangle.
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
  double height = 2;        // of the highest point over the lowest, which is at y = 0
  double feature = 4;       // width of the largest hills
  double ridges = 0.7;      // 0: rolling hills, 1: sharp ridges over flat valleys
  int octaves = 9;          // 1..16; each has half the size of the one before
  int cells = 256;          // along the longer side, 1..4096: up to 2 cells^2 triangles
  /// In place of noise: the mean of red, green and blue times `height` over y = 0, with the top towards -z.
  std::optional<Image> picture{};
  /// In place of noise: y at the point p of the rectangle, as it is; of one value.
  std::optional<LoweredPattern> formula{};
};

/// A sheet that faces up, smooth, with u along x and v along -z. Heights are a sum of gradient noise whose
/// octaves count less in valleys (Musgrave, in Ebert and others 2003, "Texturing and Modeling", chapter 16).
/// Throws GenerateError where a formula has no finite value.
Mesh make_terrain(const Terrain& terrain);

}  // namespace sundog
