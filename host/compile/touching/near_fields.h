// Finds distance fields that lie close together, by their boxes and materials, and marks them.
#pragma once
#include <span>

#include "compile/steps.h"

namespace sundog {

/// Whether rays see the walls of fields of this material from both sides.
bool shows_both_walls(const SurfaceFacts& material);

/// Marks fields whose sides rays remember (Instance::touch): fields that show both walls, because rays may
/// start anywhere inside them, and fields whose boxes nearly meet such a field's. Returns whether any field
/// shows both walls. `boxes`: the fields' boxes.
bool mark_near_fields(std::span<const Bounds> boxes, std::span<const SurfaceFacts> materials,
                      std::span<Instance> fields);

}  // namespace sundog
