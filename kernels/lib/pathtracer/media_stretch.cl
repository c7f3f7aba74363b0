// Stretches of rays through media that scatter: where on them light is scattered, by the medium's decay or
// towards a light (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating
// Media"), and whereto (Henyey and Greenstein 1941). A ray a lane.
#ifndef SUNDOG_LIB_MEDIA_STRETCH_CL
#define SUNDOG_LIB_MEDIA_STRETCH_CL
#include "lib/core/directions.cl"
#include "lib/core/tables.h"

#if HAS_SCATTERING
// What a scattered path remembers of the stretch that it was scattered on.
typedef struct Scattered {
  MASK lanes;   // those that were scattered last by a medium
  REAL3 o, d;   // the stretch's beginning and direction
  REAL length;  // may be infinite
  REAL at;      // where on it
  REAL decay;   // of the medium, the mean of the colours
  REAL chance;  // the density of `at` by next_distance()
} Scattered;

#define TOWARDS_LIGHT 0.5f  // the greatest part of the distances that are chosen for a near light

// Of light, over a distance that may be infinite.
static inline REAL kept_over(REAL decay, REAL distance) {
  return select(real_exp(-decay * distance), (REAL)(1.0f), MASK_OF(decay == 0.0f));
}
static inline REAL3 kept_over3(REAL3 decay, REAL distance) {
  return real3(kept_over(decay.x, distance), kept_over(decay.y, distance), kept_over(decay.z, distance));
}

// 1 - exp(-x), and -log(1 - y), exact for small numbers.
static inline REAL lost_part(REAL x) {
  const REAL small = x * fma(x, fma(x, (REAL)(1.0f / 6.0f), (REAL)(-0.5f)), (REAL)(1.0f));
  return select(1.0f - real_exp(-x), small, MASK_OF(x < 0.01f));
}
static inline REAL depth_of_lost(REAL y) {
  const REAL small = y * fma(y, fma(y, (REAL)(1.0f / 3.0f), (REAL)(0.5f)), (REAL)(1.0f));
  return select(-real_log(real_max(1.0f - y, (REAL)(0x1p-24f))), small, MASK_OF(y < 0.01f));
}

// The component of `of` that the number u chooses by the shares, whose sum is 1.
static inline REAL by_share(REAL3 of, REAL3 shares, REAL u) {
  const REAL rest = select(of.y, of.z, MASK_OF(u >= shares.x + shares.y) & MASK_OF(shares.z > 0.0f));
  return select(rest, of.x, MASK_OF(u < shares.x));
}

// Positive numbers as shares; where all are 0, thirds.
static inline REAL3 shares_of(REAL3 a) {
  const REAL sum = a.x + a.y + a.z, third = (REAL)(1.0f / 3.0f);
  const MASK some = MASK_OF(sum > 0.0f) & MASK_OF(sum < INFINITY);
  return select3(real3(third, third, third), scale3(a, 1.0f / select((REAL)(1.0f), sum, some)), some);
}

// A distance within the length by the decay, and its density; u chooses it, u_color the decay's component.
static inline REAL next_distance(REAL3 decay, REAL3 shares, REAL length, REAL u, REAL u_color) {
  const REAL chosen = by_share(decay, shares, u_color);
  return real_min(depth_of_lost(u * lost_part(chosen * length)) / nonzero(chosen), length);
}
static inline REAL next_of(REAL decay, REAL share, REAL length, REAL at) {
  const MASK some = MASK_OF(share * decay > 0.0f);
  const REAL lost = lost_part(decay * length);
  return select((REAL)(0.0f), share * decay * kept_over(decay, at) / select((REAL)(1.0f), lost, some), some);
}
static inline REAL next_density(REAL3 decay, REAL3 shares, REAL length, REAL at) {
  return next_of(decay.x, shares.x, length, at) + next_of(decay.y, shares.y, length, at) +
         next_of(decay.z, shares.z, length, at);
}

// A stretch as a light sees it: the place nearest to the light, how far that is, the way from there to the
// beginning, and the angle that the stretch takes up.
typedef struct SeenStretch {
  REAL nearest, height, begin, angle;
  REAL part;  // of the distances that are chosen evenly in the angle
} SeenStretch;

