// Sampled reflection and transmission by GGX microfacets, each a perfect mirror or interface (Walter and
// others 2007, "Microfacet Models for Refraction through Rough Surfaces"; visible normals, Heitz 2018).
#include "plain/shade/lobe_set.h"

HAVING(HAS_ROUGH);

// Compensation for energy lost between facets: lobes are multiplied by the gains of both directions (the
// scaling of Turquin 2019, "Practical multiple scattering compensation for microfacet models", made
// reciprocal: host/compile/surfaces/lobe_energy.h).
static inline float microfacet_gain(UNIFORM const Scene* scene, float c, float alpha) {
  return lobe_energy_at(scene, LOBE_GAINS, c, alpha);
}

// Multiple scattering of rough glass: the energy lost by single scattering, distributed as m(wo) m(wi) over
// the mean of m, where m is a direction's loss (Kulla and Conty 2017, "Revisiting Physically Based Shading at
// Imageworks"; the sides share it so that the lobe stays reciprocal: the share transmitted from the thinner
// side, times its mean m, is the other's times its own mean and eta^2).
HAVING(HAS_ROUGH_GLASS)
static inline FurtherLight find_further(UNIFORM const Scene* scene, float eta, float cosine, float alpha) {
  const bool from_thin = eta > 1.0f;
  const float thick = from_thin ? eta : 1.0f / eta, area = real_max(alpha * alpha, 1e-8f);
  FurtherLight further;
  further.lost = real_max(1.0f - glass_value(scene, eta, cosine, alpha), 0.0f);
  const float thin_mean = area * real_max(glass_row(scene, GLASS_LOST, 2u, thick, alpha), 1e-3f);
  const float thick_mean =
      area * real_max(glass_row(scene, GLASS_LOST + GLASS_STEPS, 2u, thick, alpha), 1e-3f);
  const float back = thin_mean / (thick_mean * thick * thick);
  const float through = real_min(glass_row(scene, GLASS_THROUGH, 1u, thick, alpha), 1.0f / back);
  further.through = from_thin ? through : through * back;
  further.mean = from_thin ? thin_mean : thick_mean;
  further.mean_behind = from_thin ? thick_mean : thin_mean;
  return further;
}

// Frosted thin walls transmit by the facets that reflect: to the reflected direction, mirrored through the
// surface (KHR_materials_transmission). A facet has the shares of both faces together.
static inline bool is_frosted(const Microfacet* facets) {
  if (HAS_THIN_WALLS) return facets->frosted;
  return false;
}

static inline Microfacet make_microfacets(UNIFORM const Scene* scene, const Bsdf* bsdf,
                                          const Interface* interface, float3 wo) {
  Microfacet facets;
  facets.alpha = facet_width(scene, bsdf);
  facets.rough = interface->branches && facets.alpha >= LEAST_ALPHA;
  facets.bends = facets.rough && interface->transmits && interface->eta != 1.0f;
  facets.transmits = facets.bends;
  if (HAS_THIN_WALLS) {
    const int kind = (int)(MATERIAL_THIN | MATERIAL_FROSTED);
    facets.frosted = facets.rough && interface->transmits && (bsdf->flags & kind) == kind;
    facets.transmits = facets.bends || facets.frosted;
  }
  facets.glass = is_rough_glass(scene, bsdf, facets.bends);
  facets.gain = 0.0f;
  if (facets.rough) {
    const float cosine = dot(bsdf->ns, wo);
    facets.lambda_o = smith_lambda(cosine, facets.alpha);
    if (!facets.bends && gives_back(bsdf)) facets.gain = microfacet_gain(scene, cosine, facets.alpha);
    if (HAS_ROUGH_GLASS && facets.glass)
      facets.further = find_further(scene, interface->eta, cosine, facets.alpha);
  }
  return facets;
}

// The distribution at facets with normal h, by its cosine to n.
static inline float facet_pdf(float3 n, float3 h, float alpha) {
  const float c = dot(n, h), a = alpha * alpha;
  const float3 off = along(h, -c, n);
  const float width = fma(a * c, c, dot(off, off));
  return a / (M_PI_F * real_max(width * width, 1e-36f));
}

