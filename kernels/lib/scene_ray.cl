// A ray on its way through the scene, with what travels along, and how it starts again from what it met.
#ifndef SUNDOG_LIB_SCENE_RAY_CL
#define SUNDOG_LIB_SCENE_RAY_CL
#include "lib/camera.cl"
#include "lib/config.h"
#include "lib/media.cl"
#include "lib/tables.h"

#define FROM_NOWHERE 0xFFFFFFFFu

// A ray in world space with what travels along.
typedef struct SceneRay {
  float3 o, d;  // d unit
  float t_min, t_max;
  MediaStack media;  // at t_min
#if HAS_SDF
  u32 from;         // the field that it starts on: instance * 2, plus 1 inside of it; else FROM_NOWHERE
  float footprint;  // of the pixel at o, in world units
#endif
#if HAS_GLOW
  float3 glow;  // gathered from fields that it passed
#endif
} SceneRay;

static inline SceneRay scene_ray(const CameraRay* camera, MediaStack media) {
  SceneRay ray;
  ray.o = camera->o;
  ray.d = camera->d;
  ray.t_min = camera->t_min;
  ray.t_max = camera->t_max;
  ray.media = media;
#if HAS_SDF
  ray.from = FROM_NOWHERE;
  ray.footprint = 0.0f;
#endif
#if HAS_GLOW
  ray.glow = (float3)(0.0f);
#endif
  return ray;
}

// Where the ray goes on from a hit: `inside` what it hit, or not.
static inline void start_on_hit(__global const Instance* restrict instances, SceneRay* ray, const Hit* hit,
                                bool inside) {
#if HAS_SDF
  ray->from =
      instances[hit->instance].shape == SHAPE_SDF ? hit->instance * 2u + (inside ? 1u : 0u) : FROM_NOWHERE;
#endif
}

// The same for a new ray, whose origin is the hit; `ray` is still the one that hit.
static inline void start_on_surface(__global const SceneInfo* restrict info,
                                    __global const Instance* restrict instances, SceneRay* ray,
                                    const Hit* hit, bool inside) {
#if HAS_SDF
  ray->footprint += hit->t * pixel_spread(info);
#endif
#if HAS_GLOW
  ray->glow = (float3)(0.0f);
#endif
  start_on_hit(instances, ray, hit, inside);
}

// The ray goes on behind a surface that it does not see.
static inline void continue_behind(__global const Instance* restrict instances, SceneRay* ray, const Hit* hit,
                                   bool entering) {
  ray->t_min = hit->t;
  start_on_hit(instances, ray, hit, entering);
}

#endif
