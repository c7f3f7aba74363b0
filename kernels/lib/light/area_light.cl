// Lights with an extent: places on them, points on them for points in the world, uniform in solid angle where
// that is known in closed form, else uniform in area; and the density of a given direction. A point a lane.
#ifndef SUNDOG_LIB_AREA_LIGHT_CL
#define SUNDOG_LIB_AREA_LIGHT_CL
#include "lib/core/directions.cl"
#include "lib/core/tables.h"
#include "plain/light/light_sample.cl"

// A rectangle that is seen under less, in steradians, is sampled by area: the difference of angles has few
// digits left.
#define LEAST_SOLID_ANGLE 0.01f
// The part of the way to a light that shadow rays leave out, since the light's own surface lies at its end.
#define SHORT_OF_LIGHT 0x1.ffep-1f

// Whether a light has a position: it is neither parallel nor an environment.
static inline bool has_place(__global const Light* light) {
  return light->kind != LIGHT_DIRECTIONAL && light->kind != LIGHT_SUN && light->kind != LIGHT_ENVIRONMENT;
}

// The middle of a light; w: the square of its size. Shorter distances to the middle mean nothing.
static inline float4 middle_of_light(__global const Light* light) {
  const float3 corner = light->position.xyz, edges = light->edge_u.xyz + light->edge_v.xyz;
  if (light->kind == LIGHT_RECTANGLE) return (float4)(corner + 0.5f * edges, 0.1f * light->direction.w);
  if (light->kind == LIGHT_TRIANGLE)
    return (float4)(corner + edges * (1.0f / 3.0f), 0.1f * light->direction.w);
  if (light->kind == LIGHT_DISK) return (float4)(corner, 0.1f * light->direction.w);
  return (float4)(corner, light->kind == LIGHT_SPHERE ? light->edge_u.w * light->edge_u.w : 0.0f);
}

// A place on a light with an extent, the normal there, and the light's area.
static inline float3 place_on_light(__global const Light* light, float c, float e, float3* n, float* area) {
  *n = light->direction.xyz;
  *area = light->direction.w;
  const float3 corner = light->position.xyz, x = light->edge_u.xyz, y = light->edge_v.xyz;
  if (light->kind == LIGHT_RECTANGLE) return corner + c * x + e * y;
  if (light->kind == LIGHT_DISK) return corner + sqrt(c) * (cospi(2.0f * e) * x + sinpi(2.0f * e) * y);
  if (light->kind == LIGHT_TRIANGLE) return corner + (1.0f - sqrt(c)) * x + e * sqrt(c) * y;
  const float up = 1.0f - 2.0f * c, side = sqrt(fmax(1.0f - up * up, 0.0f));
  *n = (float3)(side * cospi(2.0f * e), side * sinpi(2.0f * e), up);
  *area = 4.0f * M_PI_F * light->edge_u.w * light->edge_u.w;
  return corner + light->edge_u.w * *n;
}

// What points see of a rectangle (Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for
// Spherical Rectangles"): its sides in axes along its edges, `z` behind the point along -z.
typedef struct SphericalRectangles {
  REAL x0, y0, x1, y1, z;
  REAL b0, b1, k, solid_angle;
} SphericalRectangles;

static inline SphericalRectangles see_rectangle(__global const Light* light, REAL3 p) {
  SphericalRectangles r;
  const float3 x = light->edge_u.xyz / light->edge_u.w, y = light->edge_v.xyz / light->edge_v.w;
  const REAL3 to = subtract3(all3(light->position.xyz), p);
  r.x0 = dot3(to, all3(x));
  r.y0 = dot3(to, all3(y));
  r.x1 = r.x0 + light->edge_u.w;
  r.y1 = r.y0 + light->edge_v.w;
  r.z = -fabs(dot3(to, all3(light->direction.xyz)));
  const REAL zz = r.z * r.z;
  // The z of the normals of the planes through the point and the four sides.
  const REAL n0 = -r.y0 * real_rsqrt(real_max(fma(r.y0, r.y0, zz), (REAL)(1e-37f))),
             n1 = r.x1 * real_rsqrt(real_max(fma(r.x1, r.x1, zz), (REAL)(1e-37f))),
             n2 = r.y1 * real_rsqrt(real_max(fma(r.y1, r.y1, zz), (REAL)(1e-37f))),
             n3 = -r.x0 * real_rsqrt(real_max(fma(r.x0, r.x0, zz), (REAL)(1e-37f)));
  const REAL one = (REAL)(1.0f);
  const REAL g0 = real_acos(real_clamp(-n0 * n1, -one, one)), g1 = real_acos(real_clamp(-n1 * n2, -one, one)),
             g2 = real_acos(real_clamp(-n2 * n3, -one, one)), g3 = real_acos(real_clamp(-n3 * n0, -one, one));
  r.b0 = n0;
  r.b1 = n2;
  r.k = 2.0f * M_PI_F - g2 - g3;
  r.solid_angle = g0 + g1 - r.k;
  return r;
}

