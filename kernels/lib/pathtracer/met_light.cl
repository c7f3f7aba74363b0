// Light that the rays of paths meet: what shines on surfaces, the sky, and what lies on the way.
#ifndef SUNDOG_LIB_MET_LIGHT_CL
#define SUNDOG_LIB_MET_LIGHT_CL
#include "lib/light/shadow_rays.cl"
#include "lib/pathtracer/walk_state.cl"

// The density with which the surfaces walks->from choose the lights `light` at the points p, which the rays
// met in the directions d.
#if HAS_AREA_LIGHTS
NEVER_INLINE REAL chosen_density(const Scene* scene, const Walks* walks, REAL3 d, REAL3 p, MASK light,
                                 MASK lanes) {
  const REAL3 way = subtract3(p, walks->from);
  const REAL distance = length3(way);
  REAL density = (REAL)(0.0f);
  u32 index;
  for (MASK left = lanes; any_lane(left);) {
    const MASK mine = take_alike(light, &left, &index);
    __global const Light* lamp = scene->lights + index;
    if (lamp->position.w != 0.0f) continue;
    density = select(density, area_light_density(lamp, walks->from, d, distance), mine);
#if HAS_LIGHT_TREE
    for (u32 bits = lane_bits(mine); bits; bits &= bits - 1u) {
      const u32 i = lowest_bit(bits);
      REAL_LANE(density, i) *= light_probability(scene, scene->light_leaves[index], get3(&walks->from, i));
    }
#endif
  }
  return density / (float)scene->info->light_count;
}
#endif

// The lights that an instance shows where it was hit: a mesh may have one a triangle.
static inline MASK light_of_instance(const Scene* scene, u32 index, MASK prim) {
  const u32 first = scene->instances[index].light;
  if (first == NO_LIGHT || scene->lights[first].kind != LIGHT_TRIANGLE) return (MASK)((int)first);
  return prim + (int)(first - scene->instances[index].first_prim);
}

// What surfaces of `lanes` shine by themselves, on their outsides.
static inline REAL3 met_surface(const Scene* scene, const Walks* walks, const SceneRays* rays,
                                const Hits* hits, const Shading* at, MASK lanes) {
  REAL3 light = all3((float3)(0.0f));
#if HAS_EMISSION
  MASK shining = NO_LANES;
  u32 index;
  for (MASK left = lanes & at->s.entering; any_lane(left);) {
    const MASK mine = take_alike(at->s.material, &left, &index);
    const float3 emission = scene->materials[index].emission.xyz;
    light = select3(light, all3(emission), mine);
    if (emission.x + emission.y + emission.z > 0.0f) shining |= mine;
  }
  if (!any_lane(shining)) return light;
#if HAS_MAPS
  light = multiply3(light, at->bsdf.emission);
#endif
#if HAS_AREA_LIGHTS
  MASK lamp = NO_LANES;
  for (MASK left = shining; any_lane(left);) {
    const MASK mine = take_alike(at->s.instance, &left, &index);
    lamp = select(lamp, light_of_instance(scene, index, hits->prim), mine);
  }
  const MASK chosen = shining & MASK_OF(lamp != (int)NO_LIGHT) & MASK_OF(walks->density > 0.0f);
  if (any_lane(chosen)) {
    const REAL weight =
        weight_of_met(scene, walks, chosen_density(scene, walks, rays->d, at->s.p, lamp, chosen));
    light = select3(light, scale3(light, weight), chosen);
  }
#endif
#endif
  return light;
}

// What rays of `lanes` see that meet nothing: sky_along() with the weight of each part.
static inline REAL3 met_sky(const Scene* scene, const Walks* walks, REAL3 d, MASK lanes) {
#if HAS_SKY
  const float chance = 1.0f / (float)max(scene->info->light_count, 1u);
  REAL3 light;
#if HAS_ENVIRONMENT
  if (scene->info->sees_environment) {
    const REAL density = environment_density(scene, d, lanes) * chance;
    light = scale3(environment_along(scene, d, lanes), weight_of_met(scene, walks, density));
  } else
#endif
    light = background_along(scene->info, d);
  for (u32 index = 0; index < scene->info->table_lights; ++index) {
    __global const Light* sun = scene->lights + index;
    if (sun->kind != LIGHT_SUN) continue;
    const REAL3 chord = add3(d, all3(sun->direction.xyz));
    const MASK inside = MASK_OF(dot3(chord, chord) <= 2.0f * sun->direction.w);
    const REAL density = (REAL)(chance / (2.0f * M_PI_F * fabs(sun->direction.w)));
    light = select3(light, along3(light, weight_of_met(scene, walks, density), all3(sun->color.xyz)), inside);
  }
  return light;
#else
  return background_along(scene->info, d);
#endif
}

// The world's fog, for rays of `lanes` that were not inside anything: what it adds, and what it takes from
// all behind it.
static inline Carried met_fog(const Scene* scene, const Encounters* met, MASK lanes, Walks* walks) {
#if HAS_FOG
  const MASK foggy = lanes & MASK_OF(met->before == 0);
  const float4 fog = scene->info->fog;
  const REAL clear = select((REAL)(1.0f), real_exp(-fog.w * met->hit.t), foggy);
  const Carried color = carry_color(&walks->wavelengths, all3(fog.xyz));
  const Carried light = carry_multiply(carry_scale(walks->throughput, 1.0f - clear), color);
  walks->throughput = carry_scale(walks->throughput, clear);
  return light;
#else
  return carry_all(0.0f);
#endif
}

#endif
