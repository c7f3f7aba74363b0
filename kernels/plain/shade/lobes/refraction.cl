// Perfect transmission, unless facets transmit. Unbent and unfrosted light goes straight through, whatever
// the facets.
#include "plain/shade/lobe_set.h"

HAVING(HAS_SECONDARY);

static inline float3 albedo_refraction(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                       float3 wo) {
  if (HAS_ROUGH && lobes->rough.transmits) return (float3)(0.0f);
  return lobes->interface.kt;
}

static inline float share_refraction(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo,
                                     LobeSet* lobes) {
  return greatest(albedo_refraction(scene, bsdf, lobes, wo));
}

static inline float3 send_refraction(const Bsdf* bsdf, const LobeSet* lobes, float3 wo, float3* part) {
  *part = lobes->interface.kt;
  return transmitted_direction(bsdf, &lobes->interface, wo);
}
