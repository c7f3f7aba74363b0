// The lobes of a surface that gathers photons: wide ones. Narrow ones see few of the photons about them,
// which would count for much, as white specks; paths find that light with little noise.
#include "plain/pathtracer/interface.h"

// Takes the narrow lobes away, and returns whether there are any. The shares stay those of all.
HAVING(HAS_CAUSTICS)
static inline bool keep_wide_lobes(Bsdf* bsdf, LobeSet* lobes) {
  bool narrow = false;
#define KEEP_WIDE(feature, name, flags) \
  if (feature) narrow = drop_narrow_##name(bsdf, lobes) || narrow;
  SCATTERING_LOBES(KEEP_WIDE)
  return narrow;
}

// The part that narrow lobes have of the weight of `sample`, for each colour; of perfect ones 0.
HAVING(HAS_CAUSTICS)
static inline float3 narrow_part(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                 float3 wo, const BsdfSample* sample) {
  if (sample->specular || !(sample->pdf > 0.0f)) return (float3)(0.0f);
  Bsdf wide_bsdf = *bsdf;
  LobeSet wide = *lobes;
  if (!keep_wide_lobes(&wide_bsdf, &wide)) return (float3)(0.0f);
  float unused;
  const float3 value = bsdf_scatter(scene, &wide_bsdf, &wide, wo, sample->wi, &unused);
  const float3 weight = value * (1.0f / (M_PI_F * sample->pdf));
  return (float3)(1.0f - weight.x / real_max(sample->weight.x, 1e-30f),
                  1.0f - weight.y / real_max(sample->weight.y, 1e-30f),
                  1.0f - weight.z / real_max(sample->weight.z, 1e-30f));
}
