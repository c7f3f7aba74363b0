// Deep zooms: views so near a field that floats cannot distinguish the pixels' points.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "compile/fields/sdf.h"
#include "compile/view/field_view.h"
#include "scene/description.h"

namespace sundog {

/// Adapts what the scene leaves open to a near view's footprint: the minimum threshold and, in deep views,
/// the number of iterations.
SdfDescription near_description(SdfDescription field, const FieldView& view);

/// A field and the origin of its rays' coordinates, a point in the field's space.
struct DeepField {
  SdfDescription field;
  dvec3 origin{0};
};

/// compile_fields() in doubles: intervals are relative to the origins, and each number is stored twice, as a
/// float and as a double. Throws FormulaError.
CompiledFields compile_deep_fields(std::span<const DeepField> fields);

}  // namespace sundog
