// The exact solids: each in its own units about the origin, y its axis, and the shorthands that place it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/read/parts.h"

namespace sundog {

namespace {

dmat4 read_center(JsonObject& object) { return glm::translate(dmat4(1), object.vec3("center", dvec3(0))); }

/// The rotation that takes +y to the direction under `key`.
dmat4 read_axis(JsonObject& object, std::string_view key) {
  const auto axis = object.find(key);
  return axis ? rotation_from_y(axis->direction()) : dmat4(1);
}

PlacedShape read_sphere(JsonObject& object) {
  return {SphereShape{object.number("radius", 1, above_0)}, read_center(object)};
}

PlacedShape read_plane(JsonObject& object) {
  const dmat4 moved = glm::translate(dmat4(1), object.vec3("point", dvec3(0)));
  return {PlaneShape{}, moved * read_axis(object, "normal")};
}

dvec3 read_half(const JsonValue& value) {
  if (value.json().is_number()) return dvec3(value.number(above_0));
  if (!value.json().is_array()) value.wanted("a half size or an array of 3 half sizes");
  return value.vec3(above_0);
}

/// A box's half sizes, from "half" (and "center") or from the corners "min" and "max"; moves it to where it
/// is.
dvec3 read_extent(JsonObject& object, dmat4& placed) {
  object.not_both("half", "min");
  object.not_both("half", "max");
  if (!object.has("min") && !object.has("max")) {
    placed = read_center(object);
    const auto half = object.find("half");
    return half ? read_half(*half) : dvec3(1);
  }
  object.not_both("center", "min");
  const dvec3 low = object.at("min", "the corner beside \"max\"").vec3();
  const dvec3 high = object.at("max", "the corner beside \"min\"").vec3();
  if (!glm::all(glm::lessThan(low, high)))
    object.value().fail("wanted each of \"min\" below its part of \"max\"");
  placed = glm::translate(dmat4(1), (low + high) * 0.5);
  return (high - low) * 0.5;
}

PlacedShape read_box(JsonObject& object) {
  PlacedShape result;
  result.shape = BoxShape{read_extent(object, result.placed)};
  return result;
}

PlacedShape read_round_box(JsonObject& object) {
  PlacedShape result;
  const dvec3 half = read_extent(object, result.placed);
  const double smallest = std::min({half.x, half.y, half.z});
  const Range range{.low = 0, .high = smallest, .low_open = true};
  result.shape = RoundBoxShape{half, object.number("radius", std::min(0.1, smallest), range)};
  return result;
}

/// Half the height of a cylinder or cone along y, from "from" and "to" or from "height" (and "center").
double read_span(JsonObject& object, dmat4& placed) {
  object.not_both("height", "from");
  object.not_both("height", "to");
  if (!object.has("from") && !object.has("to")) {
    placed = read_center(object);
    return object.number("height", 2, above_0) / 2;
  }
  object.not_both("center", "from");
  const dvec3 from = object.at("from", "the end beside \"to\"").vec3();
  const JsonValue end = object.at("to", "the end beside \"from\"");
  const dvec3 axis = end.vec3() - from;
  if (!(glm::length(axis) > 1e-12)) end.fail("wanted a point away from \"from\", found the same one");
  placed = glm::translate(dmat4(1), from + axis * 0.5) * rotation_from_y(glm::normalize(axis));
  return glm::length(axis) / 2;
}

PlacedShape read_cylinder(JsonObject& object) {
  PlacedShape result;
  CylinderShape cylinder;
  cylinder.radius = object.number("radius", cylinder.radius, above_0);
  cylinder.half_height = read_span(object, result.placed);
  cylinder.capped = object.boolean("capped", cylinder.capped);
  result.shape = cylinder;
  return result;
}

PlacedShape read_cone(JsonObject& object) {
  PlacedShape result;
  ConeShape cone;
  cone.bottom_radius = object.number("bottom_radius", cone.bottom_radius, at_least_0);
  cone.top_radius = object.number("top_radius", cone.top_radius, at_least_0);
  if (cone.bottom_radius == 0 && cone.top_radius == 0)
    object.value().fail("wanted a \"bottom_radius\" or a \"top_radius\" above 0, found both 0");
  cone.half_height = read_span(object, result.placed);
  cone.capped = object.boolean("capped", cone.capped);
  result.shape = cone;
  return result;
}

PlacedShape read_disk(JsonObject& object) {
  DiskShape disk;
  disk.radius = object.number("radius", disk.radius, above_0);
  disk.inner_radius = object.number("inner_radius", 0, {.low = 0, .high = disk.radius, .high_open = true});
  return {disk, read_center(object) * read_axis(object, "normal")};
}

PlacedShape read_torus(JsonObject& object) {
  TorusShape torus;
  torus.major_radius = object.number("major_radius", torus.major_radius, above_0);
  const Range range{.low = 0, .high = torus.major_radius, .low_open = true, .high_open = true};
  torus.minor_radius = object.number("minor_radius", torus.major_radius / 4, range);
  return {torus, read_center(object) * read_axis(object, "axis")};
}

struct Solid {
  std::string_view type;
  PlacedShape (*read)(JsonObject&);
};

constexpr std::array solids{Solid{"sphere", read_sphere}, Solid{"plane", read_plane},
                            Solid{"box", read_box},       Solid{"cylinder", read_cylinder},
                            Solid{"cone", read_cone},     Solid{"disk", read_disk},
                            Solid{"torus", read_torus},   Solid{"round_box", read_round_box}};

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

PlacedShape read_solid(JsonObject& object, std::string_view type) {
  const auto solid =
      std::find_if(solids.begin(), solids.end(), [&](const Solid& s) { return s.type == type; });
  return solid->read(object);
}

}  // namespace sundog
