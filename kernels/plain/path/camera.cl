// The pinhole camera and the background.
#include "plain/core.h"

// Rays and their intervals, in world space unless stated otherwise.
typedef struct CameraRay {
  float3 o, d;  // d unit
  float t_min, t_max;
  HAVING(HAS_CONES) float spread;        // growth of its cone's width per unit of distance
  HAVING(HAS_OBJECT_MOTION) float time;  // from 0, when the shutter opens, to 1
} CameraRay;

UNIFORM float pixel_spread(UNIFORM __global const SceneInfo* info);
UNIFORM float sample_spread(UNIFORM __global const SceneInfo* info);

// A ray of the direction d, unit.
ENTRY static inline CameraRay endless_ray(UNIFORM __global const SceneInfo* info, float3 o, float3 d,
                                          float time) {
  CameraRay ray;
  ray.o = o;
  ray.d = d;
  ray.t_min = 0.0f;
  ray.t_max = INFINITY;
  if (HAS_CONES) ray.spread = sample_spread(info);
  if (HAS_OBJECT_MOTION) ray.time = time;
  return ray;
}

// A ray between the clipping planes; `ahead` has length 1 along the view.
static inline CameraRay clipped_ray(UNIFORM __global const SceneInfo* info, float3 o, float3 ahead,
                                    float time) {
  const float depth_to_t = length(ahead);
  CameraRay ray = endless_ray(info, o, ahead * (1.0f / depth_to_t), time);
  ray.t_min = info->camera_forward.w * depth_to_t;
  ray.t_max = info->background_bottom.w * depth_to_t;
  return ray;
}

ENTRY static inline CameraRay camera_rays(UNIFORM __global const SceneInfo* info, float x, float y,
                                          float time) {
  float3 o = info->camera_position.xyz;
  float3 ahead = along(along(info->camera_corner.xyz, x, info->camera_dx.xyz), y, info->camera_dy.xyz);
  if (HAS_ORTHOGRAPHIC) {
    o = o + ahead;
    ahead = info->camera_forward.xyz;
  }
  return clipped_ray(info, o, ahead, time);
}

// The background for a ray of this unit direction.
static inline float3 background_along(UNIFORM __global const SceneInfo* info, float3 d) {
  const float3 bottom = info->background_bottom.xyz;
  const float s = real_clamp(fma(dot(d, info->up.xyz), 0.5f, 0.5f), 0.0f, 1.0f);
  return along(bottom, s, info->background_top.xyz - bottom);
}
