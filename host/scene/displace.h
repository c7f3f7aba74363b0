// Displacement: meshes whose materials have heights become meshes of small triangles that are moved by them,
// so that silhouettes, shadows and refraction are those of the relief.
#pragma once
#include "scene/description.h"

namespace sundog {

/// Triangles that a displaced mesh has when no edge is given, at most about as many.
inline constexpr std::size_t usual_displaced_triangles = 1'000'000;
inline constexpr std::size_t most_displaced_triangles = 16'000'000;

/// Replaces the meshes of objects with such materials. After decode_images(). Points at one place move
/// together, so that no cracks open. Throws SceneError where an object is no mesh, a mesh has no texture
/// coordinates, heights come from no image, or there would be too many triangles.
void displace_meshes(SceneDescription& scene);

/// Cuts edges longer than `edge` in halves until none is left; each edge by its own length, so that triangles
/// on both sides agree. Stops above `most` triangles.
Mesh refine(Mesh mesh, double edge, std::size_t most);

}  // namespace sundog
