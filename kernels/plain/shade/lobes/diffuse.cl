// Lambert's diffuse term.
#include "plain/shade/lobe_set.h"

static inline float share_diffuse(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, LobeSet* lobes) {
  return greatest(bsdf->diffuse);
}

static inline float3 albedo_diffuse(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                    float3 wo) {
  return bsdf->diffuse;
}

static inline void scatter_diffuse(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                   float3 wo, float3 wi, LobeSum* sum) {
  const float cosine = is_above(bsdf, wi) ? dot(bsdf->ns, wi) : 0.0f;
  sum->value += bsdf->diffuse * cosine;
  sum->pdf += lobes->diffuse * (cosine * (1.0f / M_PI_F));
}

static inline float3 sample_diffuse(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                    float3 wo, const LobeNumbers* u, bool* below) {
  return direction_about(bsdf->ns, real_sqrt(u->x), u->y);
}

static inline void local_diffuse(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, float3 wi, bool met,
                                 float3* light) {
  *light += bsdf->diffuse * dot(bsdf->ns, wi);
}

HAVING(HAS_CAUSTICS)
static inline bool drop_narrow_diffuse(Bsdf* bsdf, LobeSet* lobes) { return false; }

static inline float matte_diffuse(const LobeSet* lobes) { return lobes->diffuse; }

HAVING(HAS_LIGHT_PARTS)
static inline void drop_matte_diffuse(Bsdf* bsdf, LobeSet* lobes) { bsdf->diffuse = (float3)(0.0f); }
