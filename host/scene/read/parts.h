// The parts of a scene file, each read from its JSON value. All throw SceneError with file and pointer.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/json/value.h"

namespace sundog {

/// Indices by name, as the scene's tables hold them.
using NameTable = std::map<std::string, int, std::less<>>;

class TextureLibrary;

/// The index of a name that must be in `table`; `what` says what it names ("material").
int find_name(const JsonValue& name, const NameTable& table, std::string_view what);

/// `position` and `target` are both given or both missing; `placed` says which.
Camera read_camera(const JsonValue& value, bool& placed);
ImageSettings read_image(const JsonValue& value);
RenderSettings read_render(const JsonValue& value);
LightDescription read_light(const JsonValue& value);
/// `read_picture` reads the image file that a value names.
EnvironmentDescription read_environment(const JsonValue& value,
                                        const std::function<Image(const JsonValue&)>& read_picture);
/// Of scattered light's turns; at 1 it would not be scattered.
inline constexpr Range mean_cosines{.low = -0.99, .high = 0.99};
FogDescription read_fog(const JsonValue& value);

MediumDescription read_medium(const JsonValue& value, std::string name);
/// Adds an anonymous medium to `media` when the material gives an "ior" of its own, and to the scene of
/// `textures` those that it uses.
MaterialDescription read_material(const JsonValue& value, std::string name, const NameTable& medium_names,
                                  std::vector<MediumDescription>& media, TextureLibrary& textures);

/// An exact solid in its own units, and where the file's shorthands (center, from, normal, ...) put it.
struct PlacedShape {
  Shape shape;
  dmat4 placed{1};
};

/// The names of the exact solids, as an object's "type".
Names solid_types();
/// Reads the keys of a solid of the given type.
PlacedShape read_solid(JsonObject& object, std::string_view type);
/// The solid's distance field; nothing for what has no inside.
std::optional<FormulaField> field_of_solid(const Shape& shape);

/// The product of a "transform" list: its first entry is applied to the object first.
dmat4 read_transform(const JsonValue& list);
/// Throws SceneError at `place` if `matrix` is not finite, is singular, or is beyond what floats can invert.
void check_transform(const dmat4& matrix, const JsonValue& place);
/// The rotation that takes +y to `axis` (unit length) along the shortest way.
dmat4 rotation_from_y(const dvec3& axis);

}  // namespace sundog
