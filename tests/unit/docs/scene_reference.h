// docs/reference/scene-reference.md, from the schema.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

/// The page. `schema`: scenes/scene.schema.json with its order of keys. Throws std::runtime_error where the
/// schema has a kind of object that no section of the page holds, and for a rule that the page cannot put
/// into words.
std::string scene_reference(const nlohmann::ordered_json& schema);
