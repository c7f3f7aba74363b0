// Compiles materials, media and lights.
#pragma once
#include <string>
#include <vector>

#include "compile/compiled_scene.h"

namespace sundog {

/// Fills `out.media` (equal media are merged, except the world's at 0) and `out.materials`. If some object or
/// mesh lacks a material, appends a default one. Returns its index, or NO_MATERIAL.
u32 add_materials(const SceneDescription& scene, CompiledScene& out);

/// Whether some object or mesh lacks a material.
bool lacks_materials(const SceneDescription& scene);

/// Fills `out.lights`, with positions relative to `out.origin`, and `out.info.ambient`. Throws SceneError for
/// a zero direction.
void add_lights(const SceneDescription& scene, CompiledScene& out);

/// Adds a non-ambient light; `place` is its place in the scene file.
void add_light(const SceneDescription& scene, const LightDescription& light, const std::string& place,
               CompiledScene& out);

/// Whether the world's fog is a scattering medium instead of emitting light itself.
bool fog_scatters(const SceneDescription& scene);

/// Writes the world's fog to `out.info`, unless it scatters.
void add_fog(const SceneDescription& scene, CompiledScene& out);

}  // namespace sundog