// The facet normal, on the viewer's side, that sends light from wi to wo; `below`: from behind.
static inline float3 facet_between(float3 n, float3 wo, float3 wi, float eta, bool below) {
  const float3 h = safe_unit3(wo + wi * (below ? eta : 1.0f));
  return dot(n, h) < 0.0f ? -h : h;
}

// The probability that facets of this interface reflect instead of transmitting.
static inline float facet_reflects(const Microfacet* facets, const Interface* interface) {
  const float r = greatest(interface->kr), t = greatest(interface->kt);
  const float part = r / real_max(r + t, 1e-30f);
  return facets->transmits ? part : 1.0f;
}

// Adds multiple scattering of glass, and its pdf, for directions at the cosine c.
HAVING(HAS_ROUGH_GLASS)
static inline void add_further(UNIFORM const Scene* scene, const Bsdf* bsdf, const Microfacet* facets,
                               float eta, float c, LobeSum* sum) {
  const bool below = c < 0.0f;
  const float there = below ? 1.0f / eta : eta;  // index behind over before, as seen from wi
  const float lost_i = real_max(1.0f - glass_value(scene, there, fabs(c), facets->alpha), 0.0f);
  const float part = below ? facets->further.through : 1.0f - facets->further.through;
  const float mean = below ? facets->further.mean_behind : facets->further.mean;
  const float size = part * facets->further.lost * lost_i * fabs(c) / mean;
  float3 tint = (float3)(0.0f);
  EACH_ALIKE(int, index, bsdf->material) {
    __global const Material* material = scene->materials + index;
    tint = below ? transmission_of(bsdf, material) : reflection_of(bsdf, material);
  }
  sum->value = along(sum->value, size, tint);
  sum->pdf =
      fma(1.0f - facets->further.lost, sum->pdf, facets->further.lost * part * fabs(c) * (1.0f / M_PI_F));
}

// The fraction of the surface that is a frosted wall: layered materials have metal and matte ground beside
// it.
HAVING(HAS_THIN_WALLS)
static inline float frosted_part(UNIFORM const Scene* scene, const Bsdf* bsdf) {
  float part = 1.0f;
  if (HAS_LAYERS && is_layered(bsdf)) EACH_ALIKE(int, index, bsdf->material) {
      __global const Layers* m = scene->layers + index;
      part = (1.0f - m->specular.w) * m->glass;
      if (HAS_LAYER_MAPS) part = (1.0f - bsdf->metalness) * bsdf->glass;
    }
  return real_max(part, 1e-6f);
}

// Single reflection and refraction by facets with normals h. `below`: of transmission. For frosted walls wi
// is mirrored, for which refraction's Jacobian with eta 1 equals reflection's.
static inline LobeSum facet_light(UNIFORM const Scene* scene, const Bsdf* bsdf, const Microfacet* facets,
                                  float eta, float3 wo, float3 wi, float3 h, bool below) {
  const float cos_i = dot(bsdf->ns, wi), wo_h = dot(wo, h), wi_h = dot(wi, h);
  Bsdf facet = *bsdf;
  facet.ns = h;
  const Interface interface = make_interface(scene, &facet, wo);
  const float chance = facet_reflects(facets, &interface);
  const float bent = fma(eta, wi_h, wo_h);
  const float jacobian =
      below ? eta * eta * fabs(wi_h) / real_max(bent * bent, 1e-20f) : 0.25f / real_max(wo_h, 1e-6f);
  const float cos_o = real_max(dot(bsdf->ns, wo), 1e-6f);
  const float seen = facet_pdf(bsdf->ns, h, facets->alpha) * wo_h / cos_o * jacobian;
  const float lambda_i = smith_lambda(fabs(cos_i), facets->alpha);
  float3 color = below ? interface.kt : interface.kr;
  if (facets->gain > 0.0f) {
    const float more = fma(facets->gain, microfacet_gain(scene, cos_i, facets->alpha), -1.0f);
    // Multiply scattered light of a frosted wall may leave on either side.
    float3 kept = own_color(bsdf, color);
    if (HAS_THIN_WALLS && is_frosted(facets))
      kept = (interface.kr + interface.kt) * (1.0f / frosted_part(scene, bsdf));
    color = (float3)(color.x * fma(kept.x, more, 1.0f), color.y * fma(kept.y, more, 1.0f),
                     color.z * fma(kept.z, more, 1.0f));
  }
  const LobeSum light = {color * (M_PI_F * seen / (1.0f + facets->lambda_o + lambda_i)),
                         seen / (1.0f + facets->lambda_o) * (below ? 1.0f - chance : chance)};
  return light;
}

