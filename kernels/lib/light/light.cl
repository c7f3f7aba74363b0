// Where light comes from: the scene's lights, and what glows by itself. A point or a ray a lane.
#ifndef SUNDOG_LIB_LIGHT_CL
#define SUNDOG_LIB_LIGHT_CL
#include "lib/core/tables.h"
#include "lib/light/area_light.cl"
#include "lib/light/environment.cl"
#include "lib/path/scene_ray.cl"
#include "plain/light/light_sample.cl"

// The way from the points p to a light without extent.
static inline LightSamples way_to_lamp(__global const Light* light, REAL3 p) {
  LightSamples sample;
  sample.pdf = (REAL)(1.0f);
  sample.delta = ALL_LANES;
  sample.radiance = all3(light->color.xyz);
  if (light->kind == LIGHT_DIRECTIONAL) {
    sample.wi = all3(-light->direction.xyz);
    sample.distance = (REAL)(INFINITY);
    return sample;
  }
  const REAL3 to = subtract3(all3(light->position.xyz), p);
  sample.wi = safe_unit3(to);
  const REAL d = dot3(to, sample.wi);
  sample.distance = d;
  if (light->falloff_linear != 0.0f || light->falloff_quadratic != 0.0f || light->falloff_constant != 1.0f) {
    const REAL falloff = fma(light->falloff_quadratic * d, d,
                             fma((REAL)(light->falloff_linear), d, (REAL)(light->falloff_constant)));
    sample.radiance =
        real3(sample.radiance.x / falloff, sample.radiance.y / falloff, sample.radiance.z / falloff);
  }
  if (light->edge_v.x > 0.0f) {  // as KHR_lights_punctual suggests
    const REAL part = d * light->edge_v.x, square = part * part;
    sample.radiance = scale3(sample.radiance, real_max(1.0f - square * square, (REAL)(0.0f)));
  }
  if (light->kind == LIGHT_SPOT) {
    const REAL cosine = -dot3(sample.wi, all3(light->direction.xyz));
    const float outer = light->direction.w, inner = light->color.w;
    const REAL one = (REAL)(1.0f), zero = (REAL)(0.0f);
    const REAL s = inner > outer ? real_clamp((cosine - outer) / (inner - outer), zero, one)
                                 : select(zero, one, MASK_OF(cosine >= outer));
    sample.radiance = scale3(sample.radiance, s * s * (light->edge_u.x - light->edge_u.y * s));
  }
  return sample;
}

// A way from the points p of `lanes` to the light `index`, chosen by the two numbers u in [0, 1)^2, which
// lights without extent leave alone.
static inline LightSamples sample_light(const Scene* scene, u32 index, REAL3 p, REAL u_x, REAL u_y,
                                        MASK lanes) {
  __global const Light* light = scene->lights + index;
  if (HAS_AREA_LIGHTS && light->kind == LIGHT_SUN) return sample_sun(light, u_x, u_y);
  if (HAS_ENVIRONMENT && light->kind == LIGHT_ENVIRONMENT) return sample_environment(scene, u_x, u_y, lanes);
  if (HAS_AREA_LIGHTS && light->kind >= LIGHT_RECTANGLE) return sample_area_light(light, p, u_x, u_y);
  return way_to_lamp(light, p);
}

// Whether rays may meet the light `index`: it is seen, and has an extent.
static inline bool rays_meet(const Scene* scene, u32 index) {
  __global const Light* light = scene->lights + index;
  if (light->kind == LIGHT_ENVIRONMENT) return scene->info->sees_environment != 0u;
  if (light->kind == LIGHT_SUN) return light->direction.w > 0.0f;
  return light->kind >= LIGHT_RECTANGLE && light->position.w == 0.0f;
}

// What the rays have gathered from fields that glow.
#if HAS_GLOW
static inline REAL3 emitted(const SceneRays* rays) { return rays->glow; }
#else
static inline REAL3 emitted(const SceneRays* rays) { return all3((float3)(0.0f)); }
#endif

#endif
