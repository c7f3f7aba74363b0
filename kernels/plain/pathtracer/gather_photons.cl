// Light that photons bring to a surface of a path: the mean of those within a radius.
#include "plain/pathtracer/path_state.cl"
#include "plain/pathtracer/wide_lobes.cl"

#define PHOTON_COSINE 0.01f  // below it photons count as if they came at it

// What the surface makes of a photon, over the area that it stands for.
HAVING(HAS_CAUSTICS)
static inline float3 scatter_photon(UNIFORM const Scene* scene, const SurfaceInteraction* s, const Bsdf* bsdf,
                                    const LobeSet* lobes, float3 wo, float3 wi, float3 flux) {
  float unused;
  const float3 value = bsdf_scatter(scene, bsdf, lobes, wo, wi, &unused);
  const float cosine = dot(s->ng, wi), arriving = real_max(fabs(cosine), PHOTON_COSINE);
  float factor = 1.0f / (M_PI_F * arriving);
  if (HAS_RELIEF && !(cosine < 0.0f)) factor *= terminator(s, wi);
  if (HAS_MEDIA && cosine < 0.0f) factor = factor / (lobes->split.eta * lobes->split.eta);
  return value * flux * factor;
}

// The light of photons that the surface sends along its path.
HAVING(HAS_CAUSTICS)
static SampledSpectrum gather_photons(UNIFORM const Scene* scene, const PathState* path, const SceneRay* ray,
                                      const SurfaceShading* at, const LobeSet* lobes) {
  Bsdf bsdf = at->bsdf;
  LobeSet wide = *lobes;
  keep_wide_lobes(&bsdf, &wide);
  PhotonSearch search = search_photons(scene, &path->at, path->depth, ray, &at->s);
  float3 sum = (float3)(0.0f), wi, flux;
  while (next_photon(scene, &search, &wi, &flux))
    sum += scatter_photon(scene, &at->s, &bsdf, &wide, -ray->d, wi, flux);
  return path->throughput * spectrum_of(&path->wavelengths, sum * (1.0f / search.area));
}
