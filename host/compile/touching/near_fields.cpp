// Compares the boxes of all pairs of fields.
#include "compile/touching/near_fields.h"

#include <algorithm>
#include <cmath>

#include "compile/touching/box_tree.h"

namespace sundog {

namespace {

/// The maximum gap between boxes, relative to the larger box, because rays stop short of a surface.
constexpr double near = 1e-3;

double extent(const Bounds& box) {
  double most = 0;
  for (int axis = 0; axis < 3; ++axis)
    most = std::max(most, double(box.upper[axis]) - double(box.lower[axis]));
  return std::isfinite(most) ? most : 0;
}

}  // namespace

bool shows_both_walls(const SurfaceFacts& material) {
  return (material.flags & (MATERIAL_TRANSMITS | MATERIAL_CATCHER)) != 0;
}

bool mark_near_fields(std::span<const Bounds> boxes, std::span<const SurfaceFacts> materials,
                      std::span<Instance> fields) {
  bool any = false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!shows_both_walls(materials[fields[i].material])) continue;
    any = true;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const double slack = near * std::max(extent(boxes[i]), extent(boxes[k]));
      if (k == i || overlap(boxes[i], boxes[k], slack)) fields[k].touch = 1;
    }
  }
  return any;
}

}  // namespace sundog
