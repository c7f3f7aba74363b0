// Code that flat lights with an extent share. Their backs are black.
#include "plain/light/light_sample.cl"

// The density, per steradian, of directions to points that are uniform on the light's area: at the distance
// d along wi.
static inline float pdf_by_area(UNIFORM __global const Light* light, float3 wi, float d) {
  const float cosine = fabs(dot(wi, light->direction.xyz));
  return d * d / real_max(cosine * light->direction.w, 1e-37f);
}

// A sample at the place (x, y) of the light's edges: by area, or, where it is above 0, of the given solid
// angle.
static inline LightSample sample_of_flat(UNIFORM __global const Light* light, float3 p, float x, float y,
                                         float solid_angle) {
  LightSample sample;
  const float3 to = along(along(light->position.xyz - p, x, light->edge_u.xyz), y, light->edge_v.xyz);
  sample.wi = safe_unit3(to);
  const float distance = dot(to, sample.wi);
  sample.delta = false;
  sample.pdf = solid_angle > 0.0f ? 1.0f / solid_angle : pdf_by_area(light, sample.wi, distance);
  const bool front = dot(sample.wi, light->direction.xyz) < 0.0f;
  sample.radiance = front ? light->color.xyz : (float3)(0.0f);
  sample.distance = distance * SHORT_OF_LIGHT;
  return sample;
}

static inline float sum_of_sizes(float3 a) { return fabs(a.x) + fabs(a.y) + fabs(a.z); }

// The light in a square with the first corner at `first`, from a point from which `to` leads to its plane.
static inline SeenLight seen_flat(UNIFORM __global const Light* light, float3 to, float3 first,
                                  UNIFORM float3 u, UNIFORM float3 v) {
  const float depth = -dot(to, light->direction.xyz);
  const float near = 1e-4f * (sum_of_sizes(to) + light->edge_u.w + light->edge_v.w);
  return seen_square(first, u, v, depth > near, depth < -near);
}

static inline Emission emit_flat(UNIFORM __global const Light* light, float3 place) {
  return emit_from(place, light->direction.xyz, light->color.xyz, light->direction.w);
}
