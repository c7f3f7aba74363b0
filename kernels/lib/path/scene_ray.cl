// Rays on their way through the scene, a ray a lane (plain/path/scene_ray.cl), and their media.
#pragma once
#include "lib/core/tables.h"
#include "lib/path/camera.cl"
#include "lib/path/media.cl"
#include "lib/trace/hits.cl"
#include "plain/path/scene_ray.cl"

static inline REAL time_of_rays(const SceneRays* rays) {
  return EITHER(HAS_OBJECT_MOTION, rays->time, (REAL)(0.0f));
}

static inline SceneRays scene_rays(const Rays* camera, MediaStack media) {
  return begun_ray(camera, (int)media, (int)(media >> 32), ALL_LANES);
}

static inline MediaStack get_media(const SceneRays* rays, u32 i) {
  return (MediaStack)(u32)MASK_LANE(rays->media_high, i) << 32 | (u32)MASK_LANE(rays->media_low, i);
}
static inline void set_media(SceneRays* rays, u32 i, MediaStack stack) {
  MASK_LANE(rays->media_low, i) = (int)stack;
  MASK_LANE(rays->media_high, i) = (int)(stack >> 32);
}

// The media of the lanes of `lanes`.
static inline MASK current_media(__global const Medium* restrict media, const SceneRays* rays, MASK lanes) {
  MASK current = NO_LANES;
  const MASK somewhere = lanes & MASK_OF((rays->media_low | rays->media_high) != 0);
  EACH_LANE(i, somewhere) { MASK_LANE(current, i) = (int)current_medium(media, get_media(rays, i)); }
  return current;
}

#include "plain/path/media.cl"
