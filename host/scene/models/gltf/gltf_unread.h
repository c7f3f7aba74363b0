// Features of a glTF file that change its picture and are not read.
#pragma once
#include <nlohmann/json.hpp>

#include "scene/model.h"
#include "scene/models/gltf/gltf_json.h"

namespace sundog::models {

/// Adds them to Model::unread. For a document that has been read: nothing else in it is checked.
void find_unread(const nlohmann::json& document, Model& model);

/// A required extension that is not read is an error, but for those that change colours alone. Throws
/// SceneError.
void check_extensions(const JsonAt& root);

/// Adds extensions that are used and not read to Model::unread.
void name_unread_extensions(const JsonAt& root, Model& model);

}  // namespace sundog::models
