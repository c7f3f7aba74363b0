// Small generated meshes for tests, equal on every run.
#pragma once
#include <cstddef>

#include "scene/description.h"

namespace sundog {

/// Unconnected random triangles of about `size` in the cube [-1, 1]^3; no normals.
Mesh random_triangles(std::size_t count, float size, unsigned seed = 1);

/// A closed bumpy sphere of 2 * rings * (rings - 1) * 2 triangles with a sphere's normals, like a scanned
/// model; with `bumps` 0, a ball of radius 1.
Mesh bumpy_sphere(int rings, double bumps = 1);

/// A scene of one object, `mesh`, with a default material and camera.
SceneDescription scene_of(Mesh mesh);

}  // namespace sundog
