// Shapes, and objects that place them.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <variant>
#include <vector>

#include "models/values/profile.h"
#include "shared/scene.h"
#include "shared/shapes.h"

namespace sundog {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;

struct MeshShape {
  int mesh = 0;
};  // index into meshes
struct FieldShape {
  int field = 0;
};  // index into fields

// The exact solids of shared/shapes.h. half_size(): of the bounding box about the origin; open(): has no
// inside.
struct PlaneShape {  // y = 0, normal +y, inside below
  bool open() const { return false; }
};
struct SphereShape {
  double radius = 1;
  dvec3 half_size() const { return dvec3(radius); }
  bool open() const { return false; }
};
struct BoxShape {
  dvec3 half{1, 1, 1};
  dvec3 half_size() const { return half; }
  bool open() const { return false; }
};
struct CylinderShape {  // about y, centred
  double radius = 1, half_height = 1;
  bool capped = true;
  dvec3 half_size() const { return {radius, half_height, radius}; }
  bool open() const { return !capped; }
};
struct ConeShape {
  double bottom_radius = 1, top_radius = 0, half_height = 1;
  bool capped = true;
  dvec3 half_size() const {
    const double radius = bottom_radius > top_radius ? bottom_radius : top_radius;
    return {radius, half_height, radius};
  }
  bool open() const { return !capped; }
};
struct DiskShape {  // in y = 0
  double radius = 1, inner_radius = 0;
  dvec3 half_size() const { return {radius, 0, radius}; }
  bool open() const { return true; }
};
struct RectangleShape {  // in y = 0; half sizes along x and z
  dvec2 half{1, 1};
  dvec3 half_size() const { return {half.x, 0, half.y}; }
  bool open() const { return true; }
};
struct TorusShape {  // about y
  double major_radius = 1, minor_radius = 0.25;
  dvec3 half_size() const { return {major_radius + minor_radius, minor_radius, major_radius + minor_radius}; }
  bool open() const { return false; }
};
struct RoundBoxShape {  // outer half sizes, edge radius
  dvec3 half{1, 1, 1};
  double radius = 0.1;
  dvec3 half_size() const { return half; }
  bool open() const { return false; }
};
/// A surface of revolution about y, to the right of its profile; of the profile the middle height is 0.
struct LatheShape {
  std::vector<ProfileCubic> profile{{{0, -1}, {0, -1}, {1, -1}, {1, -1}},
                                    {{1, -1}, {0.2, -0.4}, {0.2, 0.4}, {1, 1}},
                                    {{1, 1}, {1, 1}, {0, 1}, {0, 1}}};
  bool closed = true;  // it ends on the axis, or where it began, and encloses a solid
  double radius = 1, half_height = 1;
  dvec3 half_size() const { return {radius, half_height, radius}; }
  bool open() const { return !closed; }
};

#define SUNDOG_SHAPE_TYPE(constant, type, name) type##Shape,
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
