// Perfect reflection, unless there are facets.
#include "plain/shade/lobe_set.h"

HAVING(HAS_SECONDARY);

static inline float3 albedo_mirror(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                   float3 wo) {
  if (HAS_ROUGH && lobes->rough.rough) return (float3)(0.0f);
  return lobes->interface.kr;
}

static inline float share_mirror(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, LobeSet* lobes) {
  return greatest(albedo_mirror(scene, bsdf, lobes, wo));
}

static inline float3 send_mirror(const Bsdf* bsdf, const LobeSet* lobes, float3 wo, float3* part) {
  *part = lobes->interface.kr;
  return reflected_direction(bsdf, wo);
}
