// Light from one side of a disk, uniform in area.
#include "plain/light/flat_light.cl"

static inline LightSample sample_disk(UNIFORM __global const Light* light, float3 p, float u_x, float u_y) {
  float x, y;
  place_in_disk(u_x, u_y, &x, &y);
  return sample_of_flat(light, p, x, y, 0.0f);
}

static inline float pdf_disk(UNIFORM __global const Light* light, float3 p, float3 wi, float d) {
  return pdf_by_area(light, wi, d);
}

static inline float4 middle_disk(UNIFORM __global const Light* light) {
  return (float4)(light->position.xyz, 0.1f * light->direction.w);
}

static inline SeenLight corners_disk(UNIFORM __global const Light* light, float3 p) {
  const float3 to = light->position.xyz - p, u = light->edge_u.xyz, v = light->edge_v.xyz;
  return seen_flat(light, to, to - u - v, u * 2.0f, v * 2.0f);
}

static inline Emission emit_disk(UNIFORM __global const Light* light, float c, float e) {
  const float3 x = light->edge_u.xyz, y = light->edge_v.xyz;
  return emit_flat(light, light->position.xyz + sqrt(c) * (cospi(2.0f * e) * x + sinpi(2.0f * e) * y));
}
