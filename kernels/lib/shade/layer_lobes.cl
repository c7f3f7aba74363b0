// The lobes of layered materials, all reciprocal, in the frame of the shading normal (z): anisotropic
// microfacets (GGX; Heitz 2014, "Understanding the Masking-Shadowing Function"), fuzz (Estevez and Kulla
// 2017, "Production Friendly Microfacet Sheen BRDF") and a rough matte ground (Portsmouth, Kutz and Hill
// 2025, "EON: A Practical Energy-Preserving Rough Diffuse BRDF"). One surface per lane.
#ifndef SUNDOG_LIB_LAYER_LOBES_CL
#define SUNDOG_LIB_LAYER_LOBES_CL
#include "lib/core/optics.cl"
#include "lib/core/tables.h"
#include "lib/shade/rough.cl"
#include "shared/layers.h"

#if HAS_LAYERS
#define LEAST_COSINE 1e-6f

static inline REAL square1(REAL x) { return x * x; }

// The squared width of facets as seen from w, times the squared sine of w.
static inline REAL stretched2(REAL3 w, REAL alpha_x, REAL alpha_y) {
  return fma(square1(alpha_x * w.x), (REAL)(1.0f), square1(alpha_y * w.y));
}

static inline REAL facet_lambda(REAL3 w, REAL alpha_x, REAL alpha_y) {
  const REAL tangent2 = stretched2(w, alpha_x, alpha_y) / real_max(w.z * w.z, (REAL)(1e-12f));
  return 0.5f * (real_sqrt(1.0f + tangent2) - 1.0f);
}

static inline REAL facets_at(REAL3 h, REAL alpha_x, REAL alpha_y) {
  const REAL width = square1(h.x / alpha_x) + square1(h.y / alpha_y) + h.z * h.z;
  return 1.0f / (M_PI_F * alpha_x * alpha_y * real_max(width * width, (REAL)(1e-30f)));
}

// Samples a facet seen by wo, by visible area (visible_normal() of lib/shade/rough.cl, anisotropic).
static inline REAL3 seen_facet(REAL3 wo, REAL alpha_x, REAL alpha_y, REAL u_x, REAL u_y) {
  const REAL3 stretched =
      safe_unit3(real3(alpha_x * wo.x, alpha_y * wo.y, real_max(wo.z, (REAL)(LEAST_COSINE))));
  const REAL z = fma(1.0f - u_y, 1.0f + stretched.z, -stretched.z), angle = 2.0f * M_PI_F * u_x;
  const REAL side = real_sqrt(real_clamp(1.0f - z * z, (REAL)(0.0f), (REAL)(1.0f)));
  const REAL3 h = add3(real3(side * cos(angle), side * sin(angle), z), stretched);
  return safe_unit3(real3(alpha_x * h.x, alpha_y * h.y, real_max(h.z, (REAL)(LEAST_COSINE))));
}

// Single reflection of white facets (pi times the lobe times the cosine), the pdf of wi, and the contribution
// of multiple reflections per unit of colour, by the gains of both directions (lib/shade/microfacets.cl).
typedef struct FacetLobe {
  REAL value, pdf, more;
} FacetLobe;

static inline FacetLobe facet_lobe(REAL3 wo, REAL3 wi, REAL3 h, REAL alpha_x, REAL alpha_y, REAL gains) {
  const REAL seen = facets_at(h, alpha_x, alpha_y) / (4.0f * real_max(wo.z, (REAL)(LEAST_COSINE)));
  const REAL lambda_o = facet_lambda(wo, alpha_x, alpha_y), lambda_i = facet_lambda(wi, alpha_x, alpha_y);
  FacetLobe lobe;
  lobe.value = M_PI_F * seen / (1.0f + lambda_o + lambda_i);
  lobe.pdf = seen / (1.0f + lambda_o);
  lobe.more = gains - 1.0f;
  return lobe;
}

static inline REAL mend_share(REAL f, REAL more) { return f * fma(f, more, (REAL)(1.0f)); }
static inline REAL3 mend_shares(REAL3 f, REAL more) {
  return real3(mend_share(f.x, more), mend_share(f.y, more), mend_share(f.z, more));
}

static inline REAL interface_reflectance(REAL c, REAL eta) {
  return fresnel_reflectance(c, refracted_cosine(c, eta), eta);
}

