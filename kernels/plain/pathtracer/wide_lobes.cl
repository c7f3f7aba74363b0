// The lobes of a surface that gathers photons: wide ones. Narrow ones see few of the photons about them,
// which would count for much, as white specks; paths find that light with little noise.
#include "plain/pathtracer/interface.h"

#define LEAST_WIDE_ALPHA 0.15f  // of facets; of a highlight cos^e about as wide, sqrt(2 / (e + 2))

static inline bool has_narrow_highlight(const LobeSet* lobes) {
  if (HAS_HIGHLIGHTS) return lobes->exponent > 2.0f / (LEAST_WIDE_ALPHA * LEAST_WIDE_ALPHA) - 2.0f;
  return false;
}

// Takes the narrow lobes away. The shares stay those of all.
HAVING(HAS_CAUSTICS)
static inline void keep_wide_lobes(Bsdf* bsdf, LobeSet* lobes) {
  if (HAS_ROUGH && !(lobes->rough.alpha >= LEAST_WIDE_ALPHA)) {
    lobes->rough.rough = false;
    lobes->rough.bends = false;
    lobes->rough.transmits = false;
    if (HAS_THIN_WALLS) lobes->rough.frosted = false;
  }
  if (HAS_LAYERS) lobes->layers.least = LEAST_WIDE_ALPHA;
  if (HAS_HIGHLIGHTS && has_narrow_highlight(lobes)) {
    if (HAS_MAPS) bsdf->specular = (float3)(0.0f);
    if (!HAS_MAPS) bsdf->flags &= ~(int)MATERIAL_SHINES;
  }
}

// The part that narrow lobes have of the weight of `sample`, for each colour; of perfect ones 0.
HAVING(HAS_CAUSTICS)
static inline float3 narrow_part(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                 float3 wo, const BsdfSample* sample) {
  bool narrow = has_narrow_highlight(lobes);
  if (HAS_ROUGH) narrow = narrow || (lobes->rough.rough && lobes->rough.alpha < LEAST_WIDE_ALPHA);
  if (HAS_LAYERS) narrow = narrow || lobes->layered > 0.0f;
  if (!narrow || sample->specular || !(sample->pdf > 0.0f)) return (float3)(0.0f);
  Bsdf wide_bsdf = *bsdf;
  LobeSet wide = *lobes;
  keep_wide_lobes(&wide_bsdf, &wide);
  float unused;
  const float3 value = bsdf_scatter(scene, &wide_bsdf, &wide, wo, sample->wi, &unused);
  const float3 weight = value * (1.0f / (M_PI_F * sample->pdf));
  return (float3)(1.0f - weight.x / real_max(sample->weight.x, 1e-30f),
                  1.0f - weight.y / real_max(sample->weight.y, 1e-30f),
                  1.0f - weight.z / real_max(sample->weight.z, 1e-30f));
}
