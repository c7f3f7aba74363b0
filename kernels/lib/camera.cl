// The pinhole camera and what lies behind everything.
#ifndef SUNDOG_LIB_CAMERA_CL
#define SUNDOG_LIB_CAMERA_CL
#include "lib/tables.h"
#include "lib/transform.cl"

typedef struct CameraRay {
  float3 o, d;  // d unit
  float t_min, t_max;
} CameraRay;

static inline CameraRay camera_ray(__global const SceneInfo* restrict info, float x, float y) {
  CameraRay ray;
  const float3 along = info->camera_corner.xyz + x * info->camera_dx.xyz + y * info->camera_dy.xyz;
  const float depth_to_t = sqrt(dot(along, along));  // `along` has length 1 along the view
  ray.o = info->camera_position.xyz;
  ray.d = along / depth_to_t;
  ray.t_min = info->camera_forward.w * depth_to_t;
  ray.t_max = info->background_bottom.w * depth_to_t;
  return ray;
}

// How much wider a pixel's footprint becomes on each unit of a ray's way.
static inline float pixel_spread(__global const SceneInfo* restrict info) {
  const float3 dx = info->camera_dx.xyz;
  return sqrt(dot(dx, dx));
}

// What a ray sees that meets nothing, by its unit direction.
static inline float3 background_along(__global const SceneInfo* restrict info, float3 d) {
  const float s = clamp(0.5f + 0.5f * dot(d, info->up.xyz), 0.0f, 1.0f);
  const float3 bottom = info->background_bottom.xyz, top = info->background_top.xyz;
  return bottom + s * (top - bottom);
}

#endif
