// Perfect transmission, unless facets transmit. Unbent and unfrosted light goes straight through, whatever
// the facets.
#include "plain/shade/lobe_set.h"

HAVING(HAS_SECONDARY)
static inline float share_refraction(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo,
                                     LobeSet* lobes) {
  const float share = greatest(lobes->split.kt);
  if (HAS_ROUGH) return lobes->rough.transmits ? 0.0f : share;
  return share;
}

HAVING(HAS_SECONDARY)
static inline float3 send_refraction(const Bsdf* bsdf, const LobeSet* lobes, float3 wo, float3* part) {
  *part = lobes->split.kt;
  return transmitted_direction(bsdf, &lobes->split, wo);
}
