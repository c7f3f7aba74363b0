// Reads a whole scene from its JSON document.
#pragma once
#include <optional>

#include "models/model.h"
#include "scene/description.h"
#include "scene/json/value.h"

namespace sundog {

/// Reads a scene document; mesh files are relative to `root.context().file`. `known`, if set, is the content
/// of that file, which the document places (a model as a scene). `made` are additional meshes. Throws
/// SceneError.
SceneDescription read_scene(const JsonValue& root, std::optional<Model> known = std::nullopt,
                            const NamedMeshes& made = {});

}  // namespace sundog
