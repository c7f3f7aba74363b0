// How lights chosen at a surface, and lights met by its scattered ray, share what both can find (Veach and
// Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo Rendering"; the power heuristic).
#include "plain/pathtracer/path_state.cl"

// The weight of a sample of density `own` where another way finds the same light with density `other`.
static inline float power_heuristic(float own, float other) {
  const float ratio = other / real_max(own, 1e-30f);
  return 1.0f / fma(ratio, ratio, 1.0f);
}

// The weight of light that a ray has met, which its surface would have chosen with the density `chosen`. Fog
// dims what rays see, but no shadow rays, so neither this light.
static inline float weight_of_met(UNIFORM const Scene* scene, const PathState* path, float chosen) {
  float whole = 1.0f;
  if (HAS_FOG) whole = path->pdf > 0.0f ? path->unfog : 1.0f;
  if (scene->info->light_strategy == STRATEGY_SURFACES) return whole;
  const bool found_twice = path->pdf > 0.0f && chosen > 0.0f;
  const float shared =
      scene->info->light_strategy == STRATEGY_LIGHTS ? 0.0f : power_heuristic(path->pdf, chosen);
  return found_twice ? whole * shared : 1.0f;
}

// The weight of a light that a surface has chosen with the density `chosen`, which its scattered ray would
// have met with the density `scattered`; 0: never.
static inline float weight_of_chosen(UNIFORM const Scene* scene, float chosen, float scattered) {
  if (scene->info->light_strategy == STRATEGY_LIGHTS) return 1.0f;
  const float shared =
      scene->info->light_strategy == STRATEGY_SURFACES ? 0.0f : power_heuristic(chosen, scattered);
  return scattered > 0.0f ? shared : 1.0f;
}
