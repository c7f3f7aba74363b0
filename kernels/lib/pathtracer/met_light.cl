// Light that the rays of paths meet: what shines on surfaces, the sky, and what lies on the way.
#ifndef SUNDOG_LIB_MET_LIGHT_CL
#define SUNDOG_LIB_MET_LIGHT_CL
#include "lib/light/shadow_rays.cl"
#include "lib/pathtracer/walk_state.cl"

#if HAS_AREA_LIGHTS
// What the choice by the tree, from the surfaces walks->from, makes of the density of the light `index`.
#if HAS_LIGHT_TREE
static inline REAL density_in_tree(const Scene* scene, const Walks* walks, u32 index, REAL density,
                                   MASK lanes) {
  REAL chosen = density;
  const REAL3 from = chosen_from(walks);
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    REAL_LANE(chosen, i) *= light_probability(scene, scene->light_leaves[index], get3(&from, i));
  }
  return chosen;
}
#else
static inline REAL density_in_tree(const Scene* scene, const Walks* walks, u32 index, REAL density,
                                   MASK lanes) {
  return density;
}
#endif

// The density with which the places walks->from choose the lights `light` at the points p, which the rays
// met in the directions d.
NEVER_INLINE REAL chosen_density(const Scene* scene, const Walks* walks, REAL3 d, REAL3 p, MASK light,
                                 MASK lanes) {
  const REAL3 way = subtract3(p, walks->from);
  const REAL distance = length3(way);
  REAL density = (REAL)(0.0f);
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(light, &left, &index);
    __global const Light* lamp = scene->lights + index;
    if (lamp->position.w != 0.0f) continue;
    density = select(density, area_light_density(lamp, walks->from, d, distance), mine);
    density = density_in_tree(scene, walks, index, density, mine);
    density = select(density, density_on_stretch(walks, lamp, density), mine);
  }
  return density / (float)scene->info->light_count;
}

// The lights that an instance shows where it was hit: a mesh may have one a triangle.
static inline MASK light_of_instance(const Scene* scene, u32 index, MASK prim) {
  const u32 first = scene->instances[index].light;
  if (first == NO_LIGHT || scene->lights[first].kind != LIGHT_TRIANGLE) return (MASK)((int)first);
  return prim + (int)(first - scene->instances[index].first_prim);
}

// The light of the surfaces of `lanes` with the weight that it has where they are lights to choose, too.
static inline REAL3 weighed_emission(const Scene* scene, const Walks* walks, REAL3 d, const Hits* hits,
                                     const Shading* at, REAL3 light, MASK lanes) {
  MASK lamp = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(at->s.instance, &left, &index);
    lamp = select(lamp, light_of_instance(scene, index, hits->prim), mine);
  }
  const MASK lamps = lanes & MASK_OF(lamp != (int)NO_LIGHT), chosen = lamps & MASK_OF(walks->density > 0.0f);
  const REAL3 left = left_by_photons(walks, light, lamps);
  if (!any_lane(chosen)) return left;
  const REAL weight = weight_of_met(scene, walks, chosen_density(scene, walks, d, at->s.p, lamp, chosen));
  return select3(left, scale3(left, weight), chosen);
}
#else
static inline REAL3 weighed_emission(const Scene* scene, const Walks* walks, REAL3 d, const Hits* hits,
                                     const Shading* at, REAL3 light, MASK lanes) {
  return light;
}
#endif

// What surfaces of `lanes` shine by themselves, on their outsides.
static inline REAL3 met_surface(const Scene* scene, const Walks* walks, const SceneRays* rays,
                                const Hits* hits, const Shading* at, MASK lanes) {
  REAL3 light = all3((float3)(0.0f));
  if (!HAS_EMISSION) return light;
  const MASK shining = of_kind(&at->bsdf, MATERIAL_EMITS, lanes & at->s.entering);
  if (!any_lane(shining)) return light;
  u32 index;
  for (u32 left = lane_bits(shining); left;) {
    const MASK mine = take_alike(at->s.material, &left, &index);
    light = select3(light, all3(scene->materials[index].emission.xyz), mine);
  }
  return weighed_emission(scene, walks, rays->d, hits, at, mapped_emission(&at->bsdf, light), shining);
}

// What rays of `lanes` see that meet nothing: sky_along() with the weight of each part.
static inline REAL3 met_sky(const Scene* scene, const Walks* walks, REAL3 d, MASK lanes) {
  if (!HAS_SKY) return background_along(scene->info, d);
  const float chance = 1.0f / (float)max(scene->info->light_count, 1u);
  const MASK camera = MASK_OF(walks->depth == 1);
  REAL density;
  REAL3 light = distant_along(scene, d, lanes, &density);
  if (sees_environment(scene)) {
    const REAL chosen = density * chance;
    light = scale3(light, weight_of_met(scene, walks, density_on_stretch(walks, 0, chosen)));
    light = hide_environment(scene, d, left_by_photons(walks, light, lanes), camera);
  }
  for (u32 index = 0; index < scene->info->table_lights; ++index) {
    __global const Light* sun = scene->lights + index;
    if (sun->kind != LIGHT_SUN) continue;
    const REAL chosen = density_on_stretch(walks, 0, (REAL)(sun_density(sun, chance)));
    const REAL weight = weight_of_met(scene, walks, chosen);
    const REAL3 seen = left_by_photons(walks, all3(sun->color.xyz), lanes);
    light = select3(light, along3(light, weight, seen), sees_sun(sun, d, camera));
  }
  return light;
}

// The world's fog, for rays of `lanes` that were not inside anything: what it adds, and what it takes from
// all behind it.
static inline Carried met_fog(const Scene* scene, const Encounters* met, MASK lanes, Walks* walks) {
  if (!HAS_FOG) return carry_all(0.0f);
  const REAL clear = clear_of_fog(scene, met, lanes);
  const Carried color = carry_color(&walks->wavelengths, all3(scene->info->fog.xyz));
  const Carried light = carry_multiply(carry_scale(walks->throughput, 1.0f - clear), color);
  walks->throughput = carry_scale(walks->throughput, clear);
  return light;
}

#endif
