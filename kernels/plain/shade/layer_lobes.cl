// The lobes of layered materials, all reciprocal, in the frame of the shading normal (z): anisotropic
// microfacets (GGX; Heitz 2014, "Understanding the Masking-Shadowing Function"), fuzz (Estevez and Kulla
// 2017, "Production Friendly Microfacet Sheen BRDF") and a rough matte ground (Portsmouth, Kutz and Hill
// 2025, "EON: A Practical Energy-Preserving Rough Diffuse BRDF").
#include "plain/shade/facets.cl"

#define LEAST_COSINE 1e-6f

static inline float square1(float x) { return x * x; }

// The squared width of facets as seen from w, times the squared sine of w.
static inline float stretched2(float3 w, float alpha_x, float alpha_y) {
  return fma(square1(alpha_x * w.x), 1.0f, square1(alpha_y * w.y));
}

static inline float facet_lambda(float3 w, float alpha_x, float alpha_y) {
  const float tangent2 = stretched2(w, alpha_x, alpha_y) / real_max(w.z * w.z, 1e-12f);
  return 0.5f * (real_sqrt(1.0f + tangent2) - 1.0f);
}

static inline float facets_at(float3 h, float alpha_x, float alpha_y) {
  const float width = square1(h.x / alpha_x) + square1(h.y / alpha_y) + h.z * h.z;
  return 1.0f / (M_PI_F * alpha_x * alpha_y * real_max(width * width, 1e-30f));
}

// visible_normal() of anisotropic facets.
static inline float3 seen_facet(float3 wo, float alpha_x, float alpha_y, float u_x, float u_y) {
  const float3 h =
      seen_area(safe_unit3((float3)(alpha_x * wo.x, alpha_y * wo.y, real_max(wo.z, LEAST_COSINE))), u_x, u_y);
  return safe_unit3((float3)(alpha_x * h.x, alpha_y * h.y, real_max(h.z, LEAST_COSINE)));
}

// Single reflection of white facets (pi times the lobe times the cosine), the pdf of wi, and the contribution
// of multiple reflections per unit of colour, by the gains of both directions (lobes/ggx.cl).
typedef struct FacetLobe {
  float value, pdf, more;
} FacetLobe;

static inline FacetLobe facet_lobe(float3 wo, float3 wi, float3 h, float alpha_x, float alpha_y,
                                   float gains) {
  const float seen = facets_at(h, alpha_x, alpha_y) / (4.0f * real_max(wo.z, LEAST_COSINE));
  const float lambda_o = facet_lambda(wo, alpha_x, alpha_y), lambda_i = facet_lambda(wi, alpha_x, alpha_y);
  const FacetLobe lobe = {M_PI_F * seen / (1.0f + lambda_o + lambda_i), seen / (1.0f + lambda_o),
                          gains - 1.0f};
  return lobe;
}

static inline float mend_share(float f, float more) { return f * fma(f, more, 1.0f); }
static inline float3 mend_shares(float3 f, float more) {
  return (float3)(mend_share(f.x, more), mend_share(f.y, more), mend_share(f.z, more));
}

static inline float interface_reflectance(float c, float eta) {
  return fresnel_reflectance(c, refracted_cosine(c, eta), eta);
}

// A metal's reflectance by its colours at normal incidence and near the edge (Hoffman 2023, "Generalization
// of Adobe's Fresnel Model": F82).
static inline float metal_share(float c, float f0, UNIFORM float tint) {
  const float bar = 1.0f / 7.0f, left = 1.0f - bar, left5 = left * left * left * left * left;
  const float away = real_clamp(1.0f - c, 0.0f, 1.0f), away2 = away * away, away5 = away2 * away2 * away;
  const float dip = fma(1.0f - f0, left5, f0) * ((1.0f - tint) / (bar * left5 * left));
  const float f = fma(1.0f - f0, away5, f0) - dip * c * away5 * away;
  return real_clamp(f, 0.0f, 1.0f);
}
static inline float3 metal_shares(float c, float3 f0, UNIFORM float4 tint) {
  return (float3)(metal_share(c, f0.x, tint.x), metal_share(c, f0.y, tint.y), metal_share(c, f0.z, tint.z));
}

// pi times fuzz times the cosine: upright fibres of width alpha, with the visibility term of Neubelt and
// Pettineo (2013).
static inline float fuzz_lobe(float3 wo, float3 wi, float3 h, UNIFORM float alpha) {
  const float sine2 = real_clamp(1.0f - h.z * h.z, 1e-12f, 1.0f);
  const float fibres = (2.0f + 1.0f / alpha) * 0.5f * real_exp(real_log(sine2) * (0.5f / alpha));
  const float between = wo.z + wi.z - wo.z * wi.z;
  return fibres * wi.z / (4.0f * real_max(between, 1e-4f));
}

// The albedo of single reflections in a rough white matte ground, over A of the paper.
static inline float matte_part(float c, UNIFORM float roughness) {
  const float d = 1.0f - c;
  const float g = d * fma(d, fma(d, fma(d, 0.0714429953f, -0.332181442f), 0.491881867f), 0.0571085289f);
  return fma(g, roughness, 1.0f);
}
static inline float matte_share(float color, float single, float further, UNIFORM float mean) {
  return fma(color, single, color * color * mean / (1.0f - color * (1.0f - mean)) * further);
}

// pi times the matte lobe times the cosine.
static inline float3 matte_lobe(float3 wo, float3 wi, float3 color, UNIFORM float roughness) {
  const float a = 1.0f / (1.0f + 0.28779341f * roughness);   // 1/2 - 2/(3 pi)
  const float mean = a * (1.0f + 0.072488212f * roughness);  // 2/3 - 28/(15 pi)
  const float s = fma(wo.x, wi.x, wo.y * wi.y);
  const float part = s > 0.0f ? s / real_max(real_max(wo.z, wi.z), 1e-6f) : s;
  const float single = a * fma(part, roughness, 1.0f) * wi.z;
  const float lost_o = fma(-a, matte_part(wo.z, roughness), 1.0f),
              lost_i = fma(-a, matte_part(wi.z, roughness), 1.0f);
  const float further = lost_o * lost_i / fmax(1.0f - mean, 1e-7f) * wi.z;
  return (float3)(matte_share(color.x, single, further, mean), matte_share(color.y, single, further, mean),
                  matte_share(color.z, single, further, mean));
}

// The share of a lobe of these widths that a mirror ray represents, if reflected rays are sent.
static inline float mirror_share(float alpha_x, float alpha_y) {
  const float smooth = 1.25f * (1.0f - real_sqrt(real_sqrt(alpha_x * alpha_y)));
  return real_min(smooth * smooth, 1.0f);
}
