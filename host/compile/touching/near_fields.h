// Finds distance fields that lie close together. In: their boxes and materials. Out: a mark on each.
#pragma once
#include <span>

#include "compile/steps.h"

namespace sundog {

/// Whether rays see the walls of fields of this material from both sides.
bool shows_both_walls(const SurfaceFacts& material);

/// Marks fields of which rays remember their side (Instance::touch): those whose walls both show, as rays may
/// start anywhere inside them, and those whose boxes all but meet one of them. Returns whether there are any.
/// `boxes`: of the fields.
bool mark_near_fields(std::span<const Bounds> boxes, std::span<const SurfaceFacts> materials,
                      std::span<Instance> fields);

}  // namespace sundog
