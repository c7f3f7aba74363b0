// Light from one side of a triangle of a mesh, uniform in area.
#include "plain/light/flat_light.cl"

// Heitz 2019, "A Low-Distortion Map Between Triangle and Square".
static inline LightSample sample_triangle(UNIFORM __global const Light* light, float3 p, float u_x,
                                          float u_y) {
  const float half_x = 0.5f * u_x, half_y = 0.5f * u_y;
  const bool upper = u_y > u_x;
  return sample_of_flat(light, p, upper ? half_x : u_x - half_y, upper ? u_y - half_x : half_y, 0.0f);
}

static inline float pdf_triangle(UNIFORM __global const Light* light, float3 p, float3 wi, float d) {
  return pdf_by_area(light, wi, d);
}

static inline float4 middle_triangle(UNIFORM __global const Light* light) {
  const float3 edges = light->edge_u.xyz + light->edge_v.xyz;
  return (float4)(light->position.xyz + edges * (1.0f / 3.0f), 0.1f * light->direction.w);
}

static inline Emission emit_triangle(UNIFORM __global const Light* light, float c, float e) {
  const float3 x = light->edge_u.xyz, y = light->edge_v.xyz;
  return emit_flat(light, light->position.xyz + (1.0f - sqrt(c)) * x + e * sqrt(c) * y);
}