// A metal's reflectance by its colours at normal incidence and near the edge (Hoffman 2023, "Generalization
// of Adobe's Fresnel Model": F82).
static inline REAL metal_share(REAL c, REAL f0, float tint) {
  const float bar = 1.0f / 7.0f, left = 1.0f - bar, left5 = left * left * left * left * left;
  const REAL away = real_clamp(1.0f - c, (REAL)(0.0f), (REAL)(1.0f)), away2 = away * away;
  const REAL away5 = away2 * away2 * away;
  const REAL dip = fma(1.0f - f0, (REAL)(left5), f0) * ((1.0f - tint) / (bar * left5 * left));
  const REAL f = fma(1.0f - f0, away5, f0) - dip * c * away5 * away;
  return real_clamp(f, (REAL)(0.0f), (REAL)(1.0f));
}
static inline REAL3 metal_shares(REAL c, REAL3 f0, float4 tint) {
  return real3(metal_share(c, f0.x, tint.x), metal_share(c, f0.y, tint.y), metal_share(c, f0.z, tint.z));
}

// pi times fuzz times the cosine: upright fibres of width alpha, with the visibility term of Neubelt and
// Pettineo (2013).
static inline REAL fuzz_lobe(REAL3 wo, REAL3 wi, REAL3 h, float alpha) {
  const REAL sine2 = real_clamp(1.0f - h.z * h.z, (REAL)(1e-12f), (REAL)(1.0f));
  const REAL fibres = (2.0f + 1.0f / alpha) * 0.5f * real_exp(real_log(sine2) * (0.5f / alpha));
  const REAL between = wo.z + wi.z - wo.z * wi.z;
  return fibres * wi.z / (4.0f * real_max(between, (REAL)(1e-4f)));
}

// The albedo of single reflections in a rough white matte ground, over A of the paper.
static inline REAL matte_part(REAL c, float roughness) {
  const REAL d = 1.0f - c;
  const REAL g =
      d * fma(d, fma(d, fma(d, (REAL)(0.0714429953f), (REAL)(-0.332181442f)), (REAL)(0.491881867f)),
              (REAL)(0.0571085289f));
  return fma(g, (REAL)(roughness), (REAL)(1.0f));
}
static inline REAL matte_share(REAL color, REAL single, REAL further, float mean) {
  return fma(color, single, color * color * mean / (1.0f - color * (1.0f - mean)) * further);
}

// pi times the matte lobe times the cosine.
static inline REAL3 matte_lobe(REAL3 wo, REAL3 wi, REAL3 color, float roughness) {
  const float a = 1.0f / (1.0f + 0.28779341f * roughness);   // 1/2 - 2/(3 pi)
  const float mean = a * (1.0f + 0.072488212f * roughness);  // 2/3 - 28/(15 pi)
  const REAL s = fma(wo.x, wi.x, wo.y * wi.y);
  const REAL part = select(s, s / real_max(real_max(wo.z, wi.z), (REAL)(1e-6f)), MASK_OF(s > 0.0f));
  const REAL single = a * fma(part, (REAL)(roughness), (REAL)(1.0f)) * wi.z;
  const REAL lost_o = fma(-a, matte_part(wo.z, roughness), (REAL)(1.0f)),
             lost_i = fma(-a, matte_part(wi.z, roughness), (REAL)(1.0f));
  const REAL further = lost_o * lost_i / fmax(1.0f - mean, 1e-7f) * wi.z;
  return real3(matte_share(color.x, single, further, mean), matte_share(color.y, single, further, mean),
               matte_share(color.z, single, further, mean));
}

// The share of a lobe of these widths that a mirror ray represents, if reflected rays are sent.
static inline REAL mirror_share(REAL alpha_x, REAL alpha_y) {
  const REAL smooth = 1.25f * (1.0f - real_sqrt(real_sqrt(alpha_x * alpha_y)));
  return real_min(smooth * smooth, (REAL)(1.0f));
}
// The rest of the lobe where `mirrored`, else all.
static inline REAL share_left(REAL alpha_x, REAL alpha_y, MASK mirrored) {
  return 1.0f - select((REAL)(0.0f), mirror_share(alpha_x, alpha_y), mirrored);
}
#endif

#endif
