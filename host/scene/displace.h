// Displacement mapping: subdivides meshes whose materials have height maps and moves their vertices, so that
// silhouettes, shadows and refraction follow the relief.
#pragma once
#include "scene/description.h"

namespace sundog {

/// Approximate limit of a displaced mesh's triangles when no edge length is given.
inline constexpr std::size_t usual_displaced_triangles = 1'000'000;
inline constexpr std::size_t most_displaced_triangles = 16'000'000;

/// Replaces the meshes of objects with such materials. Call after decode_images(). Coincident points move
/// together, so no cracks open. Throws SceneError if the object is not a mesh, the mesh has no texture
/// coordinates, the heights do not come from an image, or there would be too many triangles.
void displace_meshes(SceneDescription& scene);

/// Bisects edges until none is longer than `edge`. Each edge is split by its own length, so that triangles on
/// both sides agree. Stops above `most` triangles.
Mesh refine(Mesh mesh, double edge, std::size_t most);

}  // namespace sundog
