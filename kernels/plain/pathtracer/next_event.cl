// Light chosen for a place on a path: one light, a place on it, and a shadow ray there.
#include "plain/light/choose_light.cl"
#include "plain/pathtracer/mis.cl"
#include "plain/pathtracer/spectrum.cl"

// One of the lights for the point p, by the number u in [0, 1), and the chance that it is chosen with.
static inline int choose_index(UNIFORM const Scene* scene, float3 p, float u, float* chance) {
  const float count = (float)scene->info->light_count, turn = u * count;
  const float slot = real_min(floor(turn), count - 1.0f);
  int chosen = 0;
  EACH_ALIKE(int, index, (int)slot) chosen = (int)scene->light_rays[index].light;
  *chance = 1.0f / count;
  if (HAS_LIGHT_TREE && chosen == (int)LIGHT_CHOSEN) {
    float probability;
    chosen = choose_light(scene, p, turn - slot, &probability);
    *chance *= probability;
  }
  return chosen;
}

// The group of a light.
HAVING(HAS_LIGHT_GROUPS)
static inline int group_of(UNIFORM const Scene* scene, int chosen) {
  int group = NO_LIGHT_GROUP;
  EACH_ALIKE(int, index, chosen) group = (int)scene->lights[index].color.w;
  return group;
}

// A way to one of the lights for the point p, `chosen`, with its density among all.
static inline LightSample choose_one(UNIFORM const Scene* scene, float3 p, const Numbers* u, int* chosen,
                                     bool* seen) {
  float chance;
  *chosen = choose_index(scene, p, u->z, &chance);
  LightSample light = sample_chosen(scene, p, u->x, u->y, *chosen, seen);
  // A delta light's pdf is the chance of the light alone: it has no density of directions.
  light.pdf *= chance;
  return light;
}

// The part of `light` that arrives at the end of a shadow ray.
static inline SampledSpectrum arriving_spectrum(UNIFORM const Scene* scene, const SampledWavelengths* w,
                                                SceneRay* ray, SampledSpectrum light, UNIFORM u32* counts) {
  if (HAS_DISPERSION) {
    const float3 kept = light_arriving(scene, ray, (float3)(1.0f), counts);
    return greatest(kept) > 0.0f ? light * spectrum_kept(w, kept) : (SampledSpectrum)(0.0f);
  } else {
    return spectrum_of(w, light_arriving(scene, ray, (float3)(light.x, light.y, light.z), counts));
  }
}
