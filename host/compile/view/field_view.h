// The camera's views of fields: whether floats can distinguish their pixels' points.
#pragma once
#include <vector>

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

/// The camera's views of fields, one for each object, empty for other objects.
std::vector<FieldView> views_of(const SceneDescription& scene);
bool any_deep(const std::vector<FieldView>& views);

}  // namespace sundog
