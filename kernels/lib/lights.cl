// Light arriving at points, and what surfaces make of it (Phong 1975, Blinn 1977). A point a lane.
#ifndef SUNDOG_LIB_LIGHTS_CL
#define SUNDOG_LIB_LIGHTS_CL
#include "lib/surface.cl"
#include "lib/tables.h"

typedef struct LightSamples {
  REAL3 wi;        // unit, from the surface to the light
  REAL distance;   // infinite for a directional light
  REAL3 radiance;  // before shadowing
} LightSamples;

static inline LightSamples sample_light(__global const Light* light, REAL3 p) {
  LightSamples sample;
  sample.radiance = all3(light->color.xyz);
  if (light->kind == LIGHT_DIRECTIONAL) {
    sample.wi = all3(-light->direction.xyz);
    sample.distance = (REAL)(INFINITY);
    return sample;
  }
  const REAL3 to = subtract3(all3(light->position.xyz), p);
  sample.wi = safe_unit3(to);
  const REAL d = dot3(to, sample.wi);
  sample.distance = d;
  if (light->falloff_linear != 0.0f || light->falloff_quadratic != 0.0f || light->falloff_constant != 1.0f) {
    const REAL falloff = fma(light->falloff_quadratic * d, d,
                             fma((REAL)(light->falloff_linear), d, (REAL)(light->falloff_constant)));
    sample.radiance =
        real3(sample.radiance.x / falloff, sample.radiance.y / falloff, sample.radiance.z / falloff);
  }
  if (light->kind == LIGHT_SPOT) {
    const REAL cosine = -dot3(sample.wi, all3(light->direction.xyz));
    const float outer = light->direction.w, inner = light->color.w;
    const REAL one = (REAL)(1.0f), zero = (REAL)(0.0f);
    const REAL s = inner > outer ? real_clamp((cosine - outer) / (inner - outer), zero, one)
                                 : select(zero, one, MASK_OF(cosine >= outer));
    sample.radiance = scale3(sample.radiance, s * s * (3.0f - 2.0f * s));
  }
  return sample;
}

// x^e for x in [0, 1]. Whole exponents, which most are, by squaring.
static inline REAL highlight(REAL x, float e) {
#if HAS_FRACTIONAL_EXPONENTS
  if (e != floor(e) || e > GREATEST_WHOLE_EXPONENT)
    return select(real_exp(e * real_log(real_max(x, (REAL)(1e-37f)))), (REAL)(0.0f), MASK_OF(x < 1e-37f));
#endif
  REAL result = (REAL)(1.0f);
  for (u32 bits = (u32)e; bits; bits >>= 1) {
    if (bits & 1u) result *= x;
    x *= x;
  }
  return result;
}

// kd (n.l) + ks max(r.v, 0)^beta, or max(n.h, 0)^beta for Blinn, where 0^0 is 1: with a beta of
// 0 a highlight is the same from everywhere. For the lanes of `lanes`. d are the rays' directions, so the
// viewer is along -d.
static inline REAL3 local_reflection(__global const Material* restrict materials, const Faces* faces,
                                     const Surfaces* s, REAL3 d, REAL3 wi, MASK lanes) {
  const REAL n_dot_l = dot3(s->ns, wi);
  REAL3 sum = scale3(s->diffuse, n_dot_l);
  u32 index;
  while (any_lane(lanes)) {
    const MASK mine = take_alike(faces->material, &lanes, &index);
    const float4 specular = materials[index].specular;
    if (specular.x == 0.0f && specular.y == 0.0f && specular.z == 0.0f) continue;
    const REAL cosine = materials[index].flags & MATERIAL_BLINN
                            ? dot3(s->ns, safe_unit3(subtract3(wi, d)))
                            : dot3(subtract3(wi, scale3(s->ns, 2.0f * n_dot_l)), d);
    const REAL shine = highlight(real_clamp(cosine, (REAL)(0.0f), (REAL)(1.0f)), specular.w);
    const MASK shines = specular.w == 0.0f ? mine : mine & MASK_OF(cosine > 0.0f);
    sum = select3(sum, along3(sum, shine, all3(specular.xyz)), shines);
  }
  return sum;
}

#endif
