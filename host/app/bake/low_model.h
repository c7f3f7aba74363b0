// The plain model that a map is baked for: finds the surface point that each texel of the map shows.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/description.h"

namespace sundog {

/// The geometry of a model file or scene, without materials and textures. Throws SceneError, also if it
/// contains distance fields.
SceneDescription load_geometry(const std::string& file, bool outside_files);

/// A triangle's corner in world space, with the tangent frame of normal maps.
struct LowCorner {
  dvec3 position{0}, normal{0}, tangent{1, 0, 0};
  glm::dvec2 uv{0};
};

struct LowTriangle {
  LowCorner corner[3];
  double sign = 1;  // the bitangent's sign
};

/// The triangle that contains a texel's centre, and the weights of its second and third corner.
struct Texel {
  u32 triangle = nowhere;
  float b = 0, c = 0;
  static constexpr u32 nowhere = ~0u;
};

/// A point on the plain model, with its tangent frame, in world space.
struct LowPoint {
  dvec3 position, normal, tangent, bitangent;
};

/// All triangles of a scene's meshes. Throws SceneError if a mesh has no texture coordinates.
std::vector<LowTriangle> low_triangles(const SceneDescription& scene);

/// Assigns the texels of a map to triangles.
struct Coverage {
  int size = 0;               // texels along each edge
  std::vector<Texel> texels;  // rows from the top
  std::size_t covered = 0;    // texels in a triangle
  std::size_t shared = 0;     // texels in several triangles; the first counts
  std::size_t outside = 0;    // triangles that extend beyond the map; their coordinates are taken modulo 1
};
Coverage cover(const std::vector<LowTriangle>& triangles, int size);

LowPoint point_of(const LowTriangle& triangle, const Texel& texel);

}  // namespace sundog
