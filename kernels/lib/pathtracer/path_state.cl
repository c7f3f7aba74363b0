// What a path carries from surface to surface, and how the two ways of finding light share what both can
// find: lights chosen at a surface, and lights met by its scattered ray (Veach and Guibas 1995, "Optimally
// Combining Sampling Techniques for Monte Carlo Rendering"; the power heuristic). A path a lane.
#ifndef SUNDOG_LIB_PATH_STATE_CL
#define SUNDOG_LIB_PATH_STATE_CL
#include "lib/light/choose_light.cl"
#include "lib/light/light.cl"
#include "lib/pathtracer/media_stretch.cl"
#include "lib/pathtracer/sampled_spectrum.cl"

typedef struct PathStates {
  SampledSpectrum throughput;
  SampledSpectrum radiance;  // gathered so far
  REAL3 from;                // the place that chose the ray's direction, with the density `pdf`
  REAL pdf;                  // 0: no light that is chosen at surfaces counts twice on this ray
  // The factor of the throughput that says nothing of the path's worth: radiance spread by refraction since
  // the camera (squared index by squared index), and paths drawn to guides.
  REAL spread;
  MASK depth;     // of the ray: the camera's has 1
  MASK covered;   // the path has not left the scene straight on from the camera
  MASK straight;  // the ray goes straight on from the camera
  LaneSamples at;
  SampledWavelengths wavelengths;
#if HAS_CAUSTICS
  MASK gathered;  // GATHERED_*
  REAL3 narrow;   // the part of the throughput that is of narrow lobes of the surface that gathered
#endif
#if HAS_SCATTERING
  Scattered scattered;  // the density is then that of the place on the stretch and of the direction
#endif
} PathStates;

// What a stretch makes of the density with which its light `lamp` is chosen: in place of a surface a place on
// it is chosen, too. For distant lights `lamp` is 0.
#if HAS_SCATTERING
static inline REAL pdf_on_stretch(const PathStates* paths, __global const Light* lamp, REAL pdf) {
  const Scattered* s = &paths->scattered;
  REAL chance = s->chance;
  if (lamp) {
    const SeenStretch seen = see_stretch(s->o, s->d, s->length, s->decay, middle_of_light(lamp));
    chance = pdf_towards(&seen, s->at, chance);
  }
  return select(pdf, pdf * chance, s->lanes);
}
// The places for which lights of the tree were chosen.
static inline REAL3 chosen_from(const PathStates* paths) {
  const Scattered* s = &paths->scattered;
  return select3(paths->from, place_for_lights(s->o, s->d, s->length, s->decay), s->lanes);
}
static inline void join_stretch(PathStates* paths, const Scattered* other, MASK lanes) {
  Scattered* s = &paths->scattered;
  s->lanes = select(s->lanes, other->lanes, lanes);
  s->o = select3(s->o, other->o, lanes);
  s->d = select3(s->d, other->d, lanes);
  s->length = select(s->length, other->length, lanes);
  s->at = select(s->at, other->at, lanes);
  s->decay = select(s->decay, other->decay, lanes);
  s->chance = select(s->chance, other->chance, lanes);
}
static inline void join_scattered(PathStates* paths, const PathStates* other, MASK lanes) {
  join_stretch(paths, &other->scattered, lanes);
}
static inline void leave_stretch(PathStates* paths, MASK lanes) { paths->scattered.lanes &= ~lanes; }
static inline void forget_stretches(PathStates* paths) {
  const REAL zero = (REAL)(0.0f);
  const REAL3 none = all3((float3)(0.0f));
  const Scattered nowhere = {NO_LANES, none, none, zero, zero, zero, zero};
  paths->scattered = nowhere;
}
#else
static inline REAL pdf_on_stretch(const PathStates* paths, __global const Light* lamp, REAL pdf) {
  return pdf;
}
static inline REAL3 chosen_from(const PathStates* paths) { return paths->from; }
static inline void join_scattered(PathStates* paths, const PathStates* other, MASK lanes) {}
static inline void leave_stretch(PathStates* paths, MASK lanes) {}
static inline void forget_stretches(PathStates* paths) {}
#endif

// Light that photons have brought to a path's last surface, which it must not meet again through what has
// mirrored or bent it since: the lights that photons leave. Narrow lobes do not get it from photons.
#if HAS_CAUSTICS
#define GATHERED_NOTHING 0
#define GATHERED_HERE 1    // at the surface that the ray leaves, or before interfaces that let it pass
#define GATHERED_BEFORE 2  // at one before it; the ray was mirrored or bent since
static inline void forget_gathered(PathStates* paths, MASK lanes) {
  paths->gathered = select(paths->gathered, (MASK)(GATHERED_NOTHING), lanes);
  paths->narrow = select3(paths->narrow, all3((float3)(0.0f)), lanes);
}
static inline void join_gathered(PathStates* paths, const PathStates* other, MASK lanes) {
  paths->gathered = select(paths->gathered, other->gathered, lanes);
  paths->narrow = select3(paths->narrow, other->narrow, lanes);
}
// The paths of `turns` leave surfaces that have gathered photons, unless they are mirrored or bent there;
// `narrow` is the part of their weights by narrow lobes.
static inline void note_gathered(PathStates* paths, MASK specular, REAL3 narrow, MASK turns) {
  const MASK before =
      select((MASK)(GATHERED_NOTHING), (MASK)(GATHERED_BEFORE), MASK_OF(paths->gathered != GATHERED_NOTHING));
  paths->gathered = select(paths->gathered, select((MASK)(GATHERED_HERE), before, specular), turns);
  paths->narrow = select3(paths->narrow, narrow, turns & ~specular);
}
static inline MASK found_by_photons(const PathStates* paths) {
  return MASK_OF(paths->gathered == GATHERED_BEFORE);
}
static inline REAL3 left_by_photons(const PathStates* paths, REAL3 light, MASK lanes) {
  return select3(light, multiply3(light, paths->narrow), lanes & found_by_photons(paths));
}
#else
static inline void forget_gathered(PathStates* paths, MASK lanes) {}
static inline void join_gathered(PathStates* paths, const PathStates* other, MASK lanes) {}
static inline void note_gathered(PathStates* paths, MASK specular, REAL3 narrow, MASK turns) {}
static inline REAL3 left_by_photons(const PathStates* paths, REAL3 light, MASK lanes) { return light; }
#endif

// The first dimension of the numbers from `offset` (BOUNCE_...) on of the surfaces that the rays meet.
static inline MASK dimension_here(const PathStates* paths, u32 offset) {
  return (paths->depth - 1) * (int)DIMENSIONS_A_BOUNCE + (int)(DIMENSION_BOUNCE + offset);
}

// Light of a colour that a path has met, as it gets to the camera.
static inline SampledSpectrum carried_color(const PathStates* paths, REAL3 color) {
  return spectrum_multiply(paths->throughput, spectrum_of(&paths->wavelengths, color));
}

#include "plain/pathtracer/mis.cl"

#endif
