// Small made-up meshes for tests, the same on every run.
#pragma once
#include <cstddef>

#include "scene/description.h"

namespace sundog {

/// Unconnected random triangles of about `size` in the cube [-1, 1]^3; no normals.
Mesh random_triangles(std::size_t count, float size, unsigned seed = 1);

/// A closed bumpy sphere of 2 * rings * (rings - 1) * 2 triangles, with normals: like a scanned model.
Mesh bumpy_sphere(int rings);

/// A scene that shows `mesh` with a camera on it.
SceneDescription scene_of(Mesh mesh);

}  // namespace sundog
