// The exact solids as unit shapes (kernels/shared/shapes.h): the part of a shape's size that a transform can
// carry, what stays in parameters, and the geometry of the unit shape: how far it reaches, its flat faces,
// its distance.
#pragma once
#include <optional>
#include <vector>

#include "compile/compiled_scene.h"

namespace sundog {

struct UnitShape {
  ShapeKind shape = SHAPE_MESH;
  dvec3 scale{1};  // unit shape to the description's object space
  float4 parameters{};
};

/// Throws SceneError (at `object`'s place) for sizes that are not positive, and for a torus or rounded box
/// that cuts itself.
UnitShape unit_shape(const SceneDescription& scene, const Object& object);

// The functions below take exact solids, not meshes or fields.

/// Greatest dot(direction, p) over the points p of a bounded solid.
double reach(const UnitShape& unit, const dvec3& direction);

/// A flat face: the parallelogram center + [-1, 1] u + [-1, 1] v holds it.
struct FlatFace {
  dvec3 normal, center, u, v;
  bool unbounded = false;
};
std::vector<FlatFace> flat_faces(const UnitShape& unit);

/// How a solid's surface bends.
struct Curvature {
  double greatest;          // infinite at a cone's tip
  bool straight_y = false;  // a stretch along y bends nothing
};
/// Nothing for solids without curved surfaces.
std::optional<Curvature> curvature(const UnitShape& unit);

/// Zero on the surface, below zero inside, and nowhere steeper than the distance to it; a cylinder or cone
/// counts as capped. Not for solids that are always open.
double unit_distance(const UnitShape& unit, const dvec3& q);

}  // namespace sundog
