// Rays on their way through the scene, a ray a lane (plain/path/scene_ray.cl), and their media.
#pragma once
#include "lib/core/tables.h"
#include "lib/trace/hits.cl"

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

#include "plain/path/scene_ray.cl"

static inline REAL time_of_rays(const SceneRays* rays) {
  return EITHER(HAS_OBJECT_MOTION, rays->time, (REAL)(0.0f));
}

// A stack that the host keeps between kernels.
static inline MediaStack read_media(__global const u32* words) {
  const MediaStack media = {(int)words[0], (int)words[1]};
  return media;
}
static inline void write_media(MediaStack media, __global u32* words) {
  words[0] = (u32)media.low;
  words[1] = (u32)media.high;
}
static inline void set_media(SceneRays* rays, u32 i, MediaStack media) {
  MASK_LANE(rays->media.low, i) = media.low;
  MASK_LANE(rays->media.high, i) = media.high;
}

static inline SceneRays scene_rays(const CameraRays* camera, MediaStack media) {
  return begun_ray(camera, &media, ALL_LANES);
}

#include "plain/path/media.cl"
