// Light from a point into a cone with a soft edge.
#include "plain/light/lights/point.cl"

static inline LightSample sample_spot(UNIFORM __global const Light* light, float3 p) {
  LightSample sample = sample_point(light, p);
  const float cosine = -dot(sample.wi, light->direction.xyz);
  const float outer = light->direction.w, inner = light->edge_u.z;
  float s = cosine >= outer ? 1.0f : 0.0f;
  if (inner > outer) s = real_clamp((cosine - outer) / (inner - outer), 0.0f, 1.0f);
  sample.radiance *= s * s * (light->edge_u.x - light->edge_u.y * s);
  return sample;
}

static inline Emission emit_spot(UNIFORM __global const Light* light, float c, float e) {
  return emit_point(light, c, e);
}
