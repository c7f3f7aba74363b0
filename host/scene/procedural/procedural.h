// Generates meshes from a recipe in the scene file: "meshes": {"ice": {"generate": {...}}}.
#pragma once
#include "scene/description.h"
#include "scene/json/value.h"

namespace sundog {

/// Generates the mesh of a recipe: an object with "type" and that type's parameters. Equal recipes give equal
/// meshes, to the bit, on every machine. Read parameters through `recipe.object("generate_<type>", ...)`,
/// which throws SceneError with the pointer; scenes/scene.schema.json must list the same keys under
/// $defs/generate_<type>.
Mesh generate_mesh(const JsonValue& recipe);

/// Reads the parameters alone.
void check_recipe(const JsonValue& recipe);

}  // namespace sundog
