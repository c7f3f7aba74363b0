// Generates meshes from a recipe in the scene file: "meshes": {"ice": {"generate": {...}}}.
#pragma once
#include <functional>

#include "scene/description.h"
#include "scene/json/value.h"
#include "scene/procedural/lathe.h"

namespace sundog {

/// Reads the picture that a value names.
using ReadPicture = std::function<Image(const JsonValue&)>;

/// Generates the mesh of a recipe: an object with "type" and that type's parameters. `meshes` is the scene's
/// table, in which a fill finds its vessel; terrains may read pictures of their heights. Equal recipes give
/// equal meshes, bit for bit, on every machine. Throws SceneError with the pointer. The keys of a type are
/// those of $defs/generate_TYPE in scenes/scene.schema.json.
Mesh generate_mesh(const JsonValue& recipe, const JsonValue& meshes, const ReadPicture& read_picture);

/// The exact solid of an object of the type "lathe", and the height of its middle: from its own profile, or
/// from the "mesh" that it names, which is a lathe or a lathe's fill. `meshes`: the scene's table, if it has
/// one. Throws SceneError.
ExactLathe read_exact_lathe(JsonObject& object, const JsonValue* meshes);

/// Reads and checks the parameters without generating the mesh.
void check_recipe(const JsonValue& recipe, const JsonValue& meshes);

/// A string that contains everything on which the mesh depends, except the content of pictures.
std::string recipe_key(const JsonValue& recipe, const JsonValue& meshes);

}  // namespace sundog
