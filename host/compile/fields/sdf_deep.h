// Deep zooms: views so near a field that floats cannot distinguish the pixels' points.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "compile/fields/sdf.h"
#include "scene/description.h"

namespace sundog {

/// The camera's view of a field, in the field's units.
struct FieldView {
  dvec3 place{0};        // the camera's position
  double footprint = 0;  // pixel footprint at the nearest point of the field, as estimated
};

/// `object` must be a field.
FieldView view_of_field(const SceneDescription& scene, const Object& object);

/// Whether floats are too coarse for the view, so the field must be marched in doubles.
bool is_deep(const FieldView& view);

/// Adapts to the footprint of a near view what the scene leaves open: the minimum threshold and, in deep
/// views, the number of iterations.
SdfDescription near_description(SdfDescription field, const FieldView& view);

/// A field and the origin of its rays' coordinates, a point in its own space.
struct DeepField {
  SdfDescription field;
  dvec3 origin{0};
};

/// compile_fields() in doubles: intervals are relative to the origins, and each number is stored twice, as a
/// float and as a double. Throws FormulaError.
CompiledFields compile_deep_fields(std::span<const DeepField> fields);

}  // namespace sundog
