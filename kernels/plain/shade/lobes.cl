// The lobes of a surface together: what they scatter, and samples of directions by chance among them.
#include "plain/shade/lobes/"

// Lobes of the surface that is seen from wo.
ENTRY static inline LobeSet make_lobes(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo) {
  LobeSet lobes;
  lobes.interface = make_interface(scene, bsdf, wo);
  if (HAS_LAYERS) lobes.layers = make_shares(scene, bsdf, wo, &lobes.interface);
  if (HAS_ROUGH) lobes.rough = make_microfacets(scene, bsdf, &lobes.interface, wo);
  lobes.all = 0.0f;
#define ADD_LOBE(feature, name, flags)                  \
  if (feature) {                                        \
    lobes.name = share_##name(scene, bsdf, wo, &lobes); \
    lobes.all += lobes.name;                            \
  }
  PERFECT_LOBES(ADD_LOBE) SCATTERING_LOBES(ADD_LOBE) return lobes;
}

#define ADD_SHARE(feature, name, flags) \
  if (feature) sum += lobes->name;
static inline float perfect_share(const LobeSet* lobes) {
  float sum = 0.0f;
  PERFECT_LOBES(ADD_SHARE)
  return sum;
}
static inline float scattered_share(const LobeSet* lobes) {
  float sum = 0.0f;
  SCATTERING_LOBES(ADD_SHARE)
  return sum;
}

#define ADD_ALBEDO(feature, name, flags) \
  if (feature) sum += albedo_##name(scene, bsdf, lobes, wo);
// About what the scattering lobes return of white surroundings.
ENTRY static inline float3 scattered_albedo(UNIFORM const Scene* scene, const Bsdf* bsdf,
                                            const LobeSet* lobes, float3 wo) {
  float3 sum = (float3)(0.0f);
  SCATTERING_LOBES(ADD_ALBEDO)
  return sum;
}
// The surface's colour, for AOVs.
ENTRY static inline float3 surface_color(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo) {
  const LobeSet made = make_lobes(scene, bsdf, wo);
  const LobeSet* lobes = &made;
  float3 sum = (float3)(0.0f);
  MATTE_LOBES(ADD_ALBEDO)
  return sum;
}

// pi times the BSDF times the cosine of all imperfect lobes, for directions wi on either side of the surface;
// `pdf`: the density with which sample_lobes() chooses them.
ENTRY static inline float3 bsdf_scatter(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                        float3 wo, float3 wi, float* pdf) {
  LobeSum sum = {(float3)(0.0f), 0.0f};
#define SCATTER(feature, name, flags) \
  if (feature) scatter_##name(scene, bsdf, lobes, wo, wi, &sum);
  SCATTERING_LOBES(SCATTER)
  *pdf = sum.pdf / (lobes->all > 0.0f ? lobes->all : 1.0f);
  return sum.value;
}

// A direction of the perfect lobe that `at` chooses.
static inline BsdfSample sample_perfect(const Bsdf* bsdf, const LobeSet* lobes, float3 wo, float at) {
  BsdfSample sample = {(float3)(0.0f), (float3)(0.0f), 0.0f, false};
  if (HAS_SECONDARY) {
    float end = 0.0f;
#define SEND(feature, name, flags)                     \
  if (feature) {                                       \
    end += lobes->name;                                \
    if (at < end && !sample.specular) {                \
      float3 part;                                     \
      sample.wi = send_##name(bsdf, lobes, wo, &part); \
      sample.pdf = lobes->name / lobes->all;           \
      sample.weight = part * (1.0f / sample.pdf);      \
      sample.specular = true;                          \
    }                                                  \
  }
    PERFECT_LOBES(SEND)
  }
  return sample;
}

// A direction of the scattering lobe that `at` chooses.
static inline BsdfSample sample_scattering(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                           float3 wo, float at, float u_x, float u_y) {
  BsdfSample sample = {bsdf->ns, (float3)(0.0f), 0.0f, false};
  bool chosen = false, below = false;
  float end = perfect_share(lobes);
#define SAMPLE(feature, name, flags)                                 \
  if (feature) {                                                     \
    const LobeNumbers u = {at - end, u_x, u_y};                      \
    end += lobes->name;                                              \
    if (at < end && !chosen) {                                       \
      sample.wi = sample_##name(scene, bsdf, lobes, wo, &u, &below); \
      chosen = true;                                                 \
    }                                                                \
  }
  SCATTERING_LOBES(SAMPLE)
  const float3 value = bsdf_scatter(scene, bsdf, lobes, wo, sample.wi, &sample.pdf);
  // A direction on the wrong side of its lobe is rejected.
  if (!chosen || below != (dot(bsdf->ns, sample.wi) <= 0.0f)) sample.pdf = 0.0f;
  if (sample.pdf > 0.0f) sample.weight = value * (1.0f / (M_PI_F * sample.pdf));
  return sample;
}

// Samples a direction with numbers in [0, 1): `u_lobe` chooses the lobe, u_x and u_y the direction. The mean
// weight is the surface's reflectance of a white surrounding. A weight of 0 ends the path.
ENTRY static inline BsdfSample sample_lobes(UNIFORM const Scene* scene, const Bsdf* bsdf,
                                            const LobeSet* lobes, float3 wo, float u_lobe, float u_x,
                                            float u_y) {
  const float at = u_lobe * lobes->all;
  BsdfSample sample = sample_perfect(bsdf, lobes, wo, at);
  if (!sample.specular) sample = sample_scattering(scene, bsdf, lobes, wo, at, u_x, u_y);
  return sample;
}
