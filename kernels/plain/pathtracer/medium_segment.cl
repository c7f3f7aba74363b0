// The segment of a ray to its next interface, where that lies in a medium that scatters.
#include "plain/pathtracer/path_state.cl"

// A ray before it is taken to its next interface.
typedef struct BegunRay {
  float t_min;
  HAVING(HAS_SCATTERING) float since;
  HAVING(HAS_SCATTERING) MediaStack media;
  HAVING(HAS_SCATTERING) int crossings;
  HAVING(HAS_SIDES) int sides;
} BegunRay;

static inline BegunRay begun_ray_of(const SceneRay* ray) {
  BegunRay begun;
  begun.t_min = ray->t_min;
  if (HAS_SIDES) begun.sides = ray->sides;
  if (HAS_SCATTERING) {
    begun.since = ray->since;
    begun.media = ray->media;
    begun.crossings = ray->crossings;
  }
  return begun;
}

// A segment of a ray in a medium.
typedef struct MediumSegment {
  bool scatters;
  float3 o, d;                 // where it begins
  float length;                // to the next interface
  float begin;                 // length in the medium before it, for absorption
  SampledSpectrum decay;       // light lost per unit of length
  SampledSpectrum scattering;  // light scattered
  float g;                     // mean cosine of turns
  float mean;                  // of the decay's colours
  SampledSpectrum shares;      // of the colours, in the choice of the place where the path is scattered
  SampledSpectrum drawn;       // and of the one that gets light
} MediumSegment;

HAVING(HAS_SCATTERING)
static inline MediumSegment find_medium_segment(UNIFORM const Scene* scene, const BegunRay* begun,
                                                const SceneRay* ray, const Encounter* met,
                                                const SampledWavelengths* w, SampledSpectrum carried) {
  MediumSegment s;
  s.scatters = false;
  s.o = along(ray->o, begun->t_min, ray->d);
  s.d = ray->d;
  s.length = real_max(met->hit.t - begun->t_min, 0.0f);
  s.begin = begun->t_min - begun->since;
  s.g = 0.0f;
  float3 decay = (float3)(0.0f), scattering = decay;
  EACH_ALIKE(int, index, met->before) {
    const float4 some = scene->media[index].scattering;
    if (some.x + some.y + some.z > 0.0f) {
      s.scatters = true;
      decay = scene->media[index].absorption.xyz;
      scattering = some.xyz;
      s.g = some.w;
    }
  }
  s.mean = (decay.x + decay.y + decay.z) * (1.0f / 3.0f);
  s.decay = spectrum_of(w, decay);
  s.scattering = spectrum_of(w, scattering);
  s.shares = shares_of(carried);
  s.drawn = shares_of(where_positive(carried, s.scattering));
  return s;
}
