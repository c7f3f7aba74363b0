// Generates meshes from a recipe in the scene file: "meshes": {"ice": {"generate": {...}}}.
#pragma once
#include <functional>

#include "scene/description.h"
#include "scene/json/value.h"
#include "scene/procedural/lathe.h"

namespace sundog {

/// Reads the picture that a value names.
using ReadPicture = std::function<Image(const JsonValue&)>;

/// Generates the mesh of a recipe: an object with "type" and that type's parameters; `meshes` is the scene's
/// table, in which a fill finds its vessel; terrains may have pictures of their heights. Equal recipes give
/// equal meshes, to the bit, on every machine. Throws SceneError with the pointer. The keys of a type are
/// those of $defs/generate_TYPE in scenes/scene.schema.json.
Mesh generate_mesh(const JsonValue& recipe, const JsonValue& meshes, const ReadPicture& read_picture);

/// The exact solid of an object of the type "lathe", and the height of its middle: by its own profile, or
/// that of the "mesh" it names, a lathe or the fill of one. `meshes`: the scene's table, if there is one.
/// Throws SceneError.
ExactLathe read_exact_lathe(JsonObject& object, const JsonValue* meshes);

/// Reads the parameters alone.
void check_recipe(const JsonValue& recipe, const JsonValue& meshes);

/// All that decides the mesh.
std::string recipe_key(const JsonValue& recipe, const JsonValue& meshes);

}  // namespace sundog
