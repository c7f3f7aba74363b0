// Light chosen at the surfaces of paths: one light each, a place on it, and a shadow ray there.
#ifndef SUNDOG_LIB_NEXT_EVENT_CL
#define SUNDOG_LIB_NEXT_EVENT_CL
#include "lib/light/shadow.cl"
#include "lib/light/shadow_rays.cl"
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/guides.cl"
#include "lib/pathtracer/path_state.cl"
#include "lib/shade/bsdf_sample.cl"

// The lanes of `lanes` that drew the tree's lights choose one of them, by the number u in [0, 1); its
// probability goes into the chance that they chose it with.
#if HAS_LIGHT_TREE
static inline void choose_in_tree(const Scene* scene, REAL3 p, REAL u, MASK lanes, MASK* chosen,
                                  REAL* chance) {
  const MASK among = lanes & MASK_OF(*chosen == (int)LIGHT_CHOSEN);
  if (!any_lane(among)) return;
  REAL probability;
  const MASK leaf = choose_lights(scene, p, u, among, &probability);
  *chosen = select(*chosen, leaf, among);
  *chance = select(*chance, *chance * probability, among);
}
#else
static inline void choose_in_tree(const Scene* scene, REAL3 p, REAL u, MASK lanes, MASK* chosen,
                                  REAL* chance) {}
#endif

// One of the lights for each of the points p, and the chance that it is chosen with.
static inline MASK choose_index(const Scene* scene, REAL3 p, REAL u, MASK lanes, REAL* chance) {
  const REAL count = (REAL)((float)scene->info->light_count), turn = u * count;
  const REAL slot = real_min(floor(turn), count - 1.0f);
  const MASK slots = TO_MASK(slot);
  MASK chosen = NO_LANES;
  *chance = 1.0f / count;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(slots, &left, &index);
    chosen = select(chosen, (MASK)((int)scene->light_rays[index].light), mine);
  }
  choose_in_tree(scene, p, turn - slot, lanes, &chosen, chance);
  return chosen;
}

// A way from the points p to their lights; `seen`: rays may meet it.
static inline LightSamples sample_chosen(const Scene* scene, REAL3 p, REAL u_x, REAL u_y, MASK chosen,
                                         MASK lanes, MASK* seen) {
  LightSamples light;
  u32 index;
  light.wi = all3((float3)(0.0f));
  light.distance = (REAL)(0.0f);
  light.radiance = all3((float3)(0.0f));
  light.pdf = (REAL)(1.0f);
  light.delta = NO_LANES;
  *seen = NO_LANES;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(chosen, &left, &index);
    const LightSamples one = sample_light(scene, index, p, u_x, u_y, mine);
    light.wi = select3(light.wi, one.wi, mine);
    light.distance = select(light.distance, one.distance, mine);
    light.radiance = select3(light.radiance, one.radiance, mine);
    light.pdf = select(light.pdf, one.pdf, mine);
    light.delta = select(light.delta, one.delta, mine);
    if (rays_meet(scene, index)) *seen |= mine;
  }
  return light;
}

// A way to one of the lights for each of the points p, with its density among all.
static inline LightSamples choose_one(const Scene* scene, REAL3 p, const FourNumbers* u, MASK lanes,
                                      MASK* seen) {
  REAL chance;
  const MASK chosen = choose_index(scene, p, u->z, lanes, &chance);
  LightSamples light = sample_chosen(scene, p, u->x, u->y, chosen, lanes, seen);
  // Of a delta light the chance counts for the light, not for a direction.
  light.pdf *= chance;
  return light;
}

// The part of `light` that arrives at the ends of shadow rays.
#if HAS_DISPERSION
static inline SampledSpectrum arriving_spectrum(const Scene* scene, const SampledWavelengths* w,
                                                SceneRays* rays, SampledSpectrum light, MASK lanes,
                                                u32* counts) {
  const REAL3 kept = light_arriving(scene, rays, all3((float3)(1.0f)), lanes, counts);
  const MASK some = MASK_OF(greatest3(kept) > 0.0f);
  return spectrum_select(spectrum_all(0.0f), spectrum_multiply(light, spectrum_kept(w, kept)), some);
}
#else
static inline SampledSpectrum arriving_spectrum(const Scene* scene, const SampledWavelengths* w,
                                                SceneRays* rays, SampledSpectrum light, MASK lanes,
                                                u32* counts) {
  return light_arriving(scene, rays, light, lanes, counts);
}
#endif

#endif
