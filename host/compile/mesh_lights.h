// Meshes that shine: each triangle of theirs becomes a light that surfaces choose.
#pragma once
#include "compile/compiled_scene.h"
#include "compile/mesh_bvh.h"
#include "scene/description.h"

namespace sundog {

/// Appends a light for each triangle of the meshes whose materials emit by a colour of their own. Their
/// instances, and those of lamps for path tracing, get the index of their light. To be called once the
/// instances are placed. What shines by a texture, and meshes of more
/// than `most_shining` triangles, are left to the rays that meet them.
void add_mesh_lights(const SceneDescription& scene, CompiledScene& out);

constexpr std::size_t most_shining = 200'000;

}  // namespace sundog
