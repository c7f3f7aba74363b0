// As much of JSON Schema (draft 2020-12) as scenes/scene.schema.json uses.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// "pointer: reason" for each rule that `value` breaks. Throws std::runtime_error for a keyword that it does
/// not know.
std::vector<std::string> schema_errors(const nlohmann::json& schema, const nlohmann::json& value);

/// Writes into `value` each default of the schema that may stand beside what is there.
void fill_defaults(const nlohmann::json& schema, nlohmann::json& value);

/// The schema that ships with the scenes.
const nlohmann::json& scene_schema();
