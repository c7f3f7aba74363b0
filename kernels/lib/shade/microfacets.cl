// Sampled reflection and transmission by GGX microfacets, for integrators that continue with one ray (Walter
// and others 2007, "Microfacet Models for Refraction through Rough Surfaces"; visible normals, Heitz 2018).
// One surface per lane.
#ifndef SUNDOG_LIB_MICROFACETS_CL
#define SUNDOG_LIB_MICROFACETS_CL
#include "lib/shade/rough.cl"

#if HAS_ROUGH
// Multiple scattering of rough glass: the energy lost by single scattering, distributed as m(wo) m(wi) over
// the mean of m, where m is a direction's loss (Kulla and Conty 2017, "Revisiting Physically Based Shading at
// Imageworks"; the sides share it so that the lobe stays reciprocal: the share transmitted from the thinner
// side, times its mean m, is the other's times its own mean and eta^2).
#if HAS_ROUGH_GLASS
typedef struct FurtherLight {
  REAL lost;               // m(wo), also the share of the samples
  REAL through;            // fraction transmitted
  REAL mean, mean_behind;  // of m on the viewer's side and behind
} FurtherLight;

static inline FurtherLight find_further(const Scene* scene, REAL eta, REAL cosine, REAL alpha, MASK glass) {
  FurtherLight further;
  const REAL thick = select(1.0f / eta, eta, MASK_OF(eta > 1.0f)), least = (REAL)(1e-3f),
             area = real_max(alpha * alpha, (REAL)(1e-8f));
  further.lost = real_max(1.0f - glass_value(scene, eta, cosine, alpha, glass), (REAL)(0.0f));
  const REAL thin_mean = area * real_max(glass_row(scene, GLASS_LOST, 2u, thick, alpha, glass), least);
  const REAL thick_mean =
      area * real_max(glass_row(scene, GLASS_LOST + GLASS_STEPS, 2u, thick, alpha, glass), least);
  const REAL back = thin_mean / (thick_mean * thick * thick);
  const REAL through = real_min(glass_row(scene, GLASS_THROUGH, 1u, thick, alpha, glass), 1.0f / back);
  const MASK from_thin = MASK_OF(eta > 1.0f);
  further.through = select(through * back, through, from_thin);
  further.mean = select(thick_mean, thin_mean, from_thin);
  further.mean_behind = select(thin_mean, thick_mean, from_thin);
  return further;
}
static inline void set_further(const Scene* scene, const SpecularSplits* split, REAL cosine, REAL alpha,
                               MASK glass, FurtherLight* further) {
  *further = find_further(scene, split->eta, cosine, alpha, glass);
  further->lost = select((REAL)(0.0f), further->lost, glass);
}
#endif

typedef struct Microfacets {
  MASK rough, bends;  // has facets; they also refract
  MASK mends;         // the lobe is scaled by gains: microfacet_gain()
  MASK glass;         // refracting dielectrics with a separate multiple-scattering lobe
  REAL alpha, lambda_o;
  REAL gain;  // of the viewer's side
#if HAS_THIN_WALLS
  MASK frosted;  // thin walls with transmitting facets
#endif
#if HAS_ROUGH_GLASS
  FurtherLight further;
#endif
} Microfacets;

// Compensation for energy lost between facets: lobes are multiplied by the gains of both directions (the
// scaling of Turquin 2019, "Practical multiple scattering compensation for microfacet models", made
// reciprocal: host/compile/lobe_energy.h).
static inline REAL microfacet_gain(const Scene* scene, REAL c, REAL alpha, MASK lanes) {
  return lobe_energy_at(scene, LOBE_GAINS, c, alpha, lanes);
}

#if HAS_ROUGH_GLASS
static inline void start_further(const Scene* scene, const SpecularSplits* split, REAL cosine,
                                 Microfacets* facets) {
  set_further(scene, split, cosine, facets->alpha, facets->glass, &facets->further);
}
#else
static inline void start_further(const Scene* scene, const SpecularSplits* split, REAL cosine,
                                 Microfacets* facets) {}
