// Compiles emissive meshes to one light per triangle.
#pragma once
#include "compile/compiled_scene.h"
#include "compile/mesh_bvh.h"
#include "scene/description.h"

namespace sundog {

/// Appends a light for each triangle of meshes whose materials have a uniform emission. Stores the light's
/// index in their instances, and in those of visible lights for path tracing. Call after placing instances.
/// Meshes with textured emission or more than `most_shining` triangles are left to rays that hit them.
void add_mesh_lights(const SceneDescription& scene, CompiledScene& out);

constexpr std::size_t most_shining = 200'000;

}  // namespace sundog
