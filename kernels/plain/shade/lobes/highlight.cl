// Phong's and Blinn's highlights (Phong 1975, Blinn 1977).
#include "plain/shade/lobe_set.h"

HAVING(HAS_HIGHLIGHTS);

static inline float share_highlight(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, LobeSet* lobes) {
  float share = 0.0f;
  lobes->blinn = (bsdf->flags & (int)MATERIAL_BLINN) != 0;
  lobes->exponent = 0.0f;
  if (HAS_MAPS) {
    share = greatest(bsdf->specular);
    lobes->exponent = bsdf->exponent;
  } else {
    if ((bsdf->flags & (int)MATERIAL_SHINES) != 0) EACH_ALIKE(int, index, bsdf->material) {
        const float4 specular = scene->materials[index].specular;
        share = fmax(specular.x, fmax(specular.y, specular.z));
        lobes->exponent = specular.w;
      }
  }
  return share;
}

// Phong's for a viewer along the normal, in closed form.
static inline float3 albedo_highlight(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                      float3 wo) {
  float3 color = (float3)(0.0f);
  if (HAS_MAPS) color = bsdf->specular;
  if (!HAS_MAPS && has_highlight(bsdf))
    EACH_ALIKE(int, index, bsdf->material) color = scene->materials[index].specular.xyz;
  return color * (2.0f / (lobes->exponent + 1.0f));
}

// x^e for x in [0, 1]. Integer exponents, the common case, by squaring.
static inline float highlight(float x, UNIFORM float e) {
  if (HAS_FRACTIONAL_EXPONENTS && (e != floor(e) || e > GREATEST_WHOLE_EXPONENT))
    return x < 1e-37f ? 0.0f : real_exp(e * real_log(real_max(x, 1e-37f)));
  float result = 1.0f, power = x;
  for (u32 bits = (u32)e; bits; bits = bits >> 1u) {
    if ((bits & 1u) != 0u) result *= power;
    power *= power;
  }
  return result;
}

// Cosine that a highlight falls off with: between the reflected light and the viewer or, for Blinn, between
// the normal and the half vector.
static inline float highlight_cosine(bool blinn, float3 ns, float3 wo, float3 wi) {
  float cosine;
  if (blinn)
    cosine = dot(ns, safe_unit3(wi + wo));
  else
    cosine = -dot(wi - ns * (2.0f * dot(ns, wi)), wo);
  return cosine;
}

// ks max(r.v, 0)^e, or max(n.h, 0)^e for Blinn, where 0^0 is 1: with e = 0 a highlight is uniform. Colour and
// exponent may come from textures, so the exponent may be fractional.
static inline void local_highlight(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, float3 wi,
                                   bool met, float3* light) {
  if (!has_highlight(bsdf)) return;
  if (HAS_MAPS) {
    const float cosine = highlight_cosine((bsdf->flags & (int)MATERIAL_BLINN) != 0, bsdf->ns, wo, wi);
    const float x = real_clamp(cosine, 0.0f, 1.0f);
    const float power = real_exp(bsdf->exponent * real_log(real_max(x, 1e-37f)));
    *light += bsdf->specular * (x < 1e-37f && bsdf->exponent > 0.0f ? 0.0f : power);
  } else {
    EACH_ALIKE(int, index, bsdf->material) {
      const float4 specular = scene->materials[index].specular;
      const bool blinn = (scene->materials[index].flags & MATERIAL_BLINN) != 0u;
      const float cosine = highlight_cosine(blinn, bsdf->ns, wo, wi);
      const float shine = highlight(real_clamp(cosine, 0.0f, 1.0f), specular.w);
      if (specular.w == 0.0f || cosine > 0.0f) *light = along(*light, shine, specular.xyz);
    }
  }
}

// Density of directions on the hemisphere of an axis, proportional to c^e for the cosine c.
static inline float lobe_pdf(float c, float e) {
  const float value = (e + 1.0f) * (0.5f / M_PI_F) * pow(real_max(c, 0.0f), e);
  return c > 0.0f ? value : 0.0f;
}

static inline void scatter_highlight(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                     float3 wo, float3 wi, LobeSum* sum) {
  if (!(lobes->highlight > 0.0f && is_above(bsdf, wi))) return;
  local_highlight(scene, bsdf, wo, wi, false, &sum->value);
  const float3 h = safe_unit3(wi + wo), mirrored = reflect_direction(-wo, bsdf->ns);
  const float cosine = lobes->blinn ? dot(bsdf->ns, h) : dot(mirrored, wi);
  const float turned = lobes->blinn ? 4.0f * real_max(dot(wo, h), 1e-6f) : 1.0f;
  sum->pdf += lobes->highlight * (lobe_pdf(cosine, lobes->exponent) / turned);
}

static inline float3 sample_highlight(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                      float3 wo, const LobeNumbers* u, bool* below) {
  const float cosine = pow(real_max(u->x, 1e-30f), 1.0f / (lobes->exponent + 1.0f));
  const float3 half_vector = direction_about(bsdf->ns, cosine, u->y);
  return lobes->blinn ? half_vector * (2.0f * dot(half_vector, wo)) - wo
                      : direction_about(reflect_direction(-wo, bsdf->ns), cosine, u->y);
}

// cos^e is about as wide as facets with alpha = sqrt(2 / (e + 2)).
HAVING(HAS_CAUSTICS)
static inline bool drop_narrow_highlight(Bsdf* bsdf, LobeSet* lobes) {
  if (!(lobes->exponent > 2.0f / (LEAST_WIDE_ALPHA * LEAST_WIDE_ALPHA) - 2.0f)) return false;
  if (HAS_MAPS) bsdf->specular = (float3)(0.0f);
  if (!HAS_MAPS) bsdf->flags &= ~(int)MATERIAL_SHINES;
  return true;
}
