// Reads the tree first, with solids as formulas, then the interval, thresholds and colours; finally judges
// the formulas.
#include "scene/read/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <string_view>

#include "formula/sdf.h"
#include "scene/json/members.h"
#include "scene/read/field_formulas.h"
#include "scene/read/field_judge.h"
#include "scene/read/parts.h"

namespace sundog {
namespace {

/// The scale factor of `matrix`; nothing if it mirrors or scales unevenly.
std::optional<double> scale_of(const glm::dmat3& matrix) {
  const double scale = glm::length(matrix[0]);
  const glm::dmat3 square = glm::transpose(matrix) * matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(square[i][j] - (i == j ? scale * scale : 0)) < 1e-9 * scale * scale))
        return std::nullopt;
  if (glm::determinant(matrix) < 0) return std::nullopt;
  return scale;
}

/// Reads a solid ("sphere", "box", ...) and its "transform", which may translate, rotate and scale uniformly.
/// Throws SceneError for other transforms, and for a solid without an inside.
SdfNode read_solid_field(JsonObject& object, std::string_view type) {
  if (const auto material = object.find("material"))
    material->fail("a material belongs to the whole field, not to a part of it");
  object.find("name");
  const PlacedShape solid = read_solid(object, type);
  const auto field = field_of_solid(solid.shape);
  if (!field)
    object.value().fail(
        type == "lathe"
            ? std::string("a lathe has no distance field, which an operation on fields needs")
            : fmt::format("a {} that is open has no inside, which an operation on fields needs", type));
  glm::dmat4 placed = solid.placed;
  if (const auto list = object.find("transform")) {
    placed = read_transform(*list) * placed;
    if (!scale_of(glm::dmat3(placed)))
      list->fail("a solid inside a field is moved, turned and scaled by one factor, found another transform");
  }
  SdfNode node, child;
  node.kind = SdfNode::Kind::transform;
  node.scale = scale_of(glm::dmat3(placed)).value_or(1);
  node.rotation = glm::dmat3(placed) / node.scale;
  node.offset = glm::dvec3(placed[3]);
  child.formula = *field;
  node.children.push_back(child);
  return node;
}

constexpr std::array<std::string_view, 11> types{"fractal",      "formula",    "hybrid", "union",
                                                 "intersection", "difference", "moved",  "repeat",
                                                 "thicken",      "shell",      "native"};
constexpr int deepest = SdfNode::max_depth;

SdfNode read_node(JsonObject& object, std::string_view type, std::array<double, 6>* bounds, int depth);

SdfNode read_child(const JsonValue& value, int depth, std::array<double, 6>* bounds = nullptr) {
  if (depth > deepest) value.fail(fmt::format("fields nested deeper than {} levels", deepest));
  const std::string type = value.type();
  const bool solid = std::find(types.begin(), types.end(), type) == types.end();
  return value.object("field", [&](JsonObject& object) {
    return solid ? read_solid_field(object, type) : read_node(object, type, bounds, depth);
  });
}

SdfNode read_joint(JsonObject& object, std::string_view type, int depth) {
  SdfNode node;
  node.kind = type == "union"          ? SdfNode::Kind::unite
              : type == "intersection" ? SdfNode::Kind::intersect
                                       : SdfNode::Kind::subtract;
  for (const JsonValue& item : object.at("fields").items("fields"))
    node.children.push_back(read_child(item, depth + 1));
  object.read("smooth", node.smooth);
  return node;
}

SdfNode read_moved(JsonObject& object) {
  SdfNode node;
  node.kind = SdfNode::Kind::transform;
  object.read("translate", node.offset, "scale", node.scale);
  if (const auto rotate = object.find("rotate"))
    rotate->object("rotate", [&](JsonObject& r) {
      const glm::dvec3 axis = r.at("axis").direction();
      node.rotation = glm::dmat3(glm::rotate(glm::dmat4(1), glm::radians(r.at("degrees").number()), axis));
    });
  return node;
}

SdfNode read_native(JsonObject& object) {
  if (!object.value().context().native_code)
    object.value().fail(
        "this field is OpenCL C, which the driver would run as it stands; if you trust the file, "
        "allow native code",
        Remedy::native_code);
  SdfNode node;
  node.kind = SdfNode::Kind::native;
  node.code = read_text(object, "code");
  if (node.code.empty()) object.at("code");
  return node;
}

