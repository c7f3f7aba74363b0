// Light arriving at a point, and what a surface makes of it (Phong 1975, Blinn 1977).
#ifndef SUNDOG_LIB_LIGHTS_CL
#define SUNDOG_LIB_LIGHTS_CL
#include "lib/config.h"
#include "lib/surface.cl"
#include "lib/tables.h"

typedef struct LightSample {
  float3 wi;        // unit, from the surface to the light
  float distance;   // infinite for a directional light
  float3 radiance;  // before shadowing
} LightSample;

static inline LightSample sample_light(__global const Light* light, float3 p) {
  LightSample sample;
  sample.radiance = light->color.xyz;
  if (light->kind == LIGHT_DIRECTIONAL) {
    sample.wi = -light->direction.xyz;
    sample.distance = INFINITY;
    return sample;
  }
  const float3 to = light->position.xyz - p;
  sample.wi = unit(to);
  const float d = dot(to, sample.wi);
  sample.distance = d;
  sample.radiance /=
      fma(light->falloff_quadratic * d, d, fma(light->falloff_linear, d, light->falloff_constant));
  if (light->kind == LIGHT_SPOT) {
    const float cosine = -dot(sample.wi, light->direction.xyz), outer = light->direction.w,
                inner = light->color.w;
    const float s = inner > outer ? clamp((cosine - outer) / (inner - outer), 0.0f, 1.0f)
                                  : (cosine >= outer ? 1.0f : 0.0f);
    sample.radiance *= s * s * (3.0f - 2.0f * s);
  }
  return sample;
}

// x^e for x in [0, 1]. Whole exponents, which most are, by squaring: quicker than pow(), and the same bits on
// every device.
static inline float highlight(float x, float e) {
  if (e != floor(e) || e > 65535.0f) return pow(x, e);
  float result = 1.0f;
  for (u32 bits = (u32)e; bits; bits >>= 1) {
    if (bits & 1u) result *= x;
    x *= x;
  }
  return result;
}

// kd (n.l) + ks (r.v)^beta, or (n.h)^beta for Blinn. d is the ray's direction, so the viewer is along -d.
static inline float3 local_reflection(__global const Material* material, const SurfaceInteraction* s,
                                      float3 d, float3 wi) {
  const float n_dot_l = dot(s->ns, wi);
  float3 sum = s->diffuse * n_dot_l;
  const float4 specular = material->specular;
  if (specular.x != 0.0f || specular.y != 0.0f || specular.z != 0.0f) {
    float cosine;
    if (material->flags & MATERIAL_BLINN)
      cosine = dot(s->ns, unit(wi - d));
    else
      cosine = dot(2.0f * n_dot_l * s->ns - wi, -d);
    if (cosine > 0.0f) sum += specular.xyz * highlight(fmin(cosine, 1.0f), specular.w);
  }
  return sum;
}

#endif
