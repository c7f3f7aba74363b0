// Reflection and transmission by microfacets of the GGX distribution as a BSDF with a density, for
// integrators that follow one ray on (Walter and others 2007, "Microfacet Models for Refraction through Rough
// Surfaces"; facets by their visible area, Heitz 2018). A surface a lane.
#ifndef SUNDOG_LIB_MICROFACETS_CL
#define SUNDOG_LIB_MICROFACETS_CL
#include "lib/shade/rough.cl"

#if HAS_ROUGH
// Narrower lobes are perfect mirrors and interfaces.
#define LEAST_ALPHA 1e-4f

typedef struct Microfacets {
  MASK rough, bends;  // has facets; they also transmit
  MASK glass;         // of those that transmit the dielectrics
  REAL alpha, lambda_o;
  REAL gain;  // of the viewer's side: see microfacet_gain()
} Microfacets;

// What makes up for the light that is lost between facets: lobes are multiplied by the gains of both
// directions (the scaling of Turquin 2019, "Practical multiple scattering compensation for microfacet
// models", made reciprocal: host/compile/lobe_energy.h).
static inline REAL microfacet_gain(const Scene* scene, REAL c, REAL alpha, MASK lanes) {
  return lobe_energy_at(scene, LOBE_GAINS, c, alpha, lanes);
}

static inline Microfacets make_microfacets(const Scene* scene, const Bsdfs* bsdf, const SpecularSplits* split,
                                           REAL3 wo, MASK lanes) {
  Microfacets facets;
  facets.alpha = (REAL)(0.0f);
  u32 index;
  for (MASK left = lanes; any_lane(left);) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    facets.alpha = select(facets.alpha, (REAL)(scene->materials[index].reflection.w), mine);
  }
  facets.rough = split->branches & MASK_OF(facets.alpha >= LEAST_ALPHA);
  facets.bends = facets.rough & split->transmits & MASK_OF(split->eta != 1.0f);
  facets.glass = rough_glass(scene, bsdf, facets.bends);
  if (!any_lane(facets.rough)) return facets;
  const REAL cosine = dot3(bsdf->ns, wo);
  facets.lambda_o = smith_lambda(cosine, facets.alpha);
  facets.gain = microfacet_gain(scene, cosine, facets.alpha, facets.rough & ~facets.bends);
  const REAL of_glass = glass_value(scene, split->eta, cosine, facets.alpha, facets.glass);
  facets.gain = select(facets.gain, 1.0f / of_glass, facets.glass);
  return facets;
}

// The distribution at facets whose normal h is at the cosine c to n.
static inline REAL facet_density(REAL3 n, REAL3 h, REAL alpha) {
  const REAL c = dot3(n, h), a = alpha * alpha;
  const REAL3 off = along3(h, -c, n);
  const REAL width = fma(a * c, c, dot3(off, off));
  return a / (M_PI_F * real_max(width * width, (REAL)(1e-36f)));
}

// The normals, on the side of the viewer, of the facets that send light from wi to wo: `below` from behind.
static inline REAL3 facet_between(REAL3 n, REAL3 wo, REAL3 wi, REAL eta, MASK below) {
  const REAL3 h = safe_unit3(add3(wo, scale3(wi, select((REAL)(1.0f), eta, below))));
  return select3(h, negate3(h), MASK_OF(dot3(n, h) < 0.0f));
}

// The chance that facets with this split reflect rather than transmit.
static inline REAL facet_reflects(const Microfacets* facets, const SpecularSplits* split) {
  const REAL r = greatest3(split->kr), t = greatest3(split->kt);
  const REAL part = r / real_max(r + t, (REAL)(1e-30f));
  return select((REAL)(1.0f), part, facets->bends);
}

// The gain of rough glass on the colour of what its facets send on, `below` from behind (Turquin 2019: by the
// viewer's direction alone, so it is not reciprocal; host/compile/lobe_energy.h says why).
#if HAS_ROUGH_GLASS
static inline void mend_glass_color(const Microfacets* facets, const SpecularSplits* split, MASK below,
                                    REAL3* color) {
  const REAL share = select(split->f, 1.0f - split->f, below);
  const REAL more = (facets->gain - 1.0f) / real_max(share, (REAL)(1e-6f));
  const REAL3 mended =
      real3(color->x * fma(color->x, more, (REAL)(1.0f)), color->y * fma(color->y, more, (REAL)(1.0f)),
            color->z * fma(color->z, more, (REAL)(1.0f)));
  *color = select3(*color, mended, facets->glass);
}
#else
static inline void mend_glass_color(const Microfacets* facets, const SpecularSplits* split, MASK below,
                                    REAL3* color) {}