// The place on the rectangle, in its axes, that the numbers u stand for.
static inline void place_in_rectangle(const SphericalRectangles* r, REAL u_x, REAL u_y, REAL* x, REAL* y) {
  REAL sine, cosine;
  sincos_of_turn(fma(u_x, r->solid_angle, r->k) * (0.5f / M_PI_F), &sine, &cosine);
  const REAL f = (cosine * r->b0 - r->b1) / nonzero(sine);
  const REAL cu = real_clamp(copysign(real_rsqrt(real_max(fma(f, f, r->b0 * r->b0), (REAL)(1e-37f))), f),
                             (REAL)(-0.9999999f), (REAL)(0.9999999f));
  *x = real_clamp(-cu * r->z * real_rsqrt((1.0f - cu) * (1.0f + cu)), r->x0, r->x1);
  const REAL dd = fma(*x, *x, r->z * r->z), d = real_sqrt(dd);
  const REAL h0 = r->y0 * real_rsqrt(real_max(fma(r->y0, r->y0, dd), (REAL)(1e-37f))),
             h1 = r->y1 * real_rsqrt(real_max(fma(r->y1, r->y1, dd), (REAL)(1e-37f)));
  const REAL h = fma(u_y, h1 - h0, h0), rest = (1.0f - h) * (1.0f + h);
  *y = real_clamp(h * d * real_rsqrt(real_max(rest, (REAL)(1e-14f))), r->y0, r->y1);
}

// The density, per steradian, of directions to points that are uniform on the light's area: at the distance
// d along wi.
static inline REAL pdf_by_area(__global const Light* light, REAL3 wi, REAL d) {
  const REAL cosine = fabs(dot3(wi, all3(light->direction.xyz)));
  return d * d / real_max(cosine * light->direction.w, (REAL)(1e-37f));
}

// Samples of a flat light at the points that lie at `to` from p: by area, or, where it is above 0, of the
// given solid angle. The back is black.
static inline LightSamples sample_of_flat(__global const Light* light, REAL3 to, REAL solid_angle) {
  LightSamples sample;
  sample.wi = safe_unit3(to);
  sample.distance = dot3(to, sample.wi);
  sample.delta = NO_LANES;
  const MASK by_angle = MASK_OF(solid_angle > 0.0f);
  sample.pdf = select(pdf_by_area(light, sample.wi, sample.distance),
                      1.0f / select((REAL)(1.0f), solid_angle, by_angle), by_angle);
  const MASK front = MASK_OF(dot3(sample.wi, all3(light->direction.xyz)) < 0.0f);
  sample.radiance = select3(all3((float3)(0.0f)), all3(light->color.xyz), front);
  sample.distance *= SHORT_OF_LIGHT;
  return sample;
}

static inline REAL used_solid_angle(const SphericalRectangles* r) {
  return select((REAL)(0.0f), r->solid_angle, MASK_OF(r->solid_angle > LEAST_SOLID_ANGLE));
}

static inline LightSamples sample_seen_rectangle(__global const Light* light, const SphericalRectangles* r,
                                                 REAL3 p, REAL u_x, REAL u_y) {
  REAL x, y;
  place_in_rectangle(r, u_x, u_y, &x, &y);
  const REAL used = used_solid_angle(r);
  const MASK by_angle = MASK_OF(used > 0.0f);
  x = select(u_x, (x - r->x0) / light->edge_u.w, by_angle);
  y = select(u_y, (y - r->y0) / light->edge_v.w, by_angle);
  REAL3 to = subtract3(all3(light->position.xyz), p);
  to = along3(along3(to, x, all3(light->edge_u.xyz)), y, all3(light->edge_v.xyz));
  return sample_of_flat(light, to, used);
}

static inline LightSamples sample_rectangle(__global const Light* light, REAL3 p, REAL u_x, REAL u_y) {
  const SphericalRectangles r = see_rectangle(light, p);
  return sample_seen_rectangle(light, &r, p, u_x, u_y);
}

