// Values that several lobes of shared/lobes.h read.
#include "plain/shade/facets.cl"
#include "plain/shade/layers.cl"

#define LOBE_SHARE(feature, name, flags) HAVING(feature) float name;

// A surface's lobes for a viewer: the share of each, and what several of them read.
typedef struct LobeSet {
  float all;                                                                   // the sum of the shares
  PERFECT_LOBES(LOBE_SHARE) SCATTERING_LOBES(LOBE_SHARE) Interface interface;  // as the layers leave it
  HAVING(HAS_HIGHLIGHTS) float exponent;                                       // of the highlight
  HAVING(HAS_HIGHLIGHTS) bool blinn;
  HAVING(HAS_ROUGH) Microfacet rough;
  HAVING(HAS_LAYERS) LayerShare layers;
} LobeSet;

typedef struct BsdfSample {
  float3 wi;      // unit
  float3 weight;  // BSDF times cosine over pdf: factor on light from wi
  float pdf;      // of wi, per steradian; of a specular sample the probability of its lobe
  bool specular;  // of a perfect lobe, which bsdf_scatter() excludes
} BsdfSample;

// pi times the BSDF times the cosine, and the density of wi, times the sum of the shares.
typedef struct LobeSum {
  float3 value;
  float pdf;
} LobeSum;

// `at` in [0, the lobe's share), x and y in [0, 1).
typedef struct LobeNumbers {
  float at, x, y;
} LobeNumbers;

// Facets with a narrower distribution see few of the photons about them.
#define LEAST_WIDE_ALPHA 0.15f

static inline bool is_above(const Bsdf* bsdf, float3 wi) {
  return dot(bsdf->ns, wi) > 0.0f && dot(bsdf->side, wi) > 0.0f;
}
