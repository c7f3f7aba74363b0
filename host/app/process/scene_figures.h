// Counts and sizes of a scene's contents, for `sundog info` and the statistics of a render.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "compile/compiled_scene.h"

namespace sundog {

/// Counts of triangles (unique, and as placed by the objects), objects by shape, lights by type, materials,
/// media; the BVH's figures; bytes of each table; the bounds of everything bounded (null when there is
/// nothing).
nlohmann::json scene_figures(const SceneDescription& scene, const CompiledScene& flat);

}  // namespace sundog
