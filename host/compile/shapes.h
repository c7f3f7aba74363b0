// Geometry of any exact solid (models/values/solids.h) as a unit shape.
#pragma once
#include <optional>
#include <string>

#include "models/values/object.h"

namespace sundog {

/// Throws SceneError (in `file`, at `object`'s place) for sizes that the solid cannot have.
UnitShape unit_shape(const std::string& file, const Object& object);

/// The maximum of dot(direction, p) over the points p of a bounded solid.
double reach(const UnitShape& unit, const dvec3& direction);
/// The flat faces of a solid; none for meshes and fields.
FlatFaces flat_faces(const UnitShape& unit);
/// The curvature of a solid; nothing for one without curved surfaces, and for meshes and fields.
std::optional<Curvature> curvature(const UnitShape& unit);
/// A lower bound of the distance to a solid, negative inside; not for solids that never have an inside.
double unit_distance(const UnitShape& unit, const dvec3& q);

}  // namespace sundog
