// Generates meshes from a recipe in the scene file: "meshes": {"ice": {"generate": {...}}}.
#pragma once
#include <functional>

#include "scene/description.h"
#include "scene/json/value.h"

namespace sundog {

/// Reads the picture that a value names.
using ReadPicture = std::function<Image(const JsonValue&)>;

/// Generates the mesh of a recipe: an object with "type" and that type's parameters; `meshes` is the scene's
/// table, in which a fill finds its vessel; terrains may have pictures of their heights. Equal recipes give
/// equal meshes, to the bit, on every machine. Throws SceneError with the pointer. The keys of a type are
/// those of $defs/generate_TYPE in scenes/scene.schema.json.
Mesh generate_mesh(const JsonValue& recipe, const JsonValue& meshes, const ReadPicture& read_picture);

/// Reads the parameters alone.
void check_recipe(const JsonValue& recipe, const JsonValue& meshes);

/// All that decides the mesh.
std::string recipe_key(const JsonValue& recipe, const JsonValue& meshes);

}  // namespace sundog
