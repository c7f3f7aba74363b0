// The state of a path between two surfaces.
#include "plain/pathtracer/interface.h"
#include "plain/pathtracer/medium_distances.cl"
#include "plain/pathtracer/spectrum.cl"
#include "shared/light_parts.h"

// Light that photons have brought to a path's last surface, which it must not meet again through what has
// mirrored or bent it since: the lights that photons leave. Narrow lobes do not get it from photons.
#define GATHERED_NOTHING 0
#define GATHERED_HERE 1    // at the surface that the ray leaves, or before interfaces that let it pass
#define GATHERED_BEFORE 2  // at one before it; the ray was mirrored or bent since

#define SPECTRUM_OF_PART(name) SampledSpectrum name;

// The light gathered so far, in parts.
typedef struct LightParts {
  LIGHT_PARTS(SPECTRUM_OF_PART)
} LightParts;

// Shares of scattered light by the kind of lobe: the `medium` has all or none of it; else a diffuse and a
// transmitted share, and the rest is glossy.
typedef struct LobeShares {
  SampledSpectrum diffuse, transmitted;
  bool medium;
} LobeShares;

typedef struct PathState {
  SampledSpectrum throughput;
  SampledSpectrum radiance;  // gathered so far
  float3 from;               // the place that chose the ray's direction, with the density `pdf`
  float pdf;                 // 0: from the camera or a perfect lobe; lights that the ray meets count in full
  // For Russian roulette alone: undoes eta^2 of refractions since the camera, and the weights of guides.
  float spread;
  int depth;                              // of the ray: the camera's has 1
  HAVING(HAS_SHADOW_FILTERS) int passed;  // surfaces, straight on, that shadow rays pass, too
  bool straight;  // the ray goes straight on from the camera, or has left the scene so
  SampleAt at;
  SampledWavelengths wavelengths;
  HAVING(HAS_FOG) float unfog;                // undoes the fog since `from`
  HAVING(HAS_CAUSTICS) int gathered;          // GATHERED_*
  HAVING(HAS_CAUSTICS) float3 narrow;         // the part of the throughput by narrow lobes of what gathered
  HAVING(HAS_MATTES) float clear;             // of the background, straight on, behind its last surface
  HAVING(HAS_MATTES) float matte;             // what the last surface or medium took
  HAVING(HAS_MATTES) int instance, material;  // of that surface or medium
  HAVING(HAS_LIGHT_SUMS) LightParts parts;
  HAVING(HAS_LIGHT_PARTS) int scatterings;     // since the camera, without straight ways through surfaces
  HAVING(HAS_LIGHT_PARTS) LobeShares shares;   // at the first of them
  HAVING(HAS_SCATTERING) Scattered scattered;  // the density is then of the place there and of the direction
} PathState;

static inline void forget_gathered(PathState* path) {
  if (HAS_CAUSTICS) {
    path->gathered = GATHERED_NOTHING;
    path->narrow = (float3)(0.0f);
  }
}

ENTRY static inline PathState start_path(UNIFORM const Scene* scene, const SampleAt* at) {
  PathState path;
  path.throughput = (SampledSpectrum)(1.0f);
  path.radiance = (SampledSpectrum)(0.0f);
  path.from = (float3)(0.0f);
  path.pdf = 0.0f;
  path.spread = 1.0f;
  path.depth = 1;
  if (HAS_SHADOW_FILTERS) path.passed = 0;
  path.straight = true;
  path.at = *at;
  path.wavelengths = choose_wavelengths(scene, at);
  if (HAS_FOG) path.unfog = 1.0f;
  if (HAS_SCATTERING) path.scattered.is = false;
  if (HAS_MATTES) {
    path.clear = 1.0f;
    path.matte = 0.0f;
    path.instance = (int)NO_INSTANCE;
    path.material = 0;
  }
#define CLEAR_PART(name) path.parts.name = (SampledSpectrum)(0.0f);
  if (HAS_LIGHT_SUMS) {
    LIGHT_PARTS(CLEAR_PART)
  }
  if (HAS_LIGHT_PARTS) {
    path.scatterings = 0;
    path.shares.diffuse = (SampledSpectrum)(0.0f);
    path.shares.transmitted = (SampledSpectrum)(0.0f);
    path.shares.medium = false;
  }
  forget_gathered(&path);
  return path;
}