#endif

// Frosted thin walls transmit by the facets that reflect: to the reflected direction, mirrored through the
// surface (KHR_materials_transmission). A facet has the shares of both faces together.
#if HAS_THIN_WALLS
static inline void find_frosted(const Bsdfs* bsdf, const SpecularSplits* split, Microfacets* facets) {
  const int kind = (int)(MATERIAL_THIN | MATERIAL_FROSTED);
  facets->frosted = facets->rough & split->transmits & MASK_OF((bsdf->flags & kind) == kind);
}
static inline MASK frosted_of(const Microfacets* facets) { return facets->frosted; }
#else
static inline void find_frosted(const Bsdfs* bsdf, const SpecularSplits* split, Microfacets* facets) {}
static inline MASK frosted_of(const Microfacets* facets) { return NO_LANES; }
#endif
static inline MASK transmitting_facets(const Microfacets* facets) {
  return facets->bends | frosted_of(facets);
}

static inline Microfacets make_microfacets(const Scene* scene, const Bsdfs* bsdf, const SpecularSplits* split,
                                           REAL3 wo, MASK lanes) {
  Microfacets facets;
  facets.alpha = facet_width(scene, bsdf, lanes);
  facets.rough = split->branches & MASK_OF(facets.alpha >= LEAST_ALPHA);
  facets.bends = facets.rough & split->transmits & MASK_OF(split->eta != 1.0f);
  find_frosted(bsdf, split, &facets);
  facets.mends = giving_back(bsdf, facets.rough & ~facets.bends);
  facets.glass = rough_glass(scene, bsdf, giving_back(bsdf, facets.bends));
  if (!any_lane(facets.rough)) return facets;
  const REAL cosine = dot3(bsdf->ns, wo);
  facets.lambda_o = smith_lambda(cosine, facets.alpha);
  facets.gain = microfacet_gain(scene, cosine, facets.alpha, facets.mends);
  start_further(scene, split, cosine, &facets);
  return facets;
}

// The distribution at facets with normal h, by its cosine to n.
static inline REAL facet_pdf(REAL3 n, REAL3 h, REAL alpha) {
  const REAL c = dot3(n, h), a = alpha * alpha;
  const REAL3 off = along3(h, -c, n);
  const REAL width = fma(a * c, c, dot3(off, off));
  return a / (M_PI_F * real_max(width * width, (REAL)(1e-36f)));
}

// The facet normals, on the viewer's side, that send light from wi to wo; `below`: from behind.
static inline REAL3 facet_between(REAL3 n, REAL3 wo, REAL3 wi, REAL eta, MASK below) {
  const REAL3 h = safe_unit3(add3(wo, scale3(wi, select((REAL)(1.0f), eta, below))));
  return select3(h, negate3(h), MASK_OF(dot3(n, h) < 0.0f));
}

// The probability that facets with this split reflect instead of transmitting.
static inline REAL facet_reflects(const Microfacets* facets, const SpecularSplits* split) {
  const REAL r = greatest3(split->kr), t = greatest3(split->kt);
  const REAL part = r / real_max(r + t, (REAL)(1e-30f));
  return select((REAL)(1.0f), part, transmitting_facets(facets));
}

