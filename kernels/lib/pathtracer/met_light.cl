// Light that the rays of paths meet: what shines on surfaces, the sky, and what lies on the way.
#ifndef SUNDOG_LIB_MET_LIGHT_CL
#define SUNDOG_LIB_MET_LIGHT_CL
#include "lib/light/shadow_rays.cl"
#include "lib/pathtracer/path_state.cl"

#if HAS_AREA_LIGHTS
// What the choice by the tree, from the surfaces paths->from, makes of the density of the light `index`.
#if HAS_LIGHT_TREE
static inline REAL pdf_in_tree(const Scene* scene, const PathStates* paths, u32 index, REAL pdf, MASK lanes) {
  REAL chosen = pdf;
  const REAL3 from = chosen_from(paths);
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    REAL_LANE(chosen, i) *= light_probability(scene, scene->light_leaves[index], get3(&from, i));
  }
  return chosen;
}
#else
static inline REAL pdf_in_tree(const Scene* scene, const PathStates* paths, u32 index, REAL pdf, MASK lanes) {
  return pdf;
}
#endif

// The density with which the places paths->from choose the lights `light` at the points p, which the rays
// met in the directions d.
NEVER_INLINE REAL chosen_pdf(const Scene* scene, const PathStates* paths, REAL3 d, REAL3 p, MASK light,
                             MASK lanes) {
  const REAL3 way = subtract3(p, paths->from);
  const REAL distance = length3(way);
  REAL pdf = (REAL)(0.0f);
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(light, &left, &index);
    __global const Light* lamp = scene->lights + index;
    if (lamp->position.w != 0.0f) continue;
    pdf = select(pdf, area_light_pdf(lamp, paths->from, d, distance), mine);
    pdf = pdf_in_tree(scene, paths, index, pdf, mine);
    pdf = select(pdf, pdf_on_stretch(paths, lamp, pdf), mine);
  }
  return pdf / (float)scene->info->light_count;
}

// The lights that an instance shows where it was hit: a mesh may have one a triangle.
static inline MASK light_of_instance(const Scene* scene, u32 index, MASK prim) {
  const u32 first = scene->instances[index].light;
  if (first == NO_LIGHT || scene->lights[first].kind != LIGHT_TRIANGLE) return (MASK)((int)first);
  return prim + (int)(first - scene->instances[index].first_prim);
}

// The light of the surfaces of `lanes` with the weight that it has where they are lights to choose, too.
static inline REAL3 weighed_emission(const Scene* scene, const PathStates* paths, REAL3 d, const Hits* hits,
                                     const Shading* at, REAL3 light, MASK lanes) {
  MASK lamp = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(at->s.instance, &left, &index);
    lamp = select(lamp, light_of_instance(scene, index, hits->prim), mine);
  }
  const MASK lamps = lanes & MASK_OF(lamp != (int)NO_LIGHT), chosen = lamps & MASK_OF(paths->pdf > 0.0f);
  const REAL3 left = left_by_photons(paths, light, lamps);
  if (!any_lane(chosen)) return left;
  const REAL weight = weight_of_met(scene, paths, chosen_pdf(scene, paths, d, at->s.p, lamp, chosen));
  return select3(left, scale3(left, weight), chosen);
}
#else
static inline REAL3 weighed_emission(const Scene* scene, const PathStates* paths, REAL3 d, const Hits* hits,
                                     const Shading* at, REAL3 light, MASK lanes) {
  return light;
}
#endif

// What surfaces of `lanes` shine by themselves, on their outsides.
static inline REAL3 met_surface(const Scene* scene, const PathStates* paths, const SceneRays* rays,
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
  return weighed_emission(scene, paths, rays->d, hits, at, mapped_emission(&at->bsdf, light), shining);
}

// What rays of `lanes` see that meet nothing: sky_along() with the weight of each part.
static inline REAL3 met_sky(const Scene* scene, const PathStates* paths, REAL3 d, MASK lanes) {
  if (!HAS_SKY) return background_along(scene->info, d);
  const float chance = 1.0f / (float)max(scene->info->light_count, 1u);
  const MASK camera = MASK_OF(paths->depth == 1);
  REAL pdf;
  REAL3 light = distant_along(scene, d, lanes, &pdf);
  if (sees_environment(scene)) {
    const REAL chosen = pdf * chance;
    light = scale3(light, weight_of_met(scene, paths, pdf_on_stretch(paths, 0, chosen)));
    light = hide_environment(scene, d, left_by_photons(paths, light, lanes), camera);
  }
  for (u32 index = 0; index < scene->info->table_lights; ++index) {
    __global const Light* sun = scene->lights + index;
    if (sun->kind != LIGHT_SUN) continue;
    const REAL chosen = pdf_on_stretch(paths, 0, (REAL)(sun_pdf(sun, chance)));
    const REAL weight = weight_of_met(scene, paths, chosen);
    const REAL3 seen = left_by_photons(paths, all3(sun->color.xyz), lanes);
    light = select3(light, along3(light, weight, seen), sees_sun(sun, d, camera));
  }
  return light;
}

// The world's fog, for rays of `lanes` that were not inside anything: what it adds, and what it takes from
// all behind it.
static inline SampledSpectrum met_fog(const Scene* scene, const Encounters* met, MASK lanes,
                                      PathStates* paths) {
  if (!HAS_FOG) return spectrum_all(0.0f);
  const REAL clear = clear_of_fog(scene, met, lanes);
  const SampledSpectrum color = spectrum_of(&paths->wavelengths, all3(scene->info->fog.xyz));
  const SampledSpectrum light = spectrum_multiply(spectrum_scale(paths->throughput, 1.0f - clear), color);
  paths->throughput = spectrum_scale(paths->throughput, clear);
  return light;
}

#endif
