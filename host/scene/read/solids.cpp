// Reads the exact solids: each about the origin with axis y, the transform given by its shorthands, and its
// distance field for field operations.

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "formula/list.h"
#include "formula/lower.h"
#include "scene/json/members.h"
#include "scene/procedural/procedural.h"
#include "scene/read/parts.h"

namespace sundog {

namespace {

dmat4 read_point(JsonObject& object, std::string_view key) {
  dvec3 point(0);
  object.read(key, point);
  return glm::translate(dmat4(1), point);
}

/// The rotation from +y to the direction under `key`.
dmat4 read_axis(JsonObject& object, std::string_view key) {
  const auto axis = object.find(key);
  return axis ? rotation_from_y(axis->direction()) : dmat4(1);
}

PlacedShape read_shape(SphereShape sphere, JsonObject& object) {
  read_members(object, sphere);
  return {sphere, read_point(object, "center")};
}

PlacedShape read_shape(PlaneShape plane, JsonObject& object) {
  return {plane, read_point(object, "point") * read_axis(object, "normal")};
}

/// Reads a box's half sizes from "half" (and "center") or from the corners "min" and "max"; `placed` moves
/// the box into place.
dvec3 read_extent(JsonObject& object, dmat4& placed) {
  if (!object.has("min") && !object.has("max")) {
    placed = read_point(object, "center");
    const auto half = object.find("half");
    return half ? half->vec3() : dvec3(1);
  }
  const dvec3 low = object.at("min").vec3();
  const dvec3 high = object.at("max").vec3();
  if (!glm::all(glm::lessThan(low, high)))
    object.value().fail("wanted each of \"min\" below its part of \"max\"");
  placed = glm::translate(dmat4(1), (low + high) * 0.5);
  return (high - low) * 0.5;
}

PlacedShape read_shape(BoxShape box, JsonObject& object) {
  PlacedShape result;
  box.half = read_extent(object, result.placed);
  result.shape = box;
  return result;
}

PlacedShape read_shape(RoundBoxShape box, JsonObject& object) {
  PlacedShape result;
  box.half = read_extent(object, result.placed);
  const double smallest = std::min({box.half.x, box.half.y, box.half.z});
  const Range range{.low = 0, .high = smallest, .low_open = true};
  box.radius = object.number("radius", std::min(box.radius, smallest), range);
  result.shape = box;
  return result;
}

/// Reads half the height of a cylinder or cone along y, from "from" and "to" or from "height" (and "center").
double read_span(JsonObject& object, dmat4& placed) {
  if (!object.has("from") && !object.has("to")) {
    placed = read_point(object, "center");
    double height = 0;
    object.read("height", height);
    return height / 2;
  }
  const dvec3 from = object.at("from").vec3();
  const JsonValue end = object.at("to");
  const dvec3 axis = end.vec3() - from;
  if (!(glm::length(axis) > 1e-12)) end.fail("wanted a point away from \"from\", found the same one");
  placed = glm::translate(dmat4(1), from + axis * 0.5) * rotation_from_y(glm::normalize(axis));
  return glm::length(axis) / 2;
}

PlacedShape read_shape(CylinderShape cylinder, JsonObject& object) {
  PlacedShape result;
  read_members(object, cylinder);
  cylinder.half_height = read_span(object, result.placed);
  result.shape = cylinder;
  return result;
}

PlacedShape read_shape(ConeShape cone, JsonObject& object) {
  PlacedShape result;
  read_members(object, cone);
  if (cone.bottom_radius == 0 && cone.top_radius == 0)
    object.value().fail("wanted a \"bottom_radius\" or a \"top_radius\" above 0, found both 0");
  cone.half_height = read_span(object, result.placed);
  result.shape = cone;
  return result;
}

PlacedShape read_shape(DiskShape disk, JsonObject& object) {
  object.read("radius", disk.radius);
  disk.inner_radius = object.number("inner_radius", 0, {.low = 0, .high = disk.radius, .high_open = true});
  return {disk, read_point(object, "center") * read_axis(object, "normal")};
}

PlacedShape read_shape(RectangleShape rectangle, JsonObject& object) {
  dvec2 size(0);
  object.read("size", size);
  rectangle.half = size / 2.0;
  return {rectangle, read_point(object, "center") * read_axis(object, "normal")};
}

PlacedShape read_shape(TorusShape torus, JsonObject& object) {
  object.read("major_radius", torus.major_radius);
  const Range range{.low = 0, .high = torus.major_radius, .low_open = true, .high_open = true};
  torus.minor_radius = object.number("minor_radius", torus.major_radius / 4, range);
  return {torus, read_point(object, "center") * read_axis(object, "axis")};
}

PlacedShape read_shape(const LatheShape&, JsonObject& object, const JsonValue* meshes) {
  const ExactLathe lathe = read_exact_lathe(object, meshes);
  return {lathe.shape, glm::translate(dmat4(1), dvec3(0, lathe.middle, 0))};
}

/// Most solids cannot name a mesh.
template <class S>
PlacedShape read_shape(S solid, JsonObject& object, const JsonValue*) {
  return read_shape(std::move(solid), object);
}

// Distance fields of the solids that have an inside.
FormulaField make_field(const FormulaDefinition& definition, std::vector<double> values) {
  FormulaField field;
  field.steps.push_back({definition, std::move(values), 1});
  field.iterations = 1;
  field.bailout = definition.bailout;
  field.safety = definition.safety;
  return field;
}

FormulaField listed(const char* name, std::vector<double> values) {
  return make_field(*find_formula(name), std::move(values));
}

FormulaField closed_form(const char* name, const char* distance, std::vector<FormulaParameter> parameters) {
  FormulaDefinition d;
  d.name = name;
  d.kind = FormulaKind::direct;
  d.distance = distance;
  d.parameters = std::move(parameters);
  d.smooth = true;
  return make_field(d, default_values(d));
}

FormulaField field_of(const SphereShape& s) { return listed("sphere", {s.radius}); }
FormulaField field_of(const PlaneShape&) { return closed_form("plane", "p.y", {}); }
FormulaField field_of(const BoxShape& s) { return listed("box", {s.half.x, s.half.y, s.half.z}); }
FormulaField field_of(const CylinderShape& s) { return listed("cylinder", {s.radius, s.half_height}); }
std::optional<FormulaField> field_of(const DiskShape&) { return std::nullopt; }  // no inside
std::optional<FormulaField> field_of(const RectangleShape&) { return std::nullopt; }
std::optional<FormulaField> field_of(const LatheShape&) { return std::nullopt; }  // no formula
FormulaField field_of(const TorusShape& s) { return listed("torus", {s.major_radius, s.minor_radius}); }
FormulaField field_of(const RoundBoxShape& s) {
  return listed("rounded_box", {s.half.x, s.half.y, s.half.z, s.radius});
}

/// A capped cone about y (I. Quilez, Distance functions).
FormulaField field_of(const ConeShape& cone) {
  return closed_form(
      "cone",
      "r = length(p.x, p.z)\n"
      "ax = r - min(r, p.y < 0 ? bottom : top); ay = abs(p.y) - half\n"
      "kx = top - bottom; ky = 2 * half\n"
      "s = clamp(((top - r) * kx + (half - p.y) * ky) / (kx * kx + ky * ky), 0, 1)\n"
      "bx = r - top + kx * s; by = p.y - half + ky * s\n"
      "d = min(sqrt(ax * ax + ay * ay), sqrt(bx * bx + by * by))\n"
      "bx < 0 && ay < 0 ? -d : d",
      {{"bottom", {cone.bottom_radius}}, {"top", {cone.top_radius}}, {"half", {cone.half_height}}});
}

struct Solid {
  std::string_view type;
  PlacedShape (*read)(JsonObject&, const JsonValue* meshes);
};

constexpr std::array solids{
#define SUNDOG_SOLID(constant, type, name, effect)               \
  Solid{#name, [](JsonObject& object, const JsonValue* meshes) { \
          return read_shape(type##Shape{}, object, meshes);      \
        }},
    SOLIDS(SUNDOG_SOLID)
#undef SUNDOG_SOLID
};

}  // namespace

Names solid_types() {
  static const auto names = [] {
    std::array<std::string_view, solids.size()> result;
    std::transform(solids.begin(), solids.end(), result.begin(),
                   [](const Solid& solid) { return solid.type; });
    return result;
  }();
  return names;
}

PlacedShape read_solid(JsonObject& object, std::string_view type, const JsonValue* meshes) {
  const auto solid =
      std::find_if(solids.begin(), solids.end(), [&](const Solid& s) { return s.type == type; });
  return solid->read(object, meshes);
}

std::optional<FormulaField> field_of_solid(const Shape& shape) {
  const auto make = []<class S>(const S& solid) -> std::optional<FormulaField> {
    if constexpr (!std::is_same_v<S, MeshShape> && !std::is_same_v<S, FieldShape>)
      if (!solid.open()) return field_of(solid);
    return std::nullopt;
  };
  return std::visit(make, shape);
}

}  // namespace sundog
