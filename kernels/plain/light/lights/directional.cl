// Parallel light.
#include "plain/light/light_sample.cl"

static inline LightSample sample_directional(UNIFORM __global const Light* light, float3 p) {
  const LightSample sample = {-light->direction.xyz, light->color.xyz, INFINITY, 1.0f, true};
  return sample;
}

static inline Emission emit_directional(UNIFORM __global const Light* light, float c, float e) {
  return emit_along(light->direction.xyz, M_PI_F * light->color.xyz);
}
