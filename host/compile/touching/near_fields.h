// Finds distance fields that lie close together. In: their boxes and materials. Out: a mark on each.
#pragma once
#include <span>

#include "compile/steps.h"

namespace sundog {

/// Marks fields that may touch others (Instance::touch): those whose boxes meet that of one whose walls both
/// show, or all but. Returns whether there are any. `boxes`: of the fields.
bool mark_near_fields(std::span<const Bounds> boxes, std::span<const SurfaceFacts> materials,
                      std::span<Instance> fields);

}  // namespace sundog