// Adds multiple scattering of glass to pi times the BSDF times the cosine, and its pdf, for directions at the
// cosine c; samples its directions by the number u_side, passing `rest` on to the others.
#if HAS_ROUGH_GLASS
static inline void add_further(const Scene* scene, const Bsdfs* bsdf, const Microfacets* facets, REAL eta,
                               REAL c, MASK lanes, REAL3* value, REAL* pdf) {
  const MASK glass = lanes & facets->glass;
  if (!any_lane(glass)) return;
  const FurtherLight* further = &facets->further;
  const REAL one = (REAL)(1.0f);
  const MASK below = MASK_OF(c < 0.0f);
  const REAL there = select(eta, 1.0f / eta, below);  // index behind over before, as seen from wi
  const REAL lost_i = real_max(1.0f - glass_value(scene, there, fabs(c), facets->alpha, glass), (REAL)(0.0f));
  const REAL part = select(one - further->through, further->through, below);
  const REAL mean = select(further->mean, further->mean_behind, below);
  const REAL size = part * further->lost * lost_i * fabs(c) / mean;
  REAL3 tint = all3((float3)(0.0f));
  u32 index;
  for (u32 left = lane_bits(glass); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    __global const Material* material = scene->materials + index;
    tint =
        select3(tint, select3(reflection_of(bsdf, material), transmission_of(bsdf, material), below), mine);
  }
  *value = select3(*value, along3(*value, size, tint), glass);
  const REAL drawn = fma(1.0f - further->lost, *pdf, further->lost * part * fabs(c) * (1.0f / M_PI_F));
  *pdf = select(*pdf, drawn, glass);
}
static inline MASK draw_further(const Bsdfs* bsdf, const Microfacets* facets, REAL u_side, REAL u_x, REAL u_y,
                                MASK lanes, REAL* rest, MASK* through, REAL3* wi) {
  const FurtherLight* further = &facets->further;
  const MASK drawn = lanes & facets->glass & MASK_OF(u_side < further->lost);
  const REAL left = real_max(1.0f - further->lost, (REAL)(1e-6f));
  *rest = select(u_side, (u_side - further->lost) / left, lanes & facets->glass);
  if (!any_lane(drawn)) return drawn;
  *through = select(*through, MASK_OF(u_side < further->lost * further->through), drawn);
  const REAL3 above = direction_about(bsdf->ns, real_sqrt(u_x), u_y);
  *wi = select3(*wi, select3(above, negate3(above), *through), drawn);
  return drawn;
}
#else
static inline void add_further(const Scene* scene, const Bsdfs* bsdf, const Microfacets* facets, REAL eta,
                               REAL c, MASK lanes, REAL3* value, REAL* pdf) {}
static inline MASK draw_further(const Bsdfs* bsdf, const Microfacets* facets, REAL u_side, REAL u_x, REAL u_y,
                                MASK lanes, REAL* rest, MASK* through, REAL3* wi) {
  *rest = u_side;
  return NO_LANES;
}
#endif

// pi times the BSDF times the cosine of single reflection and refraction by facets with normals h, and the
// pdf of wi. `below`: of transmission. For frosted walls wi is mirrored, for which refraction's Jacobian with
// eta 1 equals reflection's.
static inline REAL3 facet_light(const Scene* scene, const Bsdfs* bsdf, const Microfacets* facets, REAL eta,
                                REAL3 wo, REAL3 wi, REAL3 h, MASK below, MASK good, REAL* pdf) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f), cos_i = dot3(bsdf->ns, wi);
  const REAL wo_h = dot3(wo, h), wi_h = dot3(wi, h);
  Bsdfs facet = *bsdf;
  facet.ns = h;
  const SpecularSplits split = bsdf_specular(scene, &facet, wo, good);
  const REAL chance = facet_reflects(facets, &split);
  const REAL bent = fma(eta, wi_h, wo_h);
  const REAL jacobian = select(0.25f / real_max(wo_h, (REAL)(1e-6f)),
                               eta * eta * fabs(wi_h) / real_max(bent * bent, (REAL)(1e-20f)), below);
  const REAL cos_o = real_max(dot3(bsdf->ns, wo), (REAL)(1e-6f));
  const REAL seen = facet_pdf(bsdf->ns, h, facets->alpha) * wo_h / cos_o * jacobian;
  const REAL lambda_i = smith_lambda(fabs(cos_i), facets->alpha);
  const REAL drawn = seen / (1.0f + facets->lambda_o) * select(chance, one - chance, below);
  *pdf = select(zero, drawn, good);
  const REAL size = M_PI_F * seen / (1.0f + facets->lambda_o + lambda_i);
  REAL3 color = select3(split.kr, split.kt, below);
  const MASK mends = good & facets->mends;
  if (any_lane(mends)) {
    const REAL more = fma(facets->gain, microfacet_gain(scene, cos_i, facets->alpha, mends), (REAL)(-1.0f));
    // Multiply scattered light of a frosted wall may leave on either side.
    const REAL3 kept = select3(color, add3(split.kr, split.kt), frosted_of(facets));
    const REAL3 mended = real3(color.x * fma(kept.x, more, one), color.y * fma(kept.y, more, one),
                               color.z * fma(kept.z, more, one));
    color = select3(color, mended, mends);
  }
  return select3(all3((float3)(0.0f)), scale3(color, size), good);
}

