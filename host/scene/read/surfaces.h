// Reads media, the world's medium and fog, textures and materials of a scene file, in order of dependency.
#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "scene/read/parts.h"

namespace sundog {

/// The default world medium; every other medium displaces it.
inline MediumDescription outer_vacuum() { return {.name = "vacuum", .priority = world_priority}; }

struct SurfaceNames {
  NameTable media, materials;
};

/// Reads these sections, and the presets that the document `root` uses, into `scene`, whose only medium so
/// far is the world's. `textures` adds to the same scene. Throws SceneError.
SurfaceNames read_surfaces(const JsonValue& root, const FindSection& find, SceneDescription& scene,
                           TextureLibrary& textures);

/// The sections that read_surfaces() reads.
Names surface_sections();

/// Replaces the result of read_surfaces() for `before` by the result for `after`; keeps models' additions.
/// Reads no file. Returns false, with `scene` unchanged, if names or images differ or a texture displaces
/// meshes. Throws SceneError.
bool change_surfaces(SceneDescription& scene, const nlohmann::json& before, const nlohmann::json& after,
                     const JsonContext& context);

}  // namespace sundog
