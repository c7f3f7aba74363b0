// Shadow rays from a surface to the lights, left on a stack with the light that each would bring.
#include "plain/light/choose_light.cl"
#include "plain/light/light.cl"
#include "plain/light/ray_to_light.cl"
#include "plain/light/relief_shadow.cl"
#include "plain/light/shadow.cl"
#include "plain/shade/local_light.cl"
#include "plain/whitted/interface.h"

// A way to one of the lights of the tree, which stands for them all. `met`: other rays may meet it.
HAVING(HAS_LIGHT_TREE)
static LightSample choose_among(UNIFORM const Scene* scene, UNIFORM __global const LightRay* way,
                                UNIFORM const TileSamples* tile, const WaitingRay* path, float3 p,
                                bool* met) {
  float u_x, u_y, choice, unused, chance;
  const u32 first = DIMENSIONS_OF_LIGHT(scene->info->table_lights);  // no light's
  bounce_numbers(tile, path, first + BOUNCE_LIGHT_POINT, way->ray, way->rays, &u_x, &u_y);
  bounce_numbers(tile, path, first + BOUNCE_LIGHT_CHOICE, way->ray, way->rays, &choice, &unused);
  const int chosen = choose_light(scene, p, choice, &chance);
  LightSample light = sample_chosen(scene, p, u_x, u_y, chosen, met);
  light.pdf *= chance;
  return light;
}

// The way of the shadow ray `index`: surfaces have 1 a light, or those of the table light_rays. The radiance
// of rays that share a light is divided among them.
static inline LightSample choose_way(UNIFORM const Scene* scene, UNIFORM u32 index,
                                     UNIFORM const TileSamples* tile, const WaitingRay* path, float3 p,
                                     bool* met) {
  *met = false;
  if (!HAS_AREA_LIGHTS) return sample_light(scene, index, p, 0.5f, 0.5f);
  __global const LightRay* way = scene->light_rays + index;
  float u_x = 0.5f, u_y = 0.5f;
  LightSample light;
  if (way->light != LIGHT_CHOSEN) {
    const u32 first = DIMENSIONS_OF_LIGHT(way->light);
    if (has_extent(scene->lights + way->light))
      bounce_numbers(tile, path, first + BOUNCE_LIGHT_POINT, way->ray, way->rays, &u_x, &u_y);
    light = sample_light(scene, way->light, p, u_x, u_y);
    *met = rays_meet(scene, way->light);
  } else if (HAS_LIGHT_TREE) {
    light = choose_among(scene, way, tile, path, p, met);
  }
  light.radiance *= light_weight(&light) / (float)way->rays;
  return light;
}

// Sends a shadow ray to one light, with what that would do at the surface: Ij (kd n.l + ks (r.v)^b) Vj.
ENTRY static inline void cast_shadow(UNIFORM const Scene* scene, UNIFORM u32 index,
                                     UNIFORM const TileSamples* tile, const SceneRay* ray,
                                     const WaitingRay* path, const Encounter* met, const SurfaceShading* at,
                                     UNIFORM u32* counts) {
  const SurfaceInteraction* s = &at->s;
  bool seen;
  const LightSample light = choose_way(scene, index, tile, path, s->p, &seen);
  if (!(dot(s->ns, light.wi) > 0.0f)) return;
  float3 possible = light.radiance * local_light(scene, &at->bsdf, -ray->d, light.wi, seen);
  if (HAS_RELIEF) possible *= terminator(s, light.wi);
  if (HAS_PARALLAX) {
    possible *= relief_visibility(scene, s, light.wi);
    possible *= walls_visibility(scene, ray, s, light.wi, counts);
  }
  // A high power of (r.v) may leave less than the least normal float, which some devices take for zero, or
  // too small a part of the light: not worth a ray.
  const float share = scene->info->cutoff * LEAST_OF_LIGHT * greatest(light.radiance);
  if (!(greatest(possible) >= FLT_MIN && greatest(path->throughput * possible) >= share)) return;
  count(counts, COUNT_SHADOW);
  note_pixel_ray(path->pixel, counts);
  SceneRay to_light = ray_to_light(scene, ray, met, at, &light, false);
  WaitingRay shadow = *path;
  shadow.depth = 0;
  shadow.throughput = path->throughput * possible;
  if (HAS_SOFT_SHADOWS) shadow.throughput *= soft_shadows(scene, &to_light, counts);
  push_shadow(tile, &to_light, &shadow);
}

// Takes a shadow ray through the filter that it has met, or ends it: what reaches the light is added to its
// pixel. Returns whether the ray continues.
ENTRY static inline bool pass_or_end_shadow(UNIFORM const Scene* scene, UNIFORM const TileSamples* tile,
                                            SceneRay* ray, WaitingRay* path, SurfaceHit* hit,
                                            UNIFORM u32* counts) {
  if (HAS_SHADOW_FILTERS) {
    if (pass_filter(scene, ray, hit, &path->throughput, counts)) return !passed_most(ray, counts);
    add_light(tile, path->pixel, path->throughput);
  } else if (!hit_anything(hit)) {
    add_light(tile, path->pixel, unblocked(scene, ray, path->throughput));
  }
  return false;
}