// The part of the background that the path shows, straight on: what is left of it, not what a camera in a
// medium sees it brighter.
static inline float clear_part(const PathState* path) {
  return spectrum_mean(path->throughput) * path->spread;
}

// A surface or a medium covers what does not go further straight on. `going`: the path continues.
static inline void note_matte(PathState* path, int instance, int material, bool going) {
  if (HAS_MATTES) {
    const float clear = going && path->straight ? clear_part(path) : 0.0f;
    path->matte = path->clear - clear;
    path->clear = clear;
    path->instance = instance;
    path->material = material;
  }
}

// The medium before what the path would have met has scattered it. It belongs to the object that the ray
// leaves there, else to the one that the path has crossed last, else, as fog does, to what lies there.
HAVING(HAS_MATTES)
static inline void note_medium(PathState* path, const Encounter* met) {
  const bool leaves = !met->face.entering && met->face.medium == met->before;
  if (met->before == 0 || leaves || path->instance == (int)NO_INSTANCE)
    note_matte(path, met->hit.instance, met->face.material, false);
  else
    note_matte(path, path->instance, path->material, false);
}

// The alpha of the path's sample: 1, or the part of the background that it has lost on a straight way there.
ENTRY static inline float coverage_of(const PathState* path) {
  return path->straight ? 1.0f - clear_part(path) : 1.0f;
}

// The path leaves a surface, perhaps one that has gathered photons. `narrow`: the part of its weight by
// narrow lobes.
HAVING(HAS_CAUSTICS)
static inline void note_gathered(PathState* path, bool specular, float3 narrow) {
  if (!specular) {
    path->gathered = GATHERED_HERE;
    path->narrow = narrow;
  } else if (path->gathered != GATHERED_NOTHING) {
    path->gathered = GATHERED_BEFORE;
  }
}
static inline float3 left_by_photons(const PathState* path, float3 light) {
  if (HAS_CAUSTICS) return path->gathered == GATHERED_BEFORE ? light * path->narrow : light;
  return light;
}

// The first dimension of the numbers from `offset` (BOUNCE_...) on of the surface that a ray of this depth
// meets.
static inline int dimension_here(int depth, UNIFORM u32 offset) {
  return (depth - 1) * (int)DIMENSIONS_A_BOUNCE + (int)(DIMENSION_BOUNCE + offset);
}

#define MOST_SURFACES 65537  // on any path, with those that it passes straight

// The depth that max_depth limits. What shadow rays pass at no cost has none here either: else the picture
// would depend on which of the two finds a light.
static inline int limited_depth(const PathState* path) {
  if (HAS_SHADOW_FILTERS) return path->depth - path->passed;
  return path->depth;
}

// The density of choosing distant light from a segment: in place of a surface, a place on it is chosen, too.
static inline float pdf_on_segment(const PathState* path, float pdf) {
  if (HAS_SCATTERING) return path->scattered.is ? pdf * path->scattered.chance : pdf;
  return pdf;
}
// The density of choosing the light `lamp` from a segment.
static inline float pdf_on_segment_to(const PathState* path, UNIFORM __global const Light* lamp, float pdf) {
  if (HAS_SCATTERING) {
    const Scattered* s = &path->scattered;
    const SeenSegment seen = see_segment(s->o, s->d, s->length, s->decay, middle_of_light(lamp));
    return s->is ? pdf * pdf_towards(&seen, s->at, s->chance) : pdf;
  }
  return pdf;
}

// The place for which lights of the tree were chosen.
static inline float3 chosen_from(const PathState* path) {
  if (HAS_SCATTERING) {
    const Scattered* s = &path->scattered;
    return s->is ? place_for_lights(s->o, s->d, s->length, s->decay) : path->from;
  }
  return path->from;
}
