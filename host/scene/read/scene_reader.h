// A whole scene from its JSON document.
#pragma once
#include <optional>

#include "scene/description.h"
#include "scene/json/value.h"
#include "scene/model.h"

namespace sundog {

/// Reads a scene document; meshes are looked for beside `root.context().file`. `known`, when set, is the
/// content of that file itself, which the document then places (a model as a scene by itself). `made` are
/// further meshes, beside the document's. Throws SceneError.
SceneDescription read_scene(const JsonValue& root, std::optional<Model> known = std::nullopt,
                            const NamedMeshes& made = {});

}  // namespace sundog
