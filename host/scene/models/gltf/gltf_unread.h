// Features of a glTF file that change its picture and are not read.
#pragma once
#include <nlohmann/json.hpp>

#include "scene/model.h"

namespace sundog::models {

/// Adds them to Model::unread. For a document that has been read: nothing else in it is checked.
void find_unread(const nlohmann::json& document, Model& model);

}  // namespace sundog::models