#endif

// pi times the BSDF times the cosine of the facets of `lanes`, and the density of wi among the directions
// that they send light from wo to. Behind an interface the density is that of directions there; the BSDF has
// no factor for radiance in media of other indices.
static inline REAL3 facet_scatter(const Scene* scene, const Bsdfs* bsdf, const Microfacets* facets, REAL eta,
                                  REAL3 wo, REAL3 wi, MASK lanes, REAL* density) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const REAL cos_i = dot3(bsdf->ns, wi), side = dot3(bsdf->ng, wi);
  const MASK above = lanes & facets->rough & MASK_OF(cos_i > 0.0f) & MASK_OF(side > 0.0f);
  const MASK below = lanes & facets->bends & MASK_OF(cos_i < 0.0f) & MASK_OF(side < 0.0f);
  const REAL3 h = facet_between(bsdf->ns, wo, wi, eta, below);
  const REAL wo_h = dot3(wo, h), wi_h = dot3(wi, h);
  const MASK good = (above & MASK_OF(wo_h > 0.0f)) | (below & MASK_OF(wo_h > 0.0f) & MASK_OF(wi_h < 0.0f));
  *density = zero;
  if (!any_lane(good)) return all3((float3)(0.0f));
  Bsdfs facet = *bsdf;
  facet.ns = h;
  const SpecularSplits split = bsdf_specular(scene, &facet, wo, good);
  const REAL chance = facet_reflects(facets, &split);
  const REAL bent = fma(eta, wi_h, wo_h);
  const REAL jacobian = select(0.25f / real_max(wo_h, (REAL)(1e-6f)),
                               eta * eta * fabs(wi_h) / real_max(bent * bent, (REAL)(1e-20f)), below);
  const REAL cos_o = real_max(dot3(bsdf->ns, wo), (REAL)(1e-6f));
  const REAL seen = facet_density(bsdf->ns, h, facets->alpha) * wo_h / cos_o * jacobian;
  const REAL lambda_i = smith_lambda(fabs(cos_i), facets->alpha);
  const REAL drawn = seen / (1.0f + facets->lambda_o) * select(chance, one - chance, below);
  *density = select(zero, drawn, good);
  const REAL size = M_PI_F * seen / (1.0f + facets->lambda_o + lambda_i);
  REAL3 color = select3(split.kr, split.kt, below);
  const MASK mends = good & ~facets->bends;
  if (any_lane(mends)) {
    const REAL more = fma(facets->gain, microfacet_gain(scene, cos_i, facets->alpha, mends), (REAL)(-1.0f));
    const REAL3 mended = real3(color.x * fma(color.x, more, one), color.y * fma(color.y, more, one),
                               color.z * fma(color.z, more, one));
    color = select3(color, mended, mends);
  }
  mend_glass_color(facets, &split, below, &color);
  return select3(all3((float3)(0.0f)), scale3(color, size), good);
}

// Directions that facets send light from wo to; the numbers u in [0, 1) choose the facet, and `u_side`
// between its reflection and its transmission, which is `through`.
static inline REAL3 facet_direction(const Scene* scene, const Bsdfs* bsdf, const Microfacets* facets,
                                    REAL3 wo, REAL u_side, REAL u_x, REAL u_y, MASK lanes, MASK* through) {
  Bsdfs facet = *bsdf;
  facet.ns = visible_normal(bsdf->ns, wo, facets->alpha, u_x, u_y);
  const SpecularSplits split = bsdf_specular(scene, &facet, wo, lanes);
  const REAL3 d = negate3(wo);
  const REAL3 bent = refract_direction(d, facet.ns, split.cos_i, split.cos_t, split.eta);
  *through = MASK_OF(u_side >= facet_reflects(facets, &split));
  return select3(reflect_direction(d, facet.ns), bent, *through);
}
#endif

#endif