static inline bool is_near_light(__global const Light* light) {
  return light->kind != LIGHT_DIRECTIONAL && light->kind != LIGHT_SUN && light->kind != LIGHT_ENVIRONMENT;
}

// The middle of a light; w: the square of its size, below which distances to it say nothing.
static inline float4 middle_of_light(__global const Light* light) {
  const float3 corner = light->position.xyz, edges = light->edge_u.xyz + light->edge_v.xyz;
  if (light->kind == LIGHT_RECTANGLE) return (float4)(corner + 0.5f * edges, 0.1f * light->direction.w);
  if (light->kind == LIGHT_TRIANGLE)
    return (float4)(corner + edges * (1.0f / 3.0f), 0.1f * light->direction.w);
  if (light->kind == LIGHT_DISK) return (float4)(corner, 0.1f * light->direction.w);
  return (float4)(corner, light->kind == LIGHT_SPHERE ? light->edge_u.w * light->edge_u.w : 0.0f);
}

static inline SeenStretch see_stretch(REAL3 o, REAL3 d, REAL length, REAL decay, float4 light) {
  SeenStretch s;
  const REAL3 to = subtract3(all3(light.xyz), o);
  s.nearest = dot3(to, d);
  const REAL3 across = along3(to, -s.nearest, d);
  s.height = real_sqrt(real_max(dot3(across, across) + light.w, 1e-12f * dot3(to, to) + 1e-30f));
  s.begin = -s.nearest;
  const REAL end = length - s.nearest;
  // Of a long stretch's end the angle is a right one.
  const MASK far = MASK_OF(end > 1e6f * (s.height + fabs(s.begin)));
  s.angle = atan2(select(length * s.height, s.height, far),
                  select(fma(s.begin, end, s.height * s.height), s.begin, far));
  const REAL way = real_clamp(s.nearest, (REAL)(0.0f), length);
  s.part = select((REAL)(0.0f), TOWARDS_LIGHT * real_exp(-decay * way), MASK_OF(s.angle > 1e-6f));
  return s;
}

static inline REAL distance_by_angle(const SeenStretch* s, REAL length, REAL u) {
  const REAL tangent = tan(u * s->angle);
  const REAL x = s->height * fma(s->height, tangent, s->begin) / nonzero(fma(-s->begin, tangent, s->height));
  return real_clamp(s->nearest + x, (REAL)(0.0f), length);
}

// The density of a distance that is chosen both ways, where the other way's is `chance`.
static inline REAL density_towards(const SeenStretch* s, REAL at, REAL chance) {
  const REAL x = at - s->nearest, square = fma(x, x, s->height * s->height);
  const REAL seen = s->height / (real_max(s->angle, (REAL)(1e-6f)) * square);
  return fma(s->part, seen, (1.0f - s->part) * chance);
}

// The density of directions at the cosine to the way that light went.
static inline REAL phase_density(REAL g, REAL cosine) {
  const REAL base = real_max(fma(g, g - 2.0f * cosine, (REAL)(1.0f)), (REAL)(1e-12f));
  return 0.25f / M_PI_F * fma(-g, g, (REAL)(1.0f)) / (base * real_sqrt(base));
}
static inline REAL phase_cosine(REAL g, REAL u) {
  const MASK even = MASK_OF(fabs(g) < 1e-3f);
  const REAL some = select(g, (REAL)(0.5f), even);
  const REAL root = fma(-some, some, (REAL)(1.0f)) / fma(2.0f * some, u, 1.0f - some);
  const REAL cosine = fma(some, some, fma(-root, root, (REAL)(1.0f))) / (2.0f * some);
  return real_clamp(select(cosine, fma((REAL)(-2.0f), u, (REAL)(1.0f)), even), (REAL)(-1.0f), (REAL)(1.0f));
}

// Where a stretch stands for its points when a light is chosen for it.
static inline REAL3 place_for_lights(REAL3 o, REAL3 d, REAL length, REAL decay) {
  return along3(o, real_min(0.5f * length, 1.0f / nonzero(decay)), d);
}
#endif

#endif
