// Shapes of instances: meshes, exact solids, distance fields. The list of solids generates SHAPE_*, HAS_*,
// HAS_SOLID, the description's Shape, and names in scene files and figures.
//   SOLID(constant after SHAPE_ and HAS_, description's struct before Shape, name, effect as in features.h)
// Exact solids are unit shapes scaled by their transform; `parameters` holds what a transform cannot express
// (in object space, y is the axis).
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define SOLIDS(SOLID)                                                                                      \
  SOLID(SPHERE, Sphere, sphere, same)          /* radius 1 at the origin */                                \
  SOLID(PLANE, Plane, plane, same)             /* y = 0, inside is y < 0; unbounded */                     \
  SOLID(BOX, Box, box, same)                   /* [-1, 1]^3 */                                             \
  SOLID(CYLINDER, Cylinder, cylinder, rounds)  /* radius 1, y in [-1, 1]; parameters.x: 1 = capped */      \
  SOLID(CONE, Cone, cone, rounds)              /* radius parameters.x at y = -1, parameters.y at y = 1     \
                                                  (>= 0, not both 0); parameters.z: 1 = capped */          \
  SOLID(DISK, Disk, disk, same)                /* radius 1 in y = 0, normal +y; parameters.x: inner radius \
                                                  (0 <= x < 1) */                                          \
  SOLID(RECTANGLE, Rectangle, rectangle, same) /* [-1, 1]^2 in y = 0, normal +y */                         \
  SOLID(TORUS, Torus, torus, rounds)           /* major radius 1 about y, minor radius parameters.x        \
                                                  (0 < x < 1) */                                           \
  SOLID(ROUNDBOX, RoundBox, round_box, rounds) /* half sizes parameters.xyz, edges rounded with radius     \
                                                  parameters.w (<= the smallest half size) */              \
  SOLID(LATHE, Lathe, lathe, rounds)           /* a profile about y: parameters.y rows of ProfileArc from  \
                                                  row parameters.x; within radius parameters.z,            \
                                                  |y| <= parameters.w */

// Instance.shape, and the alternatives' indices in the description's Shape.
#define SHAPE_CONSTANT(constant, type, name, effect) SHAPE_##constant,
typedef enum ShapeKind SUNDOG_ENUM_OF_U32 { SHAPE_MESH, SOLIDS(SHAPE_CONSTANT) SHAPE_SDF } ShapeKind;
#undef SHAPE_CONSTANT
#define SHAPE_COUNT (SHAPE_SDF + 1u)

// 64 bytes: a part of a lathe's profile, a cubic in t from 0 to 1, x + y t + z t^2 + w t^3. Radius, height
// and both derivatives are monotone. Its normal is to the right of its direction.
typedef struct ProfileArc {
  float4 r, y;   // radius and height
  float4 end;    // radius and height at 1, as at 0 of the next arc; unused
  float4 along;  // lengths: of the profile before it, its own, of the whole; unused
} ProfileArc;
SUNDOG_SHARED_SIZE(ProfileArc, 64)

// Whether the scene contains exact solids.
#define HAS_SOLID_OR(constant, type, name, effect) HAS_##constant ||
#define HAS_SOLID (SOLIDS(HAS_SOLID_OR) 0)

SUNDOG_SHARED_END