// Uniform in area (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
static inline LightSamples sample_triangle(__global const Light* light, REAL3 p, REAL u_x, REAL u_y) {
  const REAL half_x = 0.5f * u_x, half_y = 0.5f * u_y;
  const MASK upper = MASK_OF(u_y > u_x);
  const REAL x = select(u_x - half_y, half_x, upper), y = select(half_y, u_y - half_x, upper);
  REAL3 to = subtract3(all3(light->position.xyz), p);
  to = along3(along3(to, x, all3(light->edge_u.xyz)), y, all3(light->edge_v.xyz));
  return sample_of_flat(light, to, (REAL)(0.0f));
}

static inline LightSamples sample_disk(__global const Light* light, REAL3 p, REAL u_x, REAL u_y) {
  REAL x, y;
  place_in_disk(u_x, u_y, &x, &y);
  REAL3 to = subtract3(all3(light->position.xyz), p);
  to = along3(along3(to, x, all3(light->edge_u.xyz)), y, all3(light->edge_v.xyz));
  return sample_of_flat(light, to, (REAL)(0.0f));
}

// What a point sees of a sphere: 1 minus the cosine of the cone's half angle; 0 from inside.
static inline REAL sphere_cap(__global const Light* light, REAL square) {
  const float radius = light->edge_u.w;
  const REAL sine2 = (radius * radius) / square;
  const REAL cap = sine2 / (1.0f + real_sqrt(real_max(1.0f - sine2, (REAL)(0.0f))));
  return select((REAL)(0.0f), cap, MASK_OF(sine2 < 1.0f));
}

static inline REAL sphere_pdf(REAL cap) { return 1.0f / (2.0f * M_PI_F * real_max(cap, (REAL)(1e-37f))); }

// Directions of the cone in which the sphere is seen (Shirley, Wang and Zimmerman 1996, section 3.2).
static inline LightSamples sample_sphere(__global const Light* light, REAL3 p, REAL u_x, REAL u_y) {
  const REAL3 to = subtract3(all3(light->position.xyz), p), axis = safe_unit3(to);
  const REAL middle = dot3(to, axis), square = middle * middle, cap = sphere_cap(light, square);
  const REAL drop = u_x * cap, sine2 = drop * (2.0f - drop);
  LightSamples sample;
  sample.wi = direction_at(axis, 1.0f - drop, real_sqrt(sine2), u_y);
  // Rounding at the limb moves the surface most: rays end a little before it.
  const float radius2 = light->edge_u.w * light->edge_u.w;
  const REAL half_chord = real_sqrt(real_max(radius2 - square * sine2, (REAL)(0.0f)) + 1e-3f * radius2);
  sample.distance = real_max(middle * (1.0f - drop) - half_chord, (REAL)(0.0f)) * SHORT_OF_LIGHT;
  sample.pdf = sphere_pdf(cap);
  sample.delta = NO_LANES;
  sample.radiance = select3(all3((float3)(0.0f)), all3(light->color.xyz), MASK_OF(cap > 0.0f));
  return sample;
}

static inline LightSamples sample_area_light(__global const Light* light, REAL3 p, REAL u_x, REAL u_y) {
  if (light->kind == LIGHT_RECTANGLE) return sample_rectangle(light, p, u_x, u_y);
  if (light->kind == LIGHT_DISK) return sample_disk(light, p, u_x, u_y);
  if (light->kind == LIGHT_TRIANGLE) return sample_triangle(light, p, u_x, u_y);
  return sample_sphere(light, p, u_x, u_y);
}

// The density, per steradian, with which sample_area_light() chooses the direction wi from p, which meets the
// light at the distance d.
static inline REAL area_light_pdf(__global const Light* light, REAL3 p, REAL3 wi, REAL d) {
  if (light->kind == LIGHT_SPHERE) {
    const REAL3 to = subtract3(all3(light->position.xyz), p);
    return sphere_pdf(sphere_cap(light, dot3(to, to)));
  }
  const REAL by_area = pdf_by_area(light, wi, d);
  if (light->kind != LIGHT_RECTANGLE) return by_area;
  const SphericalRectangles r = see_rectangle(light, p);
  const REAL used = used_solid_angle(&r);
  const MASK by_angle = MASK_OF(used > 0.0f);
  return select(by_area, 1.0f / select((REAL)(1.0f), used, by_angle), by_angle);
}

#endif
