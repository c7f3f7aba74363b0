// Light from one side of a rectangle, uniform in solid angle or, far away, in area.
#include "plain/light/flat_light.cl"

// A rectangle that is seen under less, in steradians, is sampled by area: the difference of angles has few
// digits left.
#define LEAST_SOLID_ANGLE 0.01f

// Whether irradiance by the light has a closed form, and see_rectangle() serves all samples of a point.
static inline UNIFORM bool is_rectangle(UNIFORM __global const Light* light) {
  return light->kind == LIGHT_RECTANGLE;
}

// A rectangle seen from a point (Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for
// Spherical Rectangles"): its sides in axes along its edges, `z` behind the point along -z.
typedef struct SphericalRectangle {
  float x0, y0, x1, y1, z;
  float b0, b1, k, solid_angle;
} SphericalRectangle;

// The z of the normal of the plane through the point and a side, at `side` from it; zz: the distance squared.
static inline float side_normal(float side, float zz) {
  return side * real_rsqrt(real_max(fma(side, side, zz), 1e-37f));
}
static inline float angle_between(float a, float b) { return real_acos(real_clamp(-a * b, -1.0f, 1.0f)); }

static inline SphericalRectangle see_rectangle(UNIFORM __global const Light* light, float3 p) {
  SphericalRectangle r;
  const float3 x = light->edge_u.xyz / light->edge_u.w, y = light->edge_v.xyz / light->edge_v.w;
  const float3 to = light->position.xyz - p;
  r.x0 = dot(to, x);
  r.y0 = dot(to, y);
  r.x1 = r.x0 + light->edge_u.w;
  r.y1 = r.y0 + light->edge_v.w;
  r.z = -fabs(dot(to, light->direction.xyz));
  const float zz = r.z * r.z;
  const float n0 = -side_normal(r.y0, zz), n1 = side_normal(r.x1, zz), n2 = side_normal(r.y1, zz),
              n3 = -side_normal(r.x0, zz);
  r.b0 = n0;
  r.b1 = n2;
  r.k = 2.0f * M_PI_F - angle_between(n2, n3) - angle_between(n3, n0);
  r.solid_angle = angle_between(n0, n1) + angle_between(n1, n2) - r.k;
  return r;
}

// The place on the rectangle, in its axes, that the numbers u stand for.
static inline void place_in_rectangle(const SphericalRectangle* r, float u_x, float u_y, float* x, float* y) {
  float sine, cosine;
  sincos_of_turn(fma(u_x, r->solid_angle, r->k) * (0.5f / M_PI_F), &sine, &cosine);
  const float f = (cosine * r->b0 - r->b1) / nonzero(sine);
  const float cu = real_clamp(copysign(real_rsqrt(real_max(fma(f, f, r->b0 * r->b0), 1e-37f)), f),
                              -0.9999999f, 0.9999999f);
  const float across = real_clamp(-cu * r->z * real_rsqrt((1.0f - cu) * (1.0f + cu)), r->x0, r->x1);
  const float dd = fma(across, across, r->z * r->z), d = real_sqrt(dd);
  const float h0 = side_normal(r->y0, dd), h = fma(u_y, side_normal(r->y1, dd) - h0, h0);
  const float rest = (1.0f - h) * (1.0f + h);
  *x = across;
  *y = real_clamp(h * d * real_rsqrt(real_max(rest, 1e-14f)), r->y0, r->y1);
}

static inline float used_solid_angle(const SphericalRectangle* r) {
  return r->solid_angle > LEAST_SOLID_ANGLE ? r->solid_angle : 0.0f;
}

static inline LightSample sample_seen_rectangle(UNIFORM __global const Light* light,
                                                const SphericalRectangle* r, float3 p, float u_x, float u_y) {
  float x, y;
  place_in_rectangle(r, u_x, u_y, &x, &y);
  const float used = used_solid_angle(r);
  const bool by_angle = used > 0.0f;
  x = by_angle ? (x - r->x0) / light->edge_u.w : u_x;
  y = by_angle ? (y - r->y0) / light->edge_v.w : u_y;
  return sample_of_flat(light, p, x, y, used);
}

static inline LightSample sample_rectangle(UNIFORM __global const Light* light, float3 p, float u_x,
                                           float u_y) {
  const SphericalRectangle r = see_rectangle(light, p);
  return sample_seen_rectangle(light, &r, p, u_x, u_y);
}

static inline float pdf_rectangle(UNIFORM __global const Light* light, float3 p, float3 wi, float d) {
  const SphericalRectangle r = see_rectangle(light, p);
  const float used = used_solid_angle(&r);
  return used > 0.0f ? 1.0f / used : pdf_by_area(light, wi, d);
}

static inline float4 middle_rectangle(UNIFORM __global const Light* light) {
  const float3 edges = light->edge_u.xyz + light->edge_v.xyz;
  return (float4)(light->position.xyz + 0.5f * edges, 0.1f * light->direction.w);
}

static inline SeenLight corners_rectangle(UNIFORM __global const Light* light, float3 p) {
  const float3 to = light->position.xyz - p;
  return seen_flat(light, to, to, light->edge_u.xyz, light->edge_v.xyz);
}

static inline Emission emit_rectangle(UNIFORM __global const Light* light, float c, float e) {
  return emit_flat(light, light->position.xyz + c * light->edge_u.xyz + e * light->edge_v.xyz);
}
