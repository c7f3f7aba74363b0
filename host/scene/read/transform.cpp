// Reads lists of transforms and checks that they are invertible.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "scene/read/parts.h"

namespace sundog {

namespace {

dmat4 read_quaternion(const JsonValue& value) {
  const auto items = value.items("numbers x, y, z, w");
  const glm::dquat q(items[3].number(), items[0].number(), items[1].number(), items[2].number());
  if (!(glm::length(q) > 0)) value.wanted(quaternion_text);
  return glm::mat4_cast(glm::normalize(q));
}

dmat4 read_rotate(JsonObject& object) {
  if (const auto quaternion = object.find("quaternion")) return read_quaternion(*quaternion);
  const dvec3 axis = object.at("axis").direction();
  const double degrees = object.at("degrees").number();
  return glm::rotate(dmat4(1), glm::radians(degrees), axis);
}

dmat4 read_matrix(const JsonValue& value) {
  const auto items = value.items("numbers, row by row");
  dmat4 matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      matrix[column][row] = items[static_cast<std::size_t>(4 * row + column)].number();
  if (glm::row(matrix, 3) != glm::dvec4(0, 0, 0, 1))
    value.fail("wanted an affine matrix, whose last row is 0 0 0 1 (the numbers go row by row)");
  return matrix;
}

dmat4 read_step(const JsonValue& step) {
  const dmat4 matrix = step.object("transform_step", [&](JsonObject& object) {
    const std::string kind = object.one_of();
    const JsonValue value = *object.find(kind);
    if (kind == "translate") return glm::translate(dmat4(1), value.vec3());
    if (kind == "rotate") return value.object("rotate", read_rotate);
    return kind == "scale" ? glm::scale(dmat4(1), value.vec3()) : read_matrix(value);
  });
  check_transform(matrix, step);
  return matrix;
}

/// The volume spanned by three vectors, normalised: 1 if orthogonal, 0 if flat.
double openness(const dvec3& a, const dvec3& b, const dvec3& c) {
  return std::abs(glm::dot(glm::normalize(a), glm::cross(glm::normalize(b), glm::normalize(c))));
}

}  // namespace

void check_transform(const dmat4& matrix, const JsonValue& place) {
  const glm::dmat3 linear(matrix);
  const glm::dmat3 rows = glm::transpose(linear);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (!(std::abs(matrix[i][j]) <= any_number.high))
        place.fail("wanted a transform of finite numbers, found one beyond the range of floats");
  for (int i = 0; i < 3; ++i)
    if (glm::length(linear[i]) < 1e-15 || glm::length(rows[i]) < 1e-15)
      place.fail("singular transform: wanted one that can be inverted, found one that flattens space");
  // Uneven scales flatten either the rows or the columns; a singular matrix flattens both.
  if (std::max(openness(linear[0], linear[1], linear[2]), openness(rows[0], rows[1], rows[2])) < 1e-10)
    place.fail("singular transform: wanted one that can be inverted, found one that flattens space");
}

dmat4 read_transform(const JsonValue& list) {
  dmat4 product(1);
  for (const JsonValue& step : list.items("transforms")) product = read_step(step) * product;
  check_transform(product, list);
  return product;
}

dmat4 rotation_from_y(const dvec3& axis) {
  // The formula divides by 1 + cos(angle), so a downward axis is reached by a half turn and the rotation to
  // its opposite.
  const bool down = axis.y < 0;
  const dvec3 a = down ? -axis : axis;
  const double k = 1 / (1 + a.y);
  glm::dmat3 rotation(dvec3(1 - k * a.x * a.x, -a.x, -k * a.x * a.z), a,
                      dvec3(-k * a.x * a.z, -a.z, 1 - k * a.z * a.z));
  if (down) rotation = rotation * glm::dmat3(dvec3(1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, -1));
  return dmat4(rotation);
}

}  // namespace sundog
