// Nearest hits of a batch of rays among all that a scene holds: the BVH's instances and the planes from the
// tracer, then the marched fields, which only look as far as that.
#ifndef SUNDOG_LIB_NEAREST_CL
#define SUNDOG_LIB_NEAREST_CL
#include "lib/config.h"
#include "lib/scene_ray.cl"
#include "lib/tables.h"
#include "lib/traverse.cl"

#if HAS_SDF
#include "lib/fields.cl"
#endif

// hits[k] becomes that of rays[which[k]], k < count; without one, its
// instance is NO_INSTANCE. `to_light`: of a shadow ray.
static inline void nearest_hits(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRay* rays, const u32* which,
                                u32 count, bool coherent, bool to_light, Hit* hits, u32* counts) {
  float3 o[BATCH], d[BATCH];
  float t_min[BATCH], t_max[BATCH];
  for (u32 k = 0; k < count; ++k) {
    const SceneRay* ray = rays + which[k];
    o[k] = ray->o;
    d[k] = ray->d;
    t_min[k] = ray->t_min;
    t_max[k] = ray->t_max;
  }
  trace_batch(TRACE_ARGUMENTS, o, d, t_min, t_max, count, coherent, hits);
#if HAS_SDF
  march_fields(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, which, count, to_light ? MARCH_TO_LIGHT : MARCH_TO_SEE,
               hits, counts);
#endif
}

// occluded[k] becomes 1 where rays[k] hits anything, else 0, k < count.
static inline void any_hits(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRay* rays, u32 count, bool coherent,
                            u32* occluded, u32* counts) {
  float3 o[BATCH], d[BATCH];
  float t_min[BATCH], t_max[BATCH];
  for (u32 k = 0; k < count; ++k) {
    o[k] = rays[k].o;
    d[k] = rays[k].d;
    t_min[k] = rays[k].t_min;
    t_max[k] = rays[k].t_max;
  }
  occluded_batch(TRACE_ARGUMENTS, o, d, t_min, t_max, count, coherent, occluded);
#if HAS_SDF
  Hit hits[BATCH];
  u32 open[BATCH], open_count = 0;
  for (u32 k = 0; k < count; ++k)
    if (!occluded[k]) {
      open[open_count] = k;
      hits[open_count++] = no_hit(t_max[k]);
    }
  march_fields(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, open, open_count, MARCH_TO_BLOCK, hits, counts);
  for (u32 k = 0; k < open_count; ++k) occluded[open[k]] = hits[k].instance != NO_INSTANCE;
#endif
}

#endif
