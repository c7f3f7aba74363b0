// Views of fields from so near that floats do not tell the pixels' points apart.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "compile/fields/sdf.h"
#include "scene/description.h"

namespace sundog {

/// A field as the camera sees it, all in the field's own units.
struct FieldView {
  dvec3 place{0};        // of the camera
  double footprint = 0;  // of a pixel on the nearest point of the field, as far as the estimate knows
};

/// Of a scene's object that is a field.
FieldView view_of_field(const SceneDescription& scene, const Object& object);

/// Whether floats are too coarse for the view: then the field is marched in doubles.
bool is_deep(const FieldView& view);

/// The description with what follows the footprint of a near view, unless the scene has set it: the least
/// threshold and, in deep views, the iterations.
SdfDescription near_description(SdfDescription field, const FieldView& view);

/// A field whose rays count from `origin`, a point of its own space.
struct DeepField {
  SdfDescription field;
  dvec3 origin{0};
};

/// Like compile_fields(), in doubles: intervals count from the origins, and each number is in the table
/// twice, as a float and as a double. Throws FormulaError.
CompiledFields compile_deep_fields(std::span<const DeepField> fields);

}  // namespace sundog
