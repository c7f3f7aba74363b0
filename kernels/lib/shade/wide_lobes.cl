// The lobes of surfaces that gather photons: wide ones. Narrow ones see few of the photons about them, which
// would count for much, as white specks; paths find that light with little noise. A surface a lane.
#ifndef SUNDOG_LIB_WIDE_LOBES_CL
#define SUNDOG_LIB_WIDE_LOBES_CL
#include "lib/shade/bsdf_sample.cl"

#if HAS_CAUSTICS
#define LEAST_WIDE_ALPHA 0.15f  // of facets; of a highlight cos^e about as wide, sqrt(2 / (e + 2))

typedef struct WideLobes {
  Bsdfs bsdf;
  Lobes lobes;  // its shares are those of all lobes
} WideLobes;

#if HAS_ROUGH
static inline void drop_narrow_facets(Microfacets* facets) {
  const MASK wide = MASK_OF(facets->alpha >= LEAST_WIDE_ALPHA);
  facets->rough &= wide;
  facets->bends &= wide;
#if HAS_THIN_WALLS
  facets->frosted &= wide;
#endif
}
static inline void drop_facets(Lobes* lobes) { drop_narrow_facets(&lobes->rough); }
static inline MASK narrow_facets(const Lobes* lobes) {
  return lobes->rough.rough & MASK_OF(lobes->rough.alpha < LEAST_WIDE_ALPHA);
}
#else
static inline void drop_facets(Lobes* lobes) {}
static inline MASK narrow_facets(const Lobes* lobes) { return NO_LANES; }
#endif

#if HAS_LAYERS
static inline void drop_narrow_layers(Lobes* lobes) { lobes->layers.least = (REAL)(LEAST_WIDE_ALPHA); }
static inline MASK layered_surfaces(const Lobes* lobes) { return MASK_OF(lobes->layered > 0.0f); }
#else
static inline void drop_narrow_layers(Lobes* lobes) {}
static inline MASK layered_surfaces(const Lobes* lobes) { return NO_LANES; }
#endif

static inline MASK narrow_highlights(const Lobes* lobes) {
  return MASK_OF(lobes->exponent > 2.0f / (LEAST_WIDE_ALPHA * LEAST_WIDE_ALPHA) - 2.0f);
}
#if HAS_MAPS
static inline void drop_highlights(MASK lanes, Bsdfs* bsdf) {
  bsdf->specular = select3(bsdf->specular, all3((float3)(0.0f)), lanes);
}
#else
static inline void drop_highlights(MASK lanes, Bsdfs* bsdf) {
  bsdf->flags &= ~(lanes & (MASK)((int)MATERIAL_SHINES));
}
#endif

static inline WideLobes wide_lobes(const Bsdfs* bsdf, const Lobes* lobes) {
  WideLobes wide = {*bsdf, *lobes};
  drop_facets(&wide.lobes);
  drop_narrow_layers(&wide.lobes);
  drop_highlights(narrow_highlights(lobes), &wide.bsdf);
  return wide;
}

// The part that narrow lobes have of the weights of `sample`, for each colour; of perfect ones 0.
static inline REAL3 narrow_part(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                const BsdfSamples* sample, MASK lanes) {
  const REAL one = (REAL)(1.0f), least = (REAL)(1e-30f);
  const MASK mine = lanes & ~sample->specular & MASK_OF(sample->pdf > 0.0f) &
                    (narrow_highlights(lobes) | narrow_facets(lobes) | layered_surfaces(lobes));
  if (!any_lane(mine)) return all3((float3)(0.0f));
  REAL unused;
  const WideLobes wide = wide_lobes(bsdf, lobes);
  const REAL3 value = bsdf_scatter(scene, &wide.bsdf, &wide.lobes, wo, sample->wi, mine, &unused);
  const REAL3 weight = scale3(value, 1.0f / (M_PI_F * select(one, sample->pdf, mine)));
  const REAL3 part = real3(one - weight.x / real_max(sample->weight.x, least),
                           one - weight.y / real_max(sample->weight.y, least),
                           one - weight.z / real_max(sample->weight.z, least));
  return select3(all3((float3)(0.0f)), part, mine);
}
#else
static inline REAL3 narrow_part(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                const BsdfSamples* sample, MASK lanes) {
  return all3((float3)(0.0f));
}
#endif

#endif
