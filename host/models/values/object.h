// Shapes, and objects that place them.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <variant>
#include <vector>

#include "models/values/solids.h"
#include "shared/scene.h"

namespace sundog {

struct MeshShape {
  int mesh = 0;
};  // index into meshes
struct FieldShape {
  int field = 0;
};  // index into fields

#define SUNDOG_SHAPE_TYPE(constant, type, name, effect) type##Shape,
/// Alternatives are in the order of the SHAPE_* constants.
using Shape = std::variant<MeshShape, SOLIDS(SUNDOG_SHAPE_TYPE) FieldShape>;
#undef SUNDOG_SHAPE_TYPE
static_assert(std::variant_size_v<Shape> == SHAPE_COUNT);

/// A rotation about a point and scaling from it while the shutter is open, in the parent's space `frame`.
struct TurnDescription {
  glm::dmat3 frame{1};  // parent to world
  dvec3 axis{0, 1, 0};  // in the parent's space
  double degrees = 0;
  dvec3 about{0};     // in world space, before any motion
  double growth = 1;  // scale factor when the shutter closes
  dvec3 moves_by{0};  // translation within this turn, as in Object
};

/// A placed shape. Groups are flattened: the transform is the product of the groups' and the object's.
struct Object {
  std::string name;
  Shape shape = SphereShape{};
  int material = -1;  // -1: the mesh's own materials
  dmat4 world_from_object{1};
  std::string place;                     // JSON pointer, for messages
  int light = -1;                        // index of the area light that it shows; -1: none
  dvec3 moves_by{0};                     // translation while the shutter is open, linear
  std::vector<TurnDescription> turns{};  // applied before moves_by; the outermost group's first
  bool moves() const { return moves_by != dvec3(0) || !turns.empty(); }
};

}  // namespace sundog
