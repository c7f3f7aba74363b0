// Perfect reflection, unless there are facets.
#include "plain/shade/lobe_set.h"

HAVING(HAS_SECONDARY)
static inline float share_mirror(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, LobeSet* lobes) {
  const float share = greatest(lobes->split.kr);
  if (HAS_ROUGH) return lobes->rough.rough ? 0.0f : share;
  return share;
}

HAVING(HAS_SECONDARY)
static inline float3 send_mirror(const Bsdf* bsdf, const LobeSet* lobes, float3 wo, float3* part) {
  *part = lobes->split.kr;
  return reflected_direction(bsdf, wo);
}
