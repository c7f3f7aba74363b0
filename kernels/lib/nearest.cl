// Nearest hits of a batch of rays among all that a scene holds: the BVH's instances and the planes from the
// tracer, then the marched fields, which only look as far as that.
#ifndef SUNDOG_LIB_NEAREST_CL
#define SUNDOG_LIB_NEAREST_CL
#include "lib/camera.cl"
#include "lib/config.h"
#include "lib/media.cl"
#include "lib/tables.h"
#include "lib/traverse.cl"

#define FROM_NOWHERE 0xFFFFFFFFu

// A ray in world space with what travels along.
typedef struct SceneRay {
  float3 o, d;  // d unit
  float t_min, t_max;
  MediaStack media;  // at t_min
} SceneRay;

static inline SceneRay scene_ray(const CameraRay* camera, MediaStack media) {
  SceneRay ray;
  ray.o = camera->o;
  ray.d = camera->d;
  ray.t_min = camera->t_min;
  ray.t_max = camera->t_max;
  ray.media = media;
  return ray;
}

// Where the ray goes on from a hit: `inside` what it hit, or not.
static inline void start_on_hit(__global const Instance* restrict instances, SceneRay* ray, const Hit* hit,
                                bool inside) {}

// The same for a new ray, whose origin is the hit; `ray` is still the one that hit.
static inline void start_on_surface(__global const SceneInfo* restrict info,
                                    __global const Instance* restrict instances, SceneRay* ray,
                                    const Hit* hit, bool inside) {
  start_on_hit(instances, ray, hit, inside);
}

// The ray goes on behind a surface that it does not see.
static inline void continue_behind(__global const Instance* restrict instances, SceneRay* ray, const Hit* hit,
                                   bool entering) {
  ray->t_min = hit->t;
  start_on_hit(instances, ray, hit, entering);
}

// hits[k] becomes that of rays[which[k]], or of rays[k] where which is 0, k < count; without one, its
// instance is NO_INSTANCE.
static inline void nearest_hits(TRACE_PARAMETERS, SHADE_PARAMETERS, const SceneRay* rays, const u32* which,
                                u32 count, bool coherent, Hit* hits, u32* counts) {
  float3 o[BATCH], d[BATCH];
  float t_min[BATCH], t_max[BATCH];
  for (u32 k = 0; k < count; ++k) {
    const SceneRay* ray = rays + (which ? which[k] : k);
    o[k] = ray->o;
    d[k] = ray->d;
    t_min[k] = ray->t_min;
    t_max[k] = ray->t_max;
  }
  trace_batch(TRACE_ARGUMENTS, o, d, t_min, t_max, count, coherent, hits);
}

// occluded[k] becomes 1 where rays[k] hits anything, else 0, k < count.
static inline void any_hits(TRACE_PARAMETERS, SHADE_PARAMETERS, const SceneRay* rays, u32 count,
                            bool coherent, u32* occluded, u32* counts) {
  float3 o[BATCH], d[BATCH];
  float t_min[BATCH], t_max[BATCH];
  for (u32 k = 0; k < count; ++k) {
    o[k] = rays[k].o;
    d[k] = rays[k].d;
    t_min[k] = rays[k].t_min;
    t_max[k] = rays[k].t_max;
  }
  occluded_batch(TRACE_ARGUMENTS, o, d, t_min, t_max, count, coherent, occluded);
}

#endif
