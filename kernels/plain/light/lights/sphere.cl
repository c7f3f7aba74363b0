// Light from the outside of a sphere.
#include "plain/light/light_sample.cl"

// Directions of the cone in which the sphere is seen (Shirley, Wang and Zimmerman 1996, section 3.2): 1 minus
// the cosine of its half angle; 0 from inside.
static inline float sphere_cap(UNIFORM __global const Light* light, float square) {
  const float radius = light->edge_u.w;
  const float sine2 = (radius * radius) / square;
  return sine2 < 1.0f ? sine2 / (1.0f + real_sqrt(real_max(1.0f - sine2, 0.0f))) : 0.0f;
}
static inline float cap_pdf(float cap) { return 1.0f / (2.0f * M_PI_F * real_max(cap, 1e-37f)); }

static inline LightSample sample_sphere(UNIFORM __global const Light* light, float3 p, float u_x, float u_y) {
  const float3 to = light->position.xyz - p, axis = safe_unit3(to);
  const float middle = dot(to, axis), square = middle * middle, cap = sphere_cap(light, square);
  const float drop = u_x * cap, sine2 = drop * (2.0f - drop);
  LightSample sample;
  sample.wi = direction_at(axis, 1.0f - drop, real_sqrt(sine2), u_y);
  // Rounding at the limb moves the surface most: rays end a little before it.
  const float radius2 = light->edge_u.w * light->edge_u.w;
  const float half_chord = real_sqrt(real_max(radius2 - square * sine2, 0.0f) + 1e-3f * radius2);
  sample.distance = real_max(middle * (1.0f - drop) - half_chord, 0.0f) * SHORT_OF_LIGHT;
  sample.pdf = cap_pdf(cap);
  sample.delta = false;
  sample.radiance = cap > 0.0f ? light->color.xyz : (float3)(0.0f);
  return sample;
}

static inline float pdf_sphere(UNIFORM __global const Light* light, float3 p, float3 wi, float d) {
  const float3 to = light->position.xyz - p;
  return cap_pdf(sphere_cap(light, dot(to, to)));
}

static inline float4 middle_sphere(UNIFORM __global const Light* light) {
  return (float4)(light->position.xyz, light->edge_u.w * light->edge_u.w);
}

// The square around the cone in which it is seen, at the distance of its middle.
static inline SeenLight corners_sphere(UNIFORM __global const Light* light, float3 p) {
  const float3 to = light->position.xyz - p, axis = safe_unit3(to);
  const float middle = dot(to, axis), sine = light->edge_u.w / nonzero(middle);
  const float half_side = 1.001f * light->edge_u.w * real_rsqrt(real_max(1.0f - sine * sine, 0.1f));
  float3 s, t;
  tangent_frame(axis, &s, &t);
  s = s * (2.0f * half_side);
  t = t * (2.0f * half_side);
  const bool in_front = sine < 0.9f && middle > 0.0f;
  return seen_square(along(along(to, -0.5f, s), -0.5f, t), s, t, in_front, false);
}

static inline Emission emit_sphere(UNIFORM __global const Light* light, float c, float e) {
  const float radius = light->edge_u.w, up = 1.0f - 2.0f * c, side = sqrt(fmax(1.0f - up * up, 0.0f));
  const float3 n = (float3)(side * cospi(2.0f * e), side * sinpi(2.0f * e), up);
  return emit_from(light->position.xyz + radius * n, n, light->color.xyz, 4.0f * M_PI_F * radius * radius);
}
