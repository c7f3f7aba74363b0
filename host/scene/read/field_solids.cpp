#include "scene/read/field_solids.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "scene/read/parts.h"

namespace sundog {
namespace {

/// The uniform scale of `matrix`; nothing if it mirrors or scales unevenly.
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

}  // namespace sundog
