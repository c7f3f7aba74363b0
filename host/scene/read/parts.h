// Readers for the parts of a scene file. All throw SceneError with file and pointer.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/json/value.h"

namespace sundog {

/// Indices into the scene's tables by name.
using NameTable = std::map<std::string, int, std::less<>>;

class TextureLibrary;

/// The index of a name that must be in `table`; `what` is its kind ("material").
int find_name(const JsonValue& name, const NameTable& table, std::string_view what);

/// The file that the scene names, relative to the scene's folder. Throws SceneError if it cannot be read, or
/// if it lies outside the folder and that is not allowed.
std::filesystem::path find_file(const JsonValue& value);

/// Returns a section of the document, if present.
using FindSection = std::function<std::optional<JsonValue>(std::string_view key)>;

/// Reads image, render, camera and lights, for the scene's unit. Returns whether the camera has a place.
bool read_view_sections(const FindSection& find, SceneDescription& scene);

ToneMap read_tone_map(const JsonValue& value);
/// `unit`: metres per scene unit, for the power of lamps.
LightDescription read_light(const JsonValue& value, double unit);
/// Refuses more groups of lights than a film has sums for.
void check_light_groups(const SceneDescription& scene, const JsonValue& root);

/// `read_picture` reads an image file.
EnvironmentDescription read_environment(const JsonValue& value,
                                        const std::function<Image(const JsonValue&)>& read_picture);
FogDescription read_fog(const JsonValue& value);

MediumDescription read_medium(const JsonValue& value, std::string name);
/// Reads a material. Adds an anonymous medium to `media` if the material has its own "ior", and adds the
/// textures that it uses to their scene.
MaterialDescription read_material(const JsonValue& value, std::string name, const NameTable& medium_names,
                                  std::vector<MediumDescription>& media, TextureLibrary& textures);

/// An exact solid in its own units, and the transform given by its shorthands (center, from, normal, ...).
struct PlacedShape {
  Shape shape;
  dmat4 placed{1};
};

/// The object types that are exact solids.
Names solid_types();
/// Reads the keys of a solid of this type. `meshes`: the scene's table, if the solid may name a mesh.
PlacedShape read_solid(JsonObject& object, std::string_view type, const JsonValue* meshes = nullptr);
/// The solid's distance field; nothing for a solid without an inside or without a formula.
std::optional<FormulaField> field_of_solid(const Shape& shape);

/// The product of a "transform" list; the first entry applies first.
dmat4 read_transform(const JsonValue& list);
/// Throws SceneError at `place` if `matrix` is not finite, singular, or not invertible as floats.
void check_transform(const dmat4& matrix, const JsonValue& place);
/// The shortest rotation from +y to `axis` (unit length).
dmat4 rotation_from_y(const dvec3& axis);

}  // namespace sundog