static inline float share_ggx(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, LobeSet* lobes) {
  const float through = lobes->rough.transmits ? greatest(lobes->interface.kt) : 0.0f;
  return lobes->rough.rough ? greatest(lobes->interface.kr) + through : 0.0f;
}

// Light that scatters between facets comes back: a rough interface returns about what a smooth one does.
static inline float3 albedo_ggx(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                float3 wo) {
  const float3 none = (float3)(0.0f), through = lobes->rough.transmits ? lobes->interface.kt : none;
  return lobes->rough.rough ? lobes->interface.kr + through : none;
}

// Behind an interface the pdf is over directions there; the BSDF has no factor for radiance in media of
// different index.
static inline void scatter_ggx(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes, float3 wo,
                               float3 wi, LobeSum* sum) {
  const Microfacet* facets = &lobes->rough;
  const float eta = lobes->interface.eta, cos_i = dot(bsdf->ns, wi);
  const bool above = facets->rough && is_above(bsdf, wi);
  const bool below = facets->transmits && cos_i < 0.0f && dot(bsdf->side, wi) < 0.0f;
  if (!(above || below)) return;
  const bool mirrored = below && is_frosted(facets), bent = below && !mirrored;
  const float3 from = mirrored ? reflect_direction(wi, bsdf->ns) : wi;
  const float3 h = facet_between(bsdf->ns, wo, from, eta, bent);
  LobeSum own = {(float3)(0.0f), 0.0f};
  if (dot(wo, h) > 0.0f && (!bent || dot(from, h) < 0.0f))
    own = facet_light(scene, bsdf, facets, eta, wo, from, h, below);
  if (HAS_ROUGH_GLASS && facets->glass) add_further(scene, bsdf, facets, eta, cos_i, &own);
  sum->value += own.value;
  sum->pdf += lobes->ggx * own.pdf;
}

// u->at chooses the facet's reflection or transmission, after multiple scattering of glass.
static inline float3 sample_ggx(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes, float3 wo,
                                const LobeNumbers* u, bool* below) {
  const Microfacet* facets = &lobes->rough;
  float side = u->at / lobes->ggx;
  if (HAS_ROUGH_GLASS && facets->glass) {
    if (side < facets->further.lost) {
      *below = side < facets->further.lost * facets->further.through;
      const float3 up = direction_about(bsdf->ns, real_sqrt(u->x), u->y);
      return *below ? -up : up;
    }
    side = (side - facets->further.lost) / real_max(1.0f - facets->further.lost, 1e-6f);
  }
  Bsdf facet = *bsdf;
  facet.ns = visible_normal(bsdf->ns, wo, facets->alpha, u->x, u->y);
  const Interface interface = make_interface(scene, &facet, wo);
  const float3 reflected = reflect_direction(-wo, facet.ns);
  *below = side >= facet_reflects(facets, &interface);
  if (!*below) return reflected;
  if (is_frosted(facets)) return reflect_direction(reflected, bsdf->ns);
  return refract_direction(-wo, facet.ns, interface.cos_i, interface.cos_t, interface.eta);
}

HAVING(HAS_CAUSTICS)
static inline bool drop_narrow_ggx(Bsdf* bsdf, LobeSet* lobes) {
  if (lobes->rough.alpha >= LEAST_WIDE_ALPHA) return false;
  const bool narrow = lobes->rough.rough;
  lobes->rough.rough = false;
  lobes->rough.bends = false;
  lobes->rough.transmits = false;
  if (HAS_THIN_WALLS) lobes->rough.frosted = false;
  return narrow;
}
