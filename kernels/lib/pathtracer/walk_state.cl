// What a path carries from surface to surface, and how the two ways of finding light share what both can
// find: lights chosen at a surface, and lights met by its scattered ray (Veach and Guibas 1995, "Optimally
// Combining Sampling Techniques for Monte Carlo Rendering"; the power heuristic). A path a lane.
#ifndef SUNDOG_LIB_WALK_STATE_CL
#define SUNDOG_LIB_WALK_STATE_CL
#include "lib/core/sampler_lanes.cl"
#include "lib/light/choose_light.cl"
#include "lib/light/light.cl"
#include "lib/pathtracer/carried.cl"

typedef struct Walks {
  Carried throughput;
  Carried light;  // gathered so far
  REAL3 from;     // the surface that chose the ray's direction, with the density `density`
  REAL density;   // 0: no light that is chosen at surfaces counts twice on this ray
  // The factor of the throughput that says nothing of the path's worth: radiance spread by refraction since
  // the camera (squared index by squared index), and paths drawn to guides.
  REAL spread;
  MASK depth;  // of the ray: the camera's has 1
  MASK met;    // the camera's ray has hit something
  LaneSamples at;
  Wavelengths wavelengths;
} Walks;

// Light of a colour that a path has met, as it gets to the camera.
static inline Carried carried_color(const Walks* walks, REAL3 color) {
  return carry_multiply(walks->throughput, carry_color(&walks->wavelengths, color));
}

// The weight of a sample of density `own` where another way finds the same light with density `other`.
static inline REAL power_heuristic(REAL own, REAL other) {
  const REAL ratio = other / real_max(own, (REAL)(1e-30f));
  return 1.0f / fma(ratio, ratio, (REAL)(1.0f));
}

// The weight of light that a ray has met, which its surface would have chosen with the density `chosen`.
static inline REAL weight_of_met(const Scene* scene, const Walks* walks, REAL chosen) {
  const REAL one = (REAL)(1.0f);
  const MASK found_twice = MASK_OF(walks->density > 0.0f) & MASK_OF(chosen > 0.0f);
  if (scene->info->light_strategy == STRATEGY_SURFACES) return one;
  const REAL shared =
      scene->info->light_strategy == STRATEGY_LIGHTS ? (REAL)(0.0f) : power_heuristic(walks->density, chosen);
  return select(one, shared, found_twice);
}

// The weight of a light that a surface has chosen with the density `chosen`, which its scattered ray would
// have met with the density `scattered`; 0: never.
static inline REAL weight_of_chosen(const Scene* scene, REAL chosen, REAL scattered) {
  const MASK found_twice = MASK_OF(scattered > 0.0f);
  const REAL one = (REAL)(1.0f);
  if (scene->info->light_strategy == STRATEGY_LIGHTS) return one;
  const REAL shared =
      scene->info->light_strategy == STRATEGY_SURFACES ? (REAL)(0.0f) : power_heuristic(chosen, scattered);
  return select(one, shared, found_twice);
}

#endif
