// The exact solids as unit shapes (kernels/shared/shapes.h): the part of a size that a transform applies, the
// remaining parameters, and geometry of the unit shape: support, flat faces, distance.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compile/revolution.h"
#include "models/values/object.h"

namespace sundog {

struct UnitShape {
  ShapeKind shape = SHAPE_MESH;
  dvec3 scale{1};  // unit shape to object space
  float4 parameters{};
  std::shared_ptr<const Revolution> revolution{};  // of a lathe
};

/// Throws SceneError (in `file`, at `object`'s place) for sizes that are not positive, and for a
/// self-intersecting torus or rounded box. A lathe's rows begin at 0.
UnitShape unit_shape(const std::string& file, const Object& object);

// The functions below take exact solids, not meshes or fields.

/// Support: maximum of dot(direction, p) over the points p of a bounded solid.
double reach(const UnitShape& unit, const dvec3& direction);

/// A flat face, contained in the parallelogram center + [-1, 1] u + [-1, 1] v.
struct FlatFace {
  dvec3 normal, center, u, v;
  bool unbounded = false;
};
std::vector<FlatFace> flat_faces(const UnitShape& unit);

/// Curvature of a solid's surface.
struct Curvature {
  double greatest;          // infinite at a cone's tip
  bool straight_y = false;  // stretching along y does not change it
};
/// Nothing for solids without curved surfaces.
std::optional<Curvature> curvature(const UnitShape& unit);

/// A lower bound of the distance: zero on the surface, negative inside, slope at most 1; a cylinder or cone
/// counts as capped. Not for solids that are always open.
double unit_distance(const UnitShape& unit, const dvec3& q);

}  // namespace sundog
