// The shapes of a scene as POV-Ray objects, in object space, without texture and transform.
#pragma once
#include <string>

#include "scene/description.h"

namespace sundog::povray {

/// Name under which the mesh was declared by declare_mesh().
std::string mesh_name(int mesh);

/// `#declare` of a mesh with its normals.
std::string declare_mesh(const SceneDescription& scene, int mesh);

/// The shape's statement, without the closing brace, so that modifiers can follow.
std::string open_shape(const SceneDescription& scene, const Shape& shape);

/// World bounds of an object; a plane's are the whole space.
struct Bounds {
  dvec3 lower, upper;
  bool overlaps(const Bounds& other) const;
};
Bounds world_bounds(const SceneDescription& scene, const Object& object);

}  // namespace sundog::povray
