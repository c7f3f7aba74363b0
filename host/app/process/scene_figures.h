// Counts and sizes of a scene's contents, for `sundog info` and the statistics of a render.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "compile/compiled_scene.h"

namespace sundog {

/// Number of triangles (unique, and as placed by objects), objects by shape, lights by type, materials and
/// media; the BVH's statistics; bytes by kind of table; the bounds of all bounded objects (null: none).
nlohmann::json scene_figures(const SceneDescription& scene, const CompiledScene& flat);

}  // namespace sundog
