// What surfaces are made of: the media, the world's medium and fog, the textures and materials of a scene
// file, in the order in which they refer to each other.
#pragma once
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "scene/read/parts.h"

namespace sundog {

/// What fills a world that says nothing of it: it gives way to all other media.
inline MediumDescription outer_vacuum() { return {.name = "vacuum", .priority = world_priority}; }

struct SurfaceNames {
  NameTable media, materials;
};

/// A section of the document, where it is there.
using FindSection = std::function<std::optional<JsonValue>(std::string_view key)>;

/// Reads them, and the presets that the document `root` uses, into `scene`, whose only medium so far is the
/// world's. `textures` adds to the same scene. Throws SceneError.
SurfaceNames read_surfaces(const JsonValue& root, const FindSection& find, SceneDescription& scene,
                           TextureLibrary& textures);

/// The sections that read_surfaces() asks for.
Names surface_sections();

/// Puts what read_surfaces() makes of the document `after` in the place of what it made of `before`; what
/// models have brought stays. No file is read. False, and `scene` as it was, where that cannot be done: other
/// names, other images, or meshes that a texture has displaced. Throws SceneError.
bool change_surfaces(SceneDescription& scene, const nlohmann::json& before, const nlohmann::json& after,
                     const JsonContext& context);

}  // namespace sundog
