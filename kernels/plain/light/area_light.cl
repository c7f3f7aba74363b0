// Lights with an extent: points on them for points in the world, uniform in solid angle where that is known
// in closed form, else uniform in area; and the density of a given direction.
#include "plain/light/light_sample.cl"

// A rectangle that is seen under less, in steradians, is sampled by area: the difference of angles has few
// digits left.
#define LEAST_SOLID_ANGLE 0.01f

// What a point sees of a rectangle (Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for
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

ENTRY static inline SphericalRectangle see_rectangle(UNIFORM __global const Light* light, float3 p) {
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

// The density, per steradian, of directions to points that are uniform on the light's area: at the distance
// d along wi.
static inline float pdf_by_area(UNIFORM __global const Light* light, float3 wi, float d) {
  const float cosine = fabs(dot(wi, light->direction.xyz));
  return d * d / real_max(cosine * light->direction.w, 1e-37f);
}

// A sample of a flat light at the place (x, y) of its edges: by area, or, where it is above 0, of the given
// solid angle. The back is black.
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

static inline float used_solid_angle(const SphericalRectangle* r) {
  return r->solid_angle > LEAST_SOLID_ANGLE ? r->solid_angle : 0.0f;
}

ENTRY static inline LightSample sample_seen_rectangle(UNIFORM __global const Light* light,
                                                      const SphericalRectangle* r, float3 p, float u_x,
                                                      float u_y) {
  float x, y;
  place_in_rectangle(r, u_x, u_y, &x, &y);
  const float used = used_solid_angle(r);
  const bool by_angle = used > 0.0f;
  x = by_angle ? (x - r->x0) / light->edge_u.w : u_x;
  y = by_angle ? (y - r->y0) / light->edge_v.w : u_y;
  return sample_of_flat(light, p, x, y, used);
}

// Directions of the cone in which the sphere is seen (Shirley, Wang and Zimmerman 1996, section 3.2): 1 minus
// the cosine of its half angle; 0 from inside.
static inline float sphere_cap(UNIFORM __global const Light* light, float square) {
  const float radius = light->edge_u.w;
  const float sine2 = (radius * radius) / square;
  return sine2 < 1.0f ? sine2 / (1.0f + real_sqrt(real_max(1.0f - sine2, 0.0f))) : 0.0f;
}
static inline float sphere_pdf(float cap) { return 1.0f / (2.0f * M_PI_F * real_max(cap, 1e-37f)); }

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
  sample.pdf = sphere_pdf(cap);
  sample.delta = false;
  sample.radiance = cap > 0.0f ? light->color.xyz : (float3)(0.0f);
  return sample;
}

ENTRY static inline LightSample sample_area_light(UNIFORM __global const Light* light, float3 p, float u_x,
                                                  float u_y) {
  if (light->kind == LIGHT_RECTANGLE) {
    const SphericalRectangle r = see_rectangle(light, p);
    return sample_seen_rectangle(light, &r, p, u_x, u_y);
  }
  if (light->kind == LIGHT_DISK) {
    float x, y;
    place_in_disk(u_x, u_y, &x, &y);
    return sample_of_flat(light, p, x, y, 0.0f);
  }
  // Uniform in area (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
  if (light->kind == LIGHT_TRIANGLE) {
    const float half_x = 0.5f * u_x, half_y = 0.5f * u_y;
    const bool upper = u_y > u_x;
    return sample_of_flat(light, p, upper ? half_x : u_x - half_y, upper ? u_y - half_x : half_y, 0.0f);
  }
  return sample_sphere(light, p, u_x, u_y);
}

// The density, per steradian, with which sample_area_light() chooses the direction wi from p, which meets the
// light at the distance d.
ENTRY static inline float area_light_pdf(UNIFORM __global const Light* light, float3 p, float3 wi, float d) {
  if (light->kind == LIGHT_SPHERE) {
    const float3 to = light->position.xyz - p;
    return sphere_pdf(sphere_cap(light, dot(to, to)));
  }
  if (light->kind != LIGHT_RECTANGLE) return pdf_by_area(light, wi, d);
  const SphericalRectangle r = see_rectangle(light, p);
  const float used = used_solid_angle(&r);
  return used > 0.0f ? 1.0f / used : pdf_by_area(light, wi, d);
}
