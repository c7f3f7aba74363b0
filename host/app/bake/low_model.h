// The model that a map is baked for: which point of it each texel of the map shows.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// The geometry of a model file or a scene, without its textures. Throws SceneError, also where it has
/// fields.
SceneDescription load_geometry(const std::string& file, bool outside_files);

/// A corner of a triangle in the world, with the frame in which normal maps give normals.
struct LowCorner {
  dvec3 position{0}, normal{0}, tangent{1, 0, 0};
  glm::dvec2 uv{0};
};

struct LowTriangle {
  LowCorner corner[3];
  double sign = 1;  // of the bitangent
};

/// The triangle that a texel's middle lies in, and the weights of its second and third corner.
struct Texel {
  u32 triangle = nowhere;
  float b = 0, c = 0;
  static constexpr u32 nowhere = ~0u;
};

/// A point of the low model with its frame.
struct LowPoint {
  dvec3 position, normal, tangent, bitangent;
};

/// All triangles of a scene's meshes. Throws SceneError where a mesh has no texture coordinates.
std::vector<LowTriangle> low_triangles(const SceneDescription& scene);

/// How the texels of a map lie in the triangles.
struct Coverage {
  int size = 0;               // of an edge
  std::vector<Texel> texels;  // rows from the top
  std::size_t covered = 0;    // texels in a triangle
  std::size_t shared = 0;     // texels in several; the first counts
  std::size_t outside = 0;    // triangles that reach beyond the map and are taken modulo 1
};
Coverage cover(const std::vector<LowTriangle>& triangles, int size);

LowPoint point_of(const LowTriangle& triangle, const Texel& texel);

}  // namespace sundog
