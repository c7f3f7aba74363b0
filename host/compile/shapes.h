// The exact solids as unit shapes, whichever they are (models/values/solids.h).
#pragma once
#include <optional>
#include <string>

#include "models/values/object.h"

namespace sundog {

/// Throws SceneError (in `file`, at `object`'s place) for sizes that the solid cannot have.
UnitShape unit_shape(const std::string& file, const Object& object);

/// The maximum of dot(direction, p) over the points p of a bounded solid.
double reach(const UnitShape& unit, const dvec3& direction);
/// None for meshes and fields.
FlatFaces flat_faces(const UnitShape& unit);
/// Nothing for solids without curved surfaces, meshes and fields.
std::optional<Curvature> curvature(const UnitShape& unit);
/// A lower bound of the distance to a solid that is not always open.
double unit_distance(const UnitShape& unit, const dvec3& q);

}  // namespace sundog
