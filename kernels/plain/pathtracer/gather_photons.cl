// Light that photons bring to a surface of a path: the mean of those within a radius.
#include "plain/pathtracer/hero.cl"
#include "plain/pathtracer/light_parts.cl"
#include "plain/pathtracer/wide_lobes.cl"

#define PHOTON_COSINE 0.01f  // below it photons count as if they came at it

// Photons' light that a surface sends along its path.
typedef struct PhotonLight {
  float3 all;
  HAVING(HAS_LIGHT_PARTS) float3 diffuse, transmitted;
} PhotonLight;

// Adds what the surface makes of a photon, over the area that it stands for.
HAVING(HAS_CAUSTICS)
static inline void scatter_photon(UNIFORM const Scene* scene, const SurfaceInteraction* s, const Bsdf* bsdf,
                                  const LobeSet* lobes, float3 wo, float3 wi, float3 flux, PhotonLight* sum) {
  float unused;
  const float3 value = bsdf_scatter(scene, bsdf, lobes, wo, wi, &unused);
  const float cosine = dot(s->ng, wi), arriving = real_max(fabs(cosine), PHOTON_COSINE);
  float factor = 1.0f / (M_PI_F * arriving);
  if (HAS_RELIEF && !(cosine < 0.0f)) factor *= terminator(s, wi);
  if (HAS_MEDIA && cosine < 0.0f) factor = factor / (lobes->interface.eta * lobes->interface.eta);
  sum->all += value * flux * factor;
  if (HAS_LIGHT_PARTS) {
    const bool below = cosine < 0.0f;
    if (below) sum->transmitted += value * flux * factor;
    if (!below) sum->diffuse += (value - glossy_scatter(scene, bsdf, lobes, wo, wi)) * flux * factor;
  }
}

// A path as it comes to a surface, before that scatters it.
typedef struct Arrival {
  float3 wo;
  SampledSpectrum throughput;
  int depth;   // limited_depth()
  bool alone;  // its hero is
  HAVING(HAS_LIGHT_PARTS) int scatterings;
  HAVING(HAS_LIGHT_PARTS) LobeShares shares;
} Arrival;

static inline Arrival arrival_of(const PathState* path, const SceneRay* ray) {
  Arrival arrival;
  arrival.wo = -ray->d;
  arrival.throughput = path->throughput;
  arrival.depth = limited_depth(path);
  arrival.alone = path->wavelengths.alone;
  if (HAS_LIGHT_PARTS) {
    arrival.scatterings = path->scatterings;
    arrival.shares = path->shares;
  }
  return arrival;
}

// The light of photons that the surface sends along its path. `ray`: any of the path.
HAVING(HAS_CAUSTICS)
static SampledSpectrum gather_photons(UNIFORM const Scene* scene, PathState* path, const Arrival* arrival,
                                      const SceneRay* ray, const SurfaceShading* at, const LobeSet* lobes) {
  Bsdf bsdf = at->bsdf;
  LobeSet wide = *lobes;
  keep_wide_lobes(&bsdf, &wide);
  PhotonSearch search = search_photons(scene, &path->at, arrival->depth, ray, &at->s);
  PhotonLight sum;
  sum.all = (float3)(0.0f);
  if (HAS_LIGHT_PARTS) {
    sum.diffuse = (float3)(0.0f);
    sum.transmitted = (float3)(0.0f);
  }
  float3 wi = (float3)(0.0f), flux = wi;
  while (next_photon(scene, &search, &wi, &flux))
    scatter_photon(scene, &at->s, &bsdf, &wide, arrival->wo, wi, flux, &sum);
  const SampledSpectrum light =
      kept_hero(scene, at, &lobes->interface, arrival->alone,
                arrival->throughput * spectrum_of(&path->wavelengths, sum.all * (1.0f / search.area)));
  if (HAS_LIGHT_PARTS) {
    const SampledSpectrum all = spectrum_of(&path->wavelengths, sum.all);
    LobeShares shares = no_lobes();
    shares.diffuse = spectrum_part(spectrum_of(&path->wavelengths, sum.diffuse), all);
    shares.transmitted = spectrum_part(spectrum_of(&path->wavelengths, sum.transmitted), all);
    if (arrival->scatterings > 0) shares = arrival->shares;
    add_scattered(path, &shares, false, light);
  }
  return light;
}

static inline SampledSpectrum light_of_photons(UNIFORM const Scene* scene, PathState* path,
                                               const Arrival* arrival, const SceneRay* ray,
                                               const SurfaceShading* at, const LobeSet* lobes) {
  if (HAS_CAUSTICS) return gather_photons(scene, path, arrival, ray, at, lobes);
  return (SampledSpectrum)(0.0f);
}
