// Shadow rays from surfaces to the lights, left on a stack with the light that each would bring.
#pragma once
#include "lib/light/choose_light.cl"
#include "lib/light/field_light.cl"
#include "lib/light/light.cl"
#include "lib/light/relief_shadow.cl"
#include "lib/light/shading.cl"
#include "lib/path/path_samples.cl"
#include "lib/path/ray_counts.cl"
#include "lib/path/ray_stack.cl"
#include "lib/shade/relief.cl"
#include "plain/shade/local_light.cl"

#if HAS_LIGHT_TREE
// A way to one of the lights of the tree for each point, for which it stands with all its light. Other rays
// may meet those of `met`.
NEVER_INLINE LightSamples choose_among(const Scene* scene, const LightRay* way, const TileSamples* tile,
                                       const WaitingRays* paths, REAL3 p, MASK lanes, MASK* met) {
  REAL u_x, u_y, choice, unused, chance;
  const u32 turn = scene->info->table_lights;  // of the lights whose numbers these are: none's
  bounce_numbers(tile, paths, turn, BOUNCE_LIGHT_POINT, way->ray, way->rays, lanes, &u_x, &u_y);
  bounce_numbers(tile, paths, turn, BOUNCE_LIGHT_CHOICE, way->ray, way->rays, lanes, &choice, &unused);
  const MASK chosen = choose_lights(scene, p, choice, lanes, &chance);
  LightSamples light;
  light.wi = all3((float3)(0.0f));
  light.distance = (REAL)(0.0f);
  light.radiance = all3((float3)(0.0f));
  light.pdf = (REAL)(1.0f);
  light.delta = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(chosen, &left, &index);
    const LightSamples one = sample_light(scene, index, p, u_x, u_y, mine);
    light.wi = select3(light.wi, one.wi, mine);
    light.distance = select(light.distance, one.distance, mine);
    light.radiance = select3(light.radiance, one.radiance, mine);
    light.pdf = select(light.pdf, one.pdf * chance, mine);
    if (rays_meet(scene, index)) *met |= mine;
  }
  light.radiance = scale3(light.radiance, light_weight(&light, lanes) / (float)way->rays);
  return light;
}
#endif

// The way of the shadow ray `index` from the surfaces of `lanes`, which have 1 a light, or those of the table
// light_rays. The radiance of rays that share a light is divided among them. Other rays may meet the lights
// of `met`.
static inline LightSamples choose_way(const Scene* scene, u32 index, const TileSamples* tile,
                                      const WaitingRays* paths, REAL3 p, MASK lanes, MASK* met) {
  const REAL middle = (REAL)(0.5f);
  *met = NO_LANES;
  if (!HAS_AREA_LIGHTS) return sample_light(scene, index, p, middle, middle, lanes);
  const LightRay way = scene->light_rays[index];
  HAVING(HAS_LIGHT_TREE,
         if (way.light == LIGHT_CHOSEN) return choose_among(scene, &way, tile, paths, p, lanes, met);)
  if (rays_meet(scene, way.light)) *met = lanes;
  REAL u_x = middle, u_y = middle;
  if (has_extent(scene->lights + way.light))
    bounce_numbers(tile, paths, way.light, BOUNCE_LIGHT_POINT, way.ray, way.rays, lanes, &u_x, &u_y);
  LightSamples light = sample_light(scene, way.light, p, u_x, u_y, lanes);
  light.radiance = scale3(light.radiance, light_weight(&light, lanes) / (float)way.rays);
  return light;
}

// Sends shadow rays from the surfaces of `lanes` to one light, with what it would do there: Ij (kd n.l +
// ks (r.v)^b) Vj.
static inline void cast_shadows(const Scene* scene, u32 index, const TileSamples* tile, const SceneRays* rays,
                                const WaitingRays* paths, MASK lanes, const Hits* hits, const Shading* at,
                                ShadowStack* stack, u32* counts) {
  const SurfaceInteractions* s = &at->s;
  MASK met;
  const LightSamples light = choose_way(scene, index, tile, paths, s->p, lanes, &met);
  const MASK facing = lanes & MASK_OF(dot3(s->ns, light.wi) > 0.0f);
  if (!any_lane(facing)) return;
  const REAL3 wo = negate3(rays->d);
  REAL3 possible = multiply3(light.radiance, local_light(scene, &at->bsdf, wo, light.wi, met, facing));
  HAVING(HAS_RELIEF, possible = scale3(possible, terminator(s, light.wi));)
  HAVING(HAS_PARALLAX, possible = scale3(possible, relief_visibility(scene, s, light.wi, facing));)
  HAVING(HAS_PARALLAX,
         possible = scale3(possible, walls_visibility(scene, rays, s, light.wi, facing, counts));)
  // A high power of (r.v) may leave less than the least normal float, which some devices take for zero, or
  // too small a part of the light: not worth a ray.
  const REAL share = scene->info->cutoff * LEAST_OF_LIGHT * greatest3(light.radiance);
  const MASK lit = facing & MASK_OF(greatest3(possible) >= FLT_MIN) &
                   MASK_OF(greatest3(multiply3(paths->throughput, possible)) >= share);
  if (!any_lane(lit)) return;
  counts[COUNT_SHADOW] += lane_count(lit);
  note_rays(paths->pixel, lit, counts);
  SceneRays to_light = *rays;
  start_on_surfaces(scene->info, &to_light, hits, ~s->entering, lit);
  REAL way;
  to_light.o = along3(leave_relief(s, light.wi, &way), s->offset + s->lift, leaving_normal(s));
  to_light.d = light.wi;
  to_light.t_min = (REAL)(0.0f);
  to_light.t_max = light.distance - way;
  WaitingRays weights = *paths;
  weights.depth = NO_LANES;
  weights.throughput = multiply3(paths->throughput, possible);
  HAVING(HAS_SOFT_SHADOWS,
         weights.throughput = scale3(weights.throughput, soft_shadows(scene, &to_light, lit, counts));)
  push_shadows(stack, &to_light, &weights, lit);
}
