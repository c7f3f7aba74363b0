// Finds unsupported features that affect a glTF file's picture.
#pragma once
#include <nlohmann/json.hpp>

#include "models/gltf/gltf_json.h"
#include "models/model.h"

namespace sundog::models {

/// Adds these features to Model::unread, for a document that has been read; validates nothing else.
void find_unread(const nlohmann::json& document, Model& model);

/// Throws SceneError for an unsupported required extension, unless it only affects colours.
void check_extensions(const JsonAt& root);

/// Adds unsupported used extensions to Model::unread.
void name_unread_extensions(const JsonAt& root, Model& model);

}  // namespace sundog::models
