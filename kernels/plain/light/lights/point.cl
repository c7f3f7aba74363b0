// Light from a point to all sides.
#include "plain/light/light_sample.cl"

static inline LightSample sample_point(UNIFORM __global const Light* light, float3 p) {
  LightSample sample;
  sample.pdf = 1.0f;
  sample.delta = true;
  sample.radiance = light->color.xyz;
  const float3 to = light->position.xyz - p;
  sample.wi = safe_unit3(to);
  const float d = dot(to, sample.wi);
  sample.distance = d;
  if (light->falloff_linear != 0.0f || light->falloff_quadratic != 0.0f || light->falloff_constant != 1.0f)
    sample.radiance = sample.radiance / (float3)(fma(light->falloff_quadratic * d, d,
                                                     fma(light->falloff_linear, d, light->falloff_constant)));
  if (light->edge_v.x > 0.0f) {  // as KHR_lights_punctual suggests
    const float part = d * light->edge_v.x, square = part * part;
    sample.radiance *= real_max(1.0f - square * square, 0.0f);
  }
  return sample;
}

// Photons fall off where they are first bent: see dim_with_distance().
static inline Emission emit_point(UNIFORM __global const Light* light, float c, float e) {
  return emit_from(light->position.xyz, (float3)(0.0f), (float3)(1.0f), 0.0f);
}
