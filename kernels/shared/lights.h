// Lights that have a position or a direction. The lists generate LIGHT_*, the description's LightType, names
// in scene files and figures, and what kernels call for a light. A light is a row here and a file of
// plain/light/lights/; its keys are members of LightDescription. Ambient lights are summed in
// SceneInfo.ambient.
//   LIGHT(constant after LIGHT_, name, 1 = it has a position, 1 = it has a direction, LightExtent)
// LightExtent (host/scene/kinds.h): `none`: light from a point or direction, with a falloff if it has a
// position; `sampled`: an area that is sampled but invisible to rays; `met`: sampled and visible to rays.
// The file defines:
//   sample_NAME(light, p)             delta lights: the way from the point p
//   sample_NAME(light, p, u_x, u_y)   area lights; the sky's: (light, u_x, u_y)
//   pdf_NAME(light, p, wi, d)         area lights: density of wi, which meets the light at the distance d
//   pdf_NAME(light, chance)           the sky's: density of a light that is chosen with `chance`
//   radiance_NAME(light, d, camera)   the sky's: what a ray sees in the direction d
//   middle_NAME(light)                area lights: see middle_of_light()
//   corners_NAME(light, p)            area lights of scene files: a square that holds what p sees of them
//
//   emit_NAME(light, c, e)            how photons leave it, by two numbers in [0, 1)
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define DELTA_LIGHTS(LIGHT)                   \
  LIGHT(DIRECTIONAL, directional, 0, 1, none) \
  LIGHT(POINT, point, 1, 0, none)             \
  LIGHT(SPOT, spot, 1, 1, none)

#define AREA_LIGHTS(LIGHT)               \
  LIGHT(RECTANGLE, rectangle, 1, 1, met) \
  LIGHT(DISK, disk, 1, 1, met)           \
  LIGHT(SPHERE, sphere, 1, 0, met)

#define LIGHTS(LIGHT) DELTA_LIGHTS(LIGHT) AREA_LIGHTS(LIGHT)

// Those that the host makes: a directional light from a disk in the sky; a triangle of an emissive mesh, by a
// corner and two edges; the environment (shared/environment.h).
#define SKY_LIGHTS(LIGHT) LIGHT(SUN, sun, 0, 1, met)
#define MESH_LIGHTS(LIGHT) LIGHT(TRIANGLE, triangle, 1, 1, met)

#define LIGHT_CONSTANT(constant, name, placed, aimed, extent) LIGHT_##constant,
typedef enum LightKind SUNDOG_ENUM_OF_U32 {
  LIGHTS(LIGHT_CONSTANT) SKY_LIGHTS(LIGHT_CONSTANT) MESH_LIGHTS(LIGHT_CONSTANT) LIGHT_ENVIRONMENT
} LightKind;
#undef LIGHT_CONSTANT

#define ONE_LIGHT(constant, name, placed, aimed, extent) +1u  // NOLINT(bugprone-macro-parentheses)
#define LIGHT_KINDS (0u LIGHTS(ONE_LIGHT))                    // those of scene files come first

// Bits by kind: lights with a position, lights in the sky, delta lights, lights with corners_NAME().
#define PLACED_LIGHT(constant, name, placed, aimed, extent) | (u32)(placed) << LIGHT_##constant
#define KIND_OF_LIGHT(constant, name, placed, aimed, extent) | 1u << LIGHT_##constant
#define PLACED_LIGHTS (0u LIGHTS(PLACED_LIGHT) MESH_LIGHTS(PLACED_LIGHT))
#define LIGHTS_OF_SKY (0u SKY_LIGHTS(KIND_OF_LIGHT))
#define LIGHTS_WITHOUT_EXTENT (0u DELTA_LIGHTS(KIND_OF_LIGHT))
#define LIGHTS_WITH_CORNERS (0u AREA_LIGHTS(KIND_OF_LIGHT))

// The part of the way to a light that shadow rays go, since the light's own surface lies at its end.
#define SHORT_OF_LIGHT 0x1.ffep-1f

// 96 bytes. An area light emits from its front, the side that `direction` points to; a sphere, from its
// outside. direction.w: spot: cosine of the outer half angle of the cone; area light: its area; sun: 1 -
// cosine of its half angle, negative if invisible.
typedef struct Light {
  float4 position;   // world; corner of a rectangle, else the centre; w = 1: an area light invisible to rays,
                     // a sun invisible to the camera
  float4 direction;  // unit, direction of emission; w: see above
  float4 color;      // times intensity (radiance of an area light); w = its group
  float falloff_constant, falloff_linear,
      falloff_quadratic;  // intensity / (c + l d + q d^2), d in world units
  u32 kind;               // LIGHT_*
  float4 edge_u, edge_v;  // sides of a rectangle, or from the centre to the rim of a disk; w = their lengths
                          // (edge_u.w is a sphere's radius). A spot's edge is s^2 (edge_u.x - edge_u.y s),
                          // its edge_u.z the cosine of the inner half angle; a point's and a spot's edge_v.x
                          // is 1 / range, or 0
} Light;
SUNDOG_SHARED_SIZE(Light, 96)

// Rays that see infinitely distant light.
#define SEEN_BY_NONE 0u
#define SEEN_BY_ALL 1u
#define SEEN_OFF_CAMERA 2u  // all except camera rays

#define LIGHT_CHOSEN 0xFFFFFFFFu  // LightRay.light: a light of the tree, chosen per surface

// 16 bytes: a shadow ray of every surface, number `ray` of `rays` that share one light's weight.
typedef struct LightRay {
  u32 light;  // index
  u32 ray, rays;
  u32 pad;
} LightRay;
SUNDOG_SHARED_SIZE(LightRay, 16)

// 32 bytes: a node of the tree over area lights. Its left child follows it.
typedef struct LightNode {
  float lower[3];
  float power;  // of all its lights
  float upper[3];
  u32 next;  // right child, or LIGHT_LEAF | index of its light
} LightNode;
SUNDOG_SHARED_SIZE(LightNode, 32)
#define LIGHT_LEAF 0x80000000u

SUNDOG_SHARED_END
