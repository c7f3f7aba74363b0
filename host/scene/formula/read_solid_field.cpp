#include "scene/formula/read_solid_field.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "scene/formula/list.h"
#include "scene/formula/lower.h"
#include "scene/read/parts.h"

namespace sundog {
namespace {

FormulaField field_of(const FormulaDefinition& definition, std::vector<double> values) {
  FormulaField field;
  field.steps.push_back({definition, std::move(values), 1});
  field.iterations = 1;
  field.bailout = definition.bailout;
  field.safety = definition.safety;
  return field;
}

FormulaField listed(const char* name, std::vector<double> values) {
  return field_of(*find_formula(name), std::move(values));
}

FormulaField closed_form(const char* name, const char* distance, std::vector<FormulaParameter> parameters) {
  FormulaDefinition d;
  d.name = name;
  d.kind = FormulaKind::direct;
  d.distance = distance;
  d.parameters = std::move(parameters);
  d.smooth = true;
  return field_of(d, default_values(d));
}

/// I. Quilez, Distance functions: a capped cone about y.
FormulaField cone_field(const ConeShape& cone) {
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

/// Nothing for what has no inside.
std::optional<FormulaField> field_of(const Shape& shape) {
  if (const auto* s = std::get_if<SphereShape>(&shape)) return listed("sphere", {s->radius});
  if (const auto* s = std::get_if<BoxShape>(&shape)) return listed("box", {s->half.x, s->half.y, s->half.z});
  if (const auto* s = std::get_if<RoundBoxShape>(&shape))
    return listed("rounded_box", {s->half.x, s->half.y, s->half.z, s->radius});
  if (const auto* s = std::get_if<TorusShape>(&shape))
    return listed("torus", {s->major_radius, s->minor_radius});
  if (const auto* s = std::get_if<CylinderShape>(&shape); s && s->capped)
    return listed("cylinder", {s->radius, s->half_height});
  if (const auto* s = std::get_if<ConeShape>(&shape); s && s->capped) return cone_field(*s);
  if (std::holds_alternative<PlaneShape>(shape)) return closed_form("plane", "p.y", {});
  return std::nullopt;
}

/// The even factor of `matrix`; nothing where it mirrors or scales unevenly.
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

}  // namespace

SdfNode read_solid_field(JsonObject& object, std::string_view type) {
  if (const auto material = object.find("material"))
    material->fail("a material belongs to the whole field, not to a part of it");
  object.find("name");
  const PlacedShape solid = read_solid(object, type);
  const auto field = field_of(solid.shape);
  if (!field)
    object.value().fail(
        fmt::format("a {} that is open has no inside, which an operation on fields needs", type));
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

}  // namespace sundog
