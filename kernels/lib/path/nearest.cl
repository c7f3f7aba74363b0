// Nearest hits of a batch among everything in the scene: first instances and planes by the tracer, then
// fields by marching up to those hits.
#pragma once
#include "lib/core/config.h"
#include "lib/core/tables.h"
#include "lib/path/fields.cl"
#include "lib/path/scene_ray.cl"
#include "lib/trace/traverse.cl"

// The hits of the lanes of `active`; no hits elsewhere. `coherent`: the rays are coherent.
static inline void nearest_hits(const Scene* scene, SceneRays* rays, MASK active, bool coherent, Hits* hits,
                                u32* counts) {
  const TraceRays traced = {&rays->o, &rays->d, &rays->t_min, hits, 0, 0};
  trace_batch(scene, &traced, rays->t_max, time_of_rays(rays), active, coherent);
  HAVING(HAS_SDF, march_fields(scene, rays, active, MARCH_TO_SEE, hits, counts);)
}

// nearest_hits() for shadow rays.
static inline void nearest_to_light(const Scene* scene, SceneRays* rays, MASK active, bool coherent,
                                    Hits* hits, u32* counts) {
  const TraceRays traced = {&rays->o, &rays->d, &rays->t_min, hits, 0, 0};
  trace_batch(scene, &traced, rays->t_max, time_of_rays(rays), active, coherent);
  HAVING(HAS_SDF, march_fields(scene, rays, active, MARCH_TO_LIGHT, hits, counts);)
}

// The lanes of `active` that hit anything.
static inline MASK any_hits(const Scene* scene, SceneRays* rays, MASK active, bool coherent, u32* counts) {
  MASK occluded = occluded_batch(scene, &rays->o, &rays->d, &rays->t_min, rays->t_max, time_of_rays(rays),
                                 active, coherent);
  const MASK open = active & ~occluded;
  if (HAS_SDF && any_lane(open)) {
    Hits hits = no_hits(rays->t_max);
    HAVING(HAS_SDF, march_fields(scene, rays, open, MARCH_TO_BLOCK, &hits, counts);)
    occluded |= open & hit_anything(&hits);
  }
  return occluded;
}

#if BATCH == 1
// One ray of either kind, so that lanes of a group with different kinds stay together: the nearest hit or,
// for an opaque scene's shadow ray, any.
static inline void next_hits(const Scene* scene, SceneRays* rays, MASK active, bool to_light, Hits* hits,
                             u32* counts) {
  const bool any = to_light && !HAS_SHADOW_FILTERS;
  const TraceRays traced = {&rays->o, &rays->d, &rays->t_min, hits, 0, 0};
  find_hits(scene, &traced, rays->t_max, time_of_rays(rays), active, any ? TRACE_ANY : TRACE_NEAREST);
  finish_triangles(scene, false, hits);
  HAVING(HAS_SDF, const u32 purpose = any ? MARCH_TO_BLOCK : to_light ? MARCH_TO_LIGHT : MARCH_TO_SEE;)
  if (any) active &= ~hit_anything(hits);
  HAVING(HAS_SDF, if (any_lane(active)) march_fields(scene, rays, active, purpose, hits, counts);)
}
#endif