// pi times the BSDF times the cosine of the facets of `lanes`, and the pdf of wi for wo. Behind an interface
// the pdf is over directions there; the BSDF has no factor for radiance in media of different index.
static inline REAL3 facet_scatter(const Scene* scene, const Bsdfs* bsdf, const Microfacets* facets, REAL eta,
                                  REAL3 wo, REAL3 wi, MASK lanes, REAL* pdf) {
  const REAL zero = (REAL)(0.0f);
  const REAL cos_i = dot3(bsdf->ns, wi), side = dot3(bsdf->ng, wi);
  const MASK above = lanes & facets->rough & MASK_OF(cos_i > 0.0f) & MASK_OF(side > 0.0f);
  const MASK below = lanes & transmitting_facets(facets) & MASK_OF(cos_i < 0.0f) & MASK_OF(side < 0.0f);
  const MASK mirrored = below & frosted_of(facets), bent = below & ~mirrored;
  const REAL3 from = select3(wi, reflect_direction(wi, bsdf->ns), mirrored);
  const REAL3 h = facet_between(bsdf->ns, wo, from, eta, bent);
  const REAL wo_h = dot3(wo, h), wi_h = dot3(from, h);
  const MASK good =
      ((above | mirrored) & MASK_OF(wo_h > 0.0f)) | (bent & MASK_OF(wo_h > 0.0f) & MASK_OF(wi_h < 0.0f));
  REAL3 value = all3((float3)(0.0f));
  *pdf = zero;
  if (any_lane(good)) value = facet_light(scene, bsdf, facets, eta, wo, from, h, below, good, pdf);
  add_further(scene, bsdf, facets, eta, cos_i, above | below, &value, pdf);
  return value;
}

// Samples facet directions for wo; the numbers u in [0, 1) choose the facet, and `u_side` its reflection or
// transmission, which is `below`.
static inline REAL3 facet_direction(const Scene* scene, const Bsdfs* bsdf, const Microfacets* facets,
                                    REAL3 wo, REAL u_side, REAL u_x, REAL u_y, MASK lanes, MASK* below) {
  Bsdfs facet = *bsdf;
  REAL rest;
  REAL3 wi = all3((float3)(0.0f));
  *below = NO_LANES;
  const MASK further = draw_further(bsdf, facets, u_side, u_x, u_y, lanes, &rest, below, &wi);
  facet.ns = visible_normal(bsdf->ns, wo, facets->alpha, u_x, u_y);
  const SpecularSplits split = bsdf_specular(scene, &facet, wo, lanes);
  const REAL3 d = negate3(wo);
  const REAL3 bent = refract_direction(d, facet.ns, split.cos_i, split.cos_t, split.eta);
  const MASK behind = MASK_OF(rest >= facet_reflects(facets, &split));
  const REAL3 reflected = reflect_direction(d, facet.ns);
  const REAL3 through = select3(bent, reflect_direction(reflected, bsdf->ns), frosted_of(facets));
  wi = select3(select3(reflected, through, behind), wi, further);
  *below = select(behind, *below, further);
  return wi;
}
#endif

#endif
