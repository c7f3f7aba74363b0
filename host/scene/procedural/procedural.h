// Meshes that sundog makes itself from a recipe in the scene file: "meshes": {"ice": {"generate": {...}}}.
#pragma once
#include "scene/description.h"
#include "scene/json/value.h"

namespace sundog {

/// The mesh of a recipe: an object with a "type" and that type's parameters. The same recipe gives the same
/// mesh, to the bit, on every machine. Read the parameters through `recipe.object("generate_<type>", ...)`:
/// bad ones then throw SceneError with the pointer, and scenes/scene.schema.json must hold the same keys
/// under $defs/generate_<type>.
Mesh generate_mesh(const JsonValue& recipe);

/// Reads the parameters alone.
void check_recipe(const JsonValue& recipe);

}  // namespace sundog
