// The pinhole camera and the background.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"

// Rays and their intervals, in world space unless stated otherwise.
typedef struct Rays {
  REAL3 o, d;  // d unit
  REAL t_min, t_max;
  HAVING(HAS_CONES, REAL spread;)        // growth of their cones' width per unit of distance
  HAVING(HAS_OBJECT_MOTION, REAL time;)  // from 0, when the shutter opens, to 1
} Rays;

static inline void set_ray_times(REAL time, Rays* rays) { HAVING(HAS_OBJECT_MOTION, rays->time = time;) }

// Growth of a pixel's footprint per unit of a ray's distance.
static inline float pixel_spread(__global const SceneInfo* restrict info) {
  const float3 dx = info->camera_dx.xyz;
  return sqrt(dot(dx, dx)) * (HAS_ORTHOGRAPHIC ? info->camera_corner.w : 1.0f);
}

// Growth of a sample's footprint. The samples share the pixel, but each sees more than its share, or too
// little would be filtered.
static inline float sample_spread(__global const SceneInfo* restrict info) {
  return pixel_spread(info) * fmax(rsqrt((float)info->samples), 0.125f);
}

static inline void start_cones(__global const SceneInfo* restrict info, Rays* rays) {
  HAVING(HAS_CONES, rays->spread = (REAL)(sample_spread(info));)
}

static inline Rays camera_rays(__global const SceneInfo* restrict info, REAL x, REAL y) {
  Rays rays;
  REAL3 along = along3(along3(all3(info->camera_corner.xyz), x, all3(info->camera_dx.xyz)), y,
                       all3(info->camera_dy.xyz));
  rays.o = all3(info->camera_position.xyz);
  if (HAS_ORTHOGRAPHIC) {
    rays.o = add3(rays.o, along);
    along = all3(info->camera_forward.xyz);
  }
  const REAL depth_to_t = length3(along);  // `along` has length 1 along the view
  rays.d = scale3(along, 1.0f / depth_to_t);
  rays.t_min = info->camera_forward.w * depth_to_t;
  rays.t_max = info->background_bottom.w * depth_to_t;
  start_cones(info, &rays);
  set_ray_times((REAL)(0.0f), &rays);
  return rays;
}

// The background for a ray of this unit direction.
static inline REAL3 background_along(__global const SceneInfo* restrict info, REAL3 d) {
  const float3 bottom = info->background_bottom.xyz;
  const REAL sine = dot3(d, all3(info->up.xyz));
  const REAL s = real_clamp(fma(sine, (REAL)(0.5f), (REAL)(0.5f)), (REAL)(0.0f), (REAL)(1.0f));
  return along3(all3(bottom), s, all3(info->background_top.xyz - bottom));
}
