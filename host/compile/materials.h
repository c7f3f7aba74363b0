// Materials, media and lights as the kernels read them.
#pragma once
#include <string>
#include <vector>

#include "compile/compiled_scene.h"

namespace sundog {

/// Fills `out.media` (the same medium under several names becomes one; the world's stays alone at 0) and
/// `out.materials`. When some object or mesh is without a material, a default one is appended. Returns its
/// index, or NO_MATERIAL.
u32 add_materials(const SceneDescription& scene, CompiledScene& out);

/// Whether some object or mesh is without a material.
bool lacks_materials(const SceneDescription& scene);

/// Fills `out.lights`, whose positions count from `out.origin`, and `out.info.ambient`. Throws SceneError for
/// a direction of length zero.
void add_lights(const SceneDescription& scene, CompiledScene& out);

/// One light that is not ambient; `place` is its own in the scene file.
void add_light(const SceneDescription& scene, const LightDescription& light, const std::string& place,
               CompiledScene& out);

/// Whether the world's fog is a medium that scatters, and no fog with a light of its own.
bool fog_scatters(const SceneDescription& scene);

/// The world's fog, into `out.info`, unless it scatters.
void add_fog(const SceneDescription& scene, CompiledScene& out);

}  // namespace sundog
