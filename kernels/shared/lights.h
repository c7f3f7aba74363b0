// The lights that have a place or a direction, in one list: from it come LIGHT_*, the description's
// LightType, and the names in scene files and figures. Ambient lights are no part of it: they are summed into
// SceneInfo.ambient.
//   LIGHT(constant after LIGHT_, name, 1 = it has a position, 1 = it has a direction, LightExtent)
// LightExtent (host/scene/kinds.h): `none`: light from one point or direction, with a falloff where it has a
// position; `sampled`: places on it are chosen, rays do not meet it; `met`: sampled, and rays meet it too.
#ifndef SUNDOG_SHARED_LIGHTS_H
#define SUNDOG_SHARED_LIGHTS_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define LIGHTS(LIGHT)                         \
  LIGHT(DIRECTIONAL, directional, 0, 1, none) \
  LIGHT(POINT, point, 1, 0, none)             \
  LIGHT(SPOT, spot, 1, 1, none)               \
  LIGHT(RECTANGLE, rectangle, 1, 1, met)      \
  LIGHT(DISK, disk, 1, 1, met)                \
  LIGHT(SPHERE, sphere, 1, 0, met)

// What scene files say about them: the members of the host's LightDescription, with their defaults.
//   KEY(type, name, default)
#define LIGHT_KEYS(KEY)                                                                 \
  KEY(dvec3, color, {1, 1, 1})                                                          \
  KEY(double, intensity, {1})       /* times colour: of an extent its radiance */       \
  KEY(dvec3, position, {0, 0, 0})   /* of an extent the middle */                       \
  KEY(dvec3, direction, {0, -1, 0}) /* the way the light travels; normalised later */   \
  KEY(double, inner_angle, {20})    /* spot: half angles in degrees, */                 \
  KEY(double, outer_angle, {30})    /* 0 <= inner <= outer < 90 */                      \
  KEY(bool, square_edge, {false})   /* spot: between them s^2, else s^2 (3 - 2 s) */    \
  KEY(double, range, {0})           /* point, spot: fades to 0 there; 0: it does not */ \
  KEY(dvec3, falloff, {1, 0, 0})    /* constant, linear, quadratic */                   \
  KEY(dvec2, size, {1, 1})          /* rectangle: across and along `up` */              \
  KEY(dvec3, up, {0, 1, 0})                                                             \
  KEY(double, radius, {0.5}) /* disk, sphere */                                         \
  KEY(double, angle, {0})    /* directional: degrees across that it takes up            \
                                in the sky, [0, 90]; above 0 an extent */               \
  KEY(int, samples, {1})     /* an extent: shadow rays that a surface sends to it */    \
  KEY(bool, visible, {true}) /* the camera's rays see it, where others do */            \
  KEY(bool, hidden, {false}) /* no ray meets it (scene/lamps.h places what they meet) */

#define LIGHT_CONSTANT(constant, name, placed, aimed, extent) LIGHT_##constant,
typedef enum LightKind SUNDOG_ENUM_OF_U32 {
  LIGHTS(LIGHT_CONSTANT) LIGHT_KINDS,
  LIGHT_SUN = LIGHT_KINDS,  // a directional light from a disk in the sky
  LIGHT_ENVIRONMENT,        // from all around (shared/environment.h)
  LIGHT_TRIANGLE            // of a mesh that shines: a corner and two edges
} LightKind;
#undef LIGHT_CONSTANT

// 96 bytes. A light with an extent shines from its front, the side that `direction` points to; a sphere from
// its outside. direction.w: of a spot the cosine of the cone's outer half angle; of an extent its area; of a
// sun 1 minus the cosine of its half angle, below 0 where no ray sees it.
typedef struct Light {
  float4 position;   // world; of a rectangle the corner, else the centre; w = 1: an extent that rays do not
                     // meet, of a sun: that those of the camera do not see
  float4 direction;  // unit, the way the light travels; w: see above
  float4 color;  // times intensity (the radiance, of an extent); w = cosine of the cone's inner half angle
  float falloff_constant, falloff_linear,
      falloff_quadratic;  // intensity / (c + l d + q d^2), d in world units
  u32 kind;               // LIGHT_*
  float4 edge_u, edge_v;  // sides of a rectangle, from the centre to the rim of a disk; w = their lengths (of
                          // a sphere edge_u.w is the radius). A spot's edge is s^2 (edge_u.x - edge_u.y s); a
                          // point's and a spot's edge_v.x is 1 over the range, 0 without one
} Light;
SUNDOG_SHARED_SIZE(Light, 96)

// Which rays see what is infinitely far away.
#define SEEN_BY_NONE 0u
#define SEEN_BY_ALL 1u
#define SEEN_OFF_CAMERA 2u  // all but the camera's

#define LIGHT_CHOSEN 0xFFFFFFFFu  // LightRay.light: one of the lights of the tree, chosen for each surface

// 16 bytes: a shadow ray that surfaces send, the number `ray` of the `rays` that share one light's weight.
typedef struct LightRay {
  u32 light;  // index
  u32 ray, rays;
  u32 pad;
} LightRay;
SUNDOG_SHARED_SIZE(LightRay, 16)

// 32 bytes: a node of the tree over the lights with an extent. Its left child follows it.
typedef struct LightNode {
  float lower[3];
  float power;  // of all its lights
  float upper[3];
  u32 next;  // the right child, or LIGHT_LEAF | index of its light
} LightNode;
SUNDOG_SHARED_SIZE(LightNode, 32)
#define LIGHT_LEAF 0x80000000u

SUNDOG_SHARED_END
#endif
