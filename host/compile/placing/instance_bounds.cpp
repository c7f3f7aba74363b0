// Takes the shape's reach along each axis of the world, rounds outwards, and cuts solids along their longest
// axis into two or four parts where that saves area.
#include "compile/placing/instance_bounds.h"

#include <algorithm>
#include <cmath>

namespace sundog {
namespace {

// Relative widening of boxes: instances' transforms are rounded to floats.
constexpr double widening = 0x1p-22;

float round_down(double value) {
  const auto rounded = static_cast<float>(value);
  return double(rounded) > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity()) : rounded;
}

float round_up(double value) { return -round_down(-value); }

/// The maximum of dot(d, p) over the shape's points p in unit space; over its boxes for a mesh or field.
double reach(const UnitShape& unit, std::span<const Bounds> boxes, const dvec3& d) {
  if (unit.shape != SHAPE_MESH && unit.shape != SHAPE_SDF) return reach(unit, d);
  double most = -std::numeric_limits<double>::infinity();
  for (const Bounds& box : boxes) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
      sum += d[axis] * double(d[axis] > 0 ? box.upper[axis] : box.lower[axis]);
    most = std::max(most, sum);
  }
  return most;
}

/// The box around unit-space points about `center`, within `half` along each axis, clipped to `whole`.
Bounds part_of(const Bounds& whole, const dmat4& world_from_unit, const dvec3& center, const dvec3& half) {
  Bounds bounds = whole;
  for (int axis = 0; axis < 3; ++axis) {
    double middle = world_from_unit[3][axis], reach = 0;
    for (int i = 0; i < 3; ++i) {
      middle += world_from_unit[i][axis] * center[i];
      reach += std::abs(world_from_unit[i][axis]) * half[i];
    }
    const double slack = widening * (std::abs(middle) + reach + std::abs(world_from_unit[3][axis]));
    bounds.lower[axis] = std::max(bounds.lower[axis], round_down(middle - reach - slack));
    bounds.upper[axis] = std::min(bounds.upper[axis], round_up(middle + reach + slack));
  }
  return bounds;
}

}  // namespace

Bounds world_bounds(const UnitShape& unit, std::span<const Bounds> boxes, const dmat4& world_from_unit,
                    bool exact) {
  Bounds bounds = Bounds::none();
  for (int axis = 0; axis < 3; ++axis) {
    const dvec3 row(world_from_unit[0][axis], world_from_unit[1][axis], world_from_unit[2][axis]);
    const double offset = world_from_unit[3][axis];
    double lower = offset - reach(unit, boxes, -row), upper = offset + reach(unit, boxes, row);
    const double slack =
        exact ? 0 : widening * std::max({std::abs(lower), std::abs(upper), std::abs(offset)});
    bounds.lower[axis] = round_down(lower - slack);
    bounds.upper[axis] = round_up(upper + slack);
  }
  bounds.lower[3] = bounds.upper[3] = 0;
  return bounds;
}

std::vector<Bounds> part_bounds(const UnitShape& unit, const dmat4& world_from_unit, const Bounds& whole) {
  constexpr int most_parts = 4;
  constexpr float least_saving = 0.6f;  // a cut must reduce the boxes' area at least to this
  dvec3 center, half, length;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 along(0);
    along[axis] = 1;
    const double upper = reach(unit, along), lower = -reach(unit, -along);
    center[axis] = (lower + upper) / 2, half[axis] = (upper - lower) / 2;
    length[axis] = glm::length(dvec3(world_from_unit[axis])) * half[axis];
  }
  const int longest = length.x >= length.y && length.x >= length.z ? 0 : length.y >= length.z ? 1 : 2;
  const Lanes edges = whole.upper - whole.lower;
  const float scale = 1 / std::max({edges[0], edges[1], edges[2], 1e-30f});
  std::vector<Bounds> parts{whole};
  float area = half_area(whole, scale);
  for (int count = 2; count <= most_parts; count *= 2) {
    std::vector<Bounds> finer;
    float sum = 0;
    dvec3 of_part = half, middle = center;
    of_part[longest] /= count;
    for (int i = 0; i < count; ++i) {
      middle[longest] = center[longest] + (2 * i + 1 - count) * of_part[longest];
      finer.push_back(part_of(whole, world_from_unit, middle, of_part));
      sum += half_area(finer.back(), scale);
    }
    if (sum > least_saving * area) break;
    parts = std::move(finer), area = sum;
  }
  return parts;
}

float4 sphere_around(const Bounds& box) {
  const dvec3 lower(box.lower[0], box.lower[1], box.lower[2]),
      upper(box.upper[0], box.upper[1], box.upper[2]);
  const dvec3 middle = 0.5 * (lower + upper);
  return {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z),
          round_up(0.5 * glm::length(upper - lower))};
}

}  // namespace sundog