SdfNode read_node(JsonObject& object, std::string_view type, std::array<double, 6>* bounds, int depth) {
  SdfNode node;
  if (type == "fractal" || type == "formula" || type == "hybrid") {
    const FormulaLeaf leaf = type == "hybrid" ? read_hybrid(object) : read_single(object, type);
    node.formula = leaf.field;
    if (bounds) *bounds = leaf.bounds;
    return node;
  }
  if (type == "union" || type == "intersection" || type == "difference")
    return read_joint(object, type, depth);
  if (type == "native") return read_native(object);
  if (type == "moved") {
    node = read_moved(object);
  } else if (type == "repeat") {
    node.kind = SdfNode::Kind::repeat;
    object.read("period", node.period, "count", node.count);
  } else {
    node.kind = type == "thicken" ? SdfNode::Kind::thicken : SdfNode::Kind::shell;
    object.read("amount", node.amount);
  }
  node.children.push_back(read_child(object.at("field"), depth + 1));
  return node;
}

SdfColoring read_coloring(const JsonValue& value) {
  return value.object("coloring", [](JsonObject& object) {
    SdfColoring coloring;
    read_members(object, coloring);
    for (const JsonValue& stop : object.at("palette").items("colours"))
      coloring.palette.push_back(stop.vec3());
    return coloring;
  });
}

void read_interval(JsonObject& object, SdfDescription& field, bool required) {
  const auto interval =
      required ? object.at("interval", "an object with \"min\" and \"max\": where the field is built")
               : object.find("interval");
  if (!interval) return;
  interval->object("interval", [&](JsonObject& o) { o.read("min", field.lower, "max", field.upper); });
  if (!glm::all(glm::lessThan(field.lower, field.upper)))
    interval->fail("wanted each of \"min\" below its part of \"max\"");
}

/// Reads the field's shading effects; `size` is half its interval's diagonal.
void read_effects(JsonObject& object, SdfDescription& field, double size) {
  field.occlusion = object.number("occlusion", 0, {.low = 0, .high = size});
  if (const auto glow = object.find("glow"))
    glow->object("glow", [&](JsonObject& o) {
      o.read("color", field.glow);
      field.glow_width = o.number("width", 0.05 * size, {.low = 0, .high = size, .low_open = true});
    });
}

double least_safety(const SdfNode& node) {
  double least = node.kind == SdfNode::Kind::formula ? node.formula.safety : 1;
  for (const SdfNode& child : node.children) least = std::min(least, least_safety(child));
  return least;
}

/// Reads the field's interval, precision and appearance. `root` is the JSON of its tree.
void read_whole(JsonObject& object, SdfDescription& field, const JsonValue& root,
                const std::array<double, 6>& bounds) {
  const bool is_leaf = field.root.kind == SdfNode::Kind::formula;
  field.lower = {bounds[0], bounds[1], bounds[2]};
  field.upper = {bounds[3], bounds[4], bounds[5]};
  read_interval(object, field, !is_leaf);
  if (const auto ball = object.find("ball"))
    field.sphere = ball->object("ball", [](JsonObject& o) {
      glm::dvec3 center(0);
      double radius = 0;
      o.read("center", center, "radius", radius);
      return glm::dvec4(center, radius);
    });
  const double size = glm::length(field.upper - field.lower) / 2;
  field.least = object.number("least_threshold", 3e-5 * size, {.low = 1e-7 * size, .high = size});
  field.greatest = object.number("greatest_threshold", std::max(0.03 * size, field.least),
                                 {.low = field.least, .high = size});
  const bool has_limit = object.has("step_limit");
  read_members(object, field, {"name", "occlusion", "glow"});
  if (const auto coloring = object.find("coloring")) field.coloring = read_coloring(*coloring);
  read_effects(object, field, size);
  try {
    if (root.context().measures) {
      judge_field(field.root, root, field.lower, field.upper);
      if (is_leaf && !object.has("interval")) judge_cut(field.root.formula, root, field.lower, field.upper);
    }
  } catch (const FormulaError& error) {
    fail_formula(root, error);
  }
  if (!has_limit)  // shorter steps are more steps
    field.step_limit = static_cast<int>(std::clamp(128 / least_safety(field.root), 512.0, 8192.0));
}

}  // namespace

Names field_types() { return types; }

SdfDescription read_field(JsonObject& object, std::string_view type) {
  SdfDescription field;
  field.name = type;
  std::array<double, 6> bounds{};
  field.root = read_node(object, type, &bounds, 1);
  read_whole(object, field, object.value(), bounds);
  return field;
}

SdfDescription read_named_field(const JsonValue& value, std::string name) {
  SdfDescription field;
  field.name = std::move(name);
  value.object("field_entry", [&](JsonObject& object) {
    std::array<double, 6> bounds{};
    const JsonValue root = object.at("field");
    field.root = read_child(root, 1, &bounds);
    read_whole(object, field, root, bounds);
  });
  return field;
}

}  // namespace sundog
