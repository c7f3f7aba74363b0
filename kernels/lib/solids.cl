// The exact solids in object space: nearest t in (t_min, t_max] and the outward normal. One function a shape;
// add a new shape here, in SHAPE_* and in the host's compile step. Directions need not be unit length.
#ifndef SUNDOG_LIB_SOLIDS_CL
#define SUNDOG_LIB_SOLIDS_CL
#include "lib/config.h"
#include "lib/quartic.cl"
#include "shared/bvh.h"

typedef struct SolidHit {
  float t;
  float3 ng;  // outward, not normalised
  u32 part;   // face or part of the solid
} SolidHit;

// Takes t as the hit when it is the nearest so far.
static inline bool offer(float t, float3 ng, u32 part, float t_min, float* t_max, SolidHit* hit) {
  if (!(t > t_min && t <= *t_max)) return false;
  *t_max = t;
  hit->t = t;
  hit->ng = ng;
  hit->part = part;
  return true;
}

// Roots of |o + t d|^2 = r^2 in the space of the given vectors (2-D when a component is zero in both), robust
// where the origin is far off (Haines et al. 2019, Ray Tracing Gems, chapter 7). Returns false when there are
// none.
static inline bool round_roots(float3 o, float3 d, float r, float2* roots) {
  const float a = dot(d, d);
  if (!(a > 0.0f)) return false;
  const float b = -dot(o, d);
  const float3 nearest = o + (b / a) * d;
  const float remaining = r * r - dot(nearest, nearest);
  if (remaining < 0.0f) return false;
  const float c = dot(o, o) - r * r;
  const float q = b + copysign(sqrt(a * remaining), b);
  const float t0 = q != 0.0f ? c / q : 0.0f, t1 = q / a;
  *roots = (float2)(fmin(t0, t1), fmax(t0, t1));
  return true;
}

#if HAS_SPHERE
static inline void closest_in_sphere(float3 o, float3 d, float t_min, float* t_max, SolidHit* hit) {
  float2 roots;
  if (!round_roots(o, d, 1.0f, &roots)) return;
  if (!offer(roots.x, o + roots.x * d, 0u, t_min, t_max, hit))
    offer(roots.y, o + roots.y * d, 0u, t_min, t_max, hit);
}
#endif

#if HAS_PLANE
static inline void closest_in_plane(float3 o, float3 d, float t_min, float* t_max, SolidHit* hit) {
  if (d.y != 0.0f) offer(-o.y / d.y, (float3)(0.0f, 1.0f, 0.0f), 0u, t_min, t_max, hit);
}
#endif

#if HAS_BOX || HAS_ROUNDBOX
// Interval in which the line is inside |x| <= h, with the axis of entry and of exit. A direction without a
// component along an axis is inside it always or never.
static inline bool box_interval(float3 o, float3 d, float3 h, float2* t, u32* axis_in, u32* axis_out) {
  const float oo[3] = {o.x, o.y, o.z}, dd[3] = {d.x, d.y, d.z}, hh[3] = {h.x, h.y, h.z};
  *t = (float2)(-INFINITY, INFINITY);
  *axis_in = 0u;
  *axis_out = 0u;
  for (u32 i = 0; i < 3u; ++i) {
    if (dd[i] == 0.0f) {
      if (fabs(oo[i]) > hh[i]) return false;
      continue;
    }
    const float side = copysign(hh[i], dd[i]);
    const float enter = (-side - oo[i]) / dd[i], leave = (side - oo[i]) / dd[i];
    if (enter > t->x) {
      t->x = enter;
      *axis_in = i;
    }
    if (leave < t->y) {
      t->y = leave;
      *axis_out = i;
    }
  }
  return t->x <= t->y;
}

static inline float3 axis_normal(u32 axis, float side) {
  return (float3)(axis == 0u ? side : 0.0f, axis == 1u ? side : 0.0f, axis == 2u ? side : 0.0f);
}

static inline float component(float3 v, u32 axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }
#endif

#if HAS_BOX
static inline void closest_in_box(float3 o, float3 d, float t_min, float* t_max, SolidHit* hit) {
  float2 t;
  u32 axis_in, axis_out;
  if (!box_interval(o, d, (float3)(1.0f), &t, &axis_in, &axis_out)) return;
  const float side_in = -copysign(1.0f, component(d, axis_in)),
              side_out = copysign(1.0f, component(d, axis_out));
  if (!offer(t.x, axis_normal(axis_in, side_in), axis_in, t_min, t_max, hit))
    offer(t.y, axis_normal(axis_out, side_out), axis_out, t_min, t_max, hit);
}
#endif

#if HAS_DISK || HAS_CYLINDER || HAS_CONE
// A ring in the plane y = height, inner <= radius <= outer, normal towards `side` of y.
static inline void offer_ring(float3 o, float3 d, float height, float inner, float outer, float side,
                              u32 part, float t_min, float* t_max, SolidHit* hit) {
  if (d.y == 0.0f) return;
  const float t = (height - o.y) / d.y;
  const float x = fma(t, d.x, o.x), z = fma(t, d.z, o.z);
  const float r2 = fma(x, x, z * z);
  if (r2 <= outer * outer && r2 >= inner * inner)
    offer(t, (float3)(0.0f, side, 0.0f), part, t_min, t_max, hit);
}
#endif

#if HAS_CYLINDER
static inline void closest_in_cylinder(float4 parameters, float3 o, float3 d, float t_min, float* t_max,
                                       SolidHit* hit) {
  float2 roots;
  if (round_roots((float3)(o.x, 0.0f, o.z), (float3)(d.x, 0.0f, d.z), 1.0f, &roots)) {
    for (u32 i = 0; i < 2u; ++i) {
      const float t = i ? roots.y : roots.x;
      const float3 p = o + t * d;
      if (fabs(p.y) <= 1.0f) offer(t, (float3)(p.x, 0.0f, p.z), 0u, t_min, t_max, hit);
    }
  }
  if (parameters.x != 0.0f) {
    offer_ring(o, d, 1.0f, 0.0f, 1.0f, 1.0f, 1u, t_min, t_max, hit);
    offer_ring(o, d, -1.0f, 0.0f, 1.0f, -1.0f, 2u, t_min, t_max, hit);
  }
}
#endif

#if HAS_CONE
// The side: x^2 + z^2 = (m + k y)^2 with the mean radius m and slope k, |y| <= 1.
static inline void closest_in_cone(float4 parameters, float3 o, float3 d, float t_min, float* t_max,
                                   SolidHit* hit) {
  const float m = 0.5f * (parameters.x + parameters.y), k = 0.5f * (parameters.y - parameters.x);
  // Measured from the point of the ray nearest to the origin, the coefficients keep their digits.
  const float shift = -dot(o, d) / dot(d, d);
  const float3 s = o + shift * d;
  const float ro = fma(k, s.y, m), rd = k * d.y;
  const float a = fma(d.x, d.x, fma(d.z, d.z, -(rd * rd)));
  const float b = fma(s.x, d.x, fma(s.z, d.z, -(ro * rd)));
  const float c = fma(s.x, s.x, fma(s.z, s.z, -(ro * ro)));
  const float discriminant = fma(b, b, -(a * c));
  if (discriminant >= 0.0f) {
    const float q = -(b + copysign(sqrt(discriminant), b));
    const float t0 = q != 0.0f ? c / q : 0.0f, t1 = a != 0.0f ? q / a : t0;
    for (u32 i = 0; i < 2u; ++i) {
      const float t = i ? t1 : t0;
      const float3 p = s + t * d;
      const float r = fma(k, p.y, m);
      if (fabs(p.y) <= 1.0f && r >= 0.0f) offer(t + shift, (float3)(p.x, -k * r, p.z), 0u, t_min, t_max, hit);
    }
  }
  if (parameters.z != 0.0f) {
    offer_ring(o, d, 1.0f, 0.0f, parameters.y, 1.0f, 1u, t_min, t_max, hit);
    offer_ring(o, d, -1.0f, 0.0f, parameters.x, -1.0f, 2u, t_min, t_max, hit);
  }
}
#endif

#if HAS_TORUS
// (|p|^2 + 1 - r^2)^2 = 4 (x^2 + z^2), major radius 1. All four roots are isolated by the extrema of the
// quartic.
static inline void closest_in_torus(float4 parameters, float3 o, float3 d, float t_min, float* t_max,
                                    SolidHit* hit) {
  const float r = parameters.x, length_d = sqrt(dot(d, d));
  const float3 e = d / length_d;
  const float shift = -dot(o, e);  // the line's point nearest to the centre, in units of length
  const float3 s = o + shift * e;
  const float reach2 = (1.0f + r) * (1.0f + r) - dot(s, s);
  if (!(reach2 > 0.0f)) return;
  const float reach = sqrt(reach2);
  // With p = s + x e and s.e = 0: |p|^2 = x^2 + |s|^2.
  const float g = dot(s, s) + 1.0f - r * r;
  const float a2 = fma(-4.0f, fma(e.x, e.x, e.z * e.z), 2.0f * g);
  const float a1 = -8.0f * fma(s.x, e.x, s.z * e.z);
  const float a0 = fma(g, g, -4.0f * fma(s.x, s.x, s.z * s.z));
  float roots[4];
  const u32 count = quartic_roots(a2, a1, a0, -reach, reach, roots);
#pragma unroll 1
  for (u32 i = 0; i < count; ++i) {
    float x = roots[i];
    float3 p = s + x * e;
    for (u32 step = 0; step < 2u;
         ++step) {  // Newton on the distance itself, which keeps more digits than the quartic
      const float rho = sqrt(fma(p.x, p.x, p.z * p.z));
      const float ring = rho - 1.0f, tube = sqrt(fma(ring, ring, p.y * p.y));
      const float slope =
          ((p.x * e.x + p.z * e.z) * (ring / fmax(rho, 1e-12f)) + p.y * e.y) / fmax(tube, 1e-12f);
      if (fabs(slope) < 0.05f) break;
      x -= (tube - r) / slope;
      p = s + x * e;
    }
    const float rho = sqrt(fma(p.x, p.x, p.z * p.z)), inward = 1.0f - 1.0f / fmax(rho, 1e-12f);
    offer((x + shift) / length_d, (float3)(p.x * inward, p.y, p.z * inward), 0u, t_min, t_max, hit);
  }
}
#endif

#if HAS_ROUNDBOX
// A rounded box is convex, and the union of three boxes, twelve cylinders along the edges and eight spheres
// at the corners: the line is inside from the least entry to the greatest exit of any of them.
static inline void closest_in_roundbox(float4 parameters, float3 o, float3 d, float t_min, float* t_max,
                                       SolidHit* hit) {
  const float3 half_size = parameters.xyz;
  const float r = parameters.w;
  float2 t, span = (float2)(INFINITY, -INFINITY);
  u32 axis_in, axis_out;
  if (!box_interval(o, d, half_size, &t, &axis_in, &axis_out)) return;
  const float3 core = half_size - r;
  for (u32 i = 0; i < 3u; ++i) {
    const float3 slab = core + axis_normal(i, r);
    if (box_interval(o, d, slab, &t, &axis_in, &axis_out))
      span = (float2)(fmin(span.x, t.x), fmax(span.y, t.y));
  }
#pragma unroll 1
  for (u32 corner = 0; corner < 8u; ++corner) {
    const float3 center = (float3)(corner & 1u ? core.x : -core.x, corner & 2u ? core.y : -core.y,
                                   corner & 4u ? core.z : -core.z);
    const float3 c = o - center;
    if (round_roots(c, d, r, &t)) span = (float2)(fmin(span.x, t.x), fmax(span.y, t.y));
    for (u32 axis = 0; axis < 3u; ++axis) {  // each edge once: from the corner on its negative end
      if (corner & (1u << axis)) continue;
      const float3 keep =
          (float3)(axis == 0u ? 0.0f : 1.0f, axis == 1u ? 0.0f : 1.0f, axis == 2u ? 0.0f : 1.0f);
      if (!round_roots(c * keep, d * keep, r, &t)) continue;
      const float extent = component(core, axis), oa = component(o, axis), da = component(d, axis);
      if (fabs(fma(t.x, da, oa)) <= extent) span.x = fmin(span.x, t.x);
      if (fabs(fma(t.y, da, oa)) <= extent) span.y = fmax(span.y, t.y);
    }
  }
  if (!(span.x <= span.y)) return;
  for (u32 i = 0; i < 2u; ++i) {
    const float ti = i ? span.y : span.x;
    const float3 p = o + ti * d;
    const float3 ng = p - clamp(p, -core, core);
    if (offer(ti, ng, 0u, t_min, t_max, hit)) return;
  }
}
#endif

static inline bool closest_in_solid(u32 shape, float4 parameters, float3 o, float3 d, float t_min,
                                    float t_max, SolidHit* hit) {
  hit->part = NO_PRIM;
  float limit = t_max;
  switch (shape) {
#if HAS_SPHERE
    case SHAPE_SPHERE:
      closest_in_sphere(o, d, t_min, &limit, hit);
      break;
#endif
#if HAS_PLANE
    case SHAPE_PLANE:
      closest_in_plane(o, d, t_min, &limit, hit);
      break;
#endif
#if HAS_BOX
    case SHAPE_BOX:
      closest_in_box(o, d, t_min, &limit, hit);
      break;
#endif
#if HAS_CYLINDER
    case SHAPE_CYLINDER:
      closest_in_cylinder(parameters, o, d, t_min, &limit, hit);
      break;
#endif
#if HAS_CONE
    case SHAPE_CONE:
      closest_in_cone(parameters, o, d, t_min, &limit, hit);
      break;
#endif
#if HAS_DISK
    case SHAPE_DISK:
      offer_ring(o, d, 0.0f, parameters.x, 1.0f, 1.0f, 0u, t_min, &limit, hit);
      break;
#endif
#if HAS_TORUS
    case SHAPE_TORUS:
      closest_in_torus(parameters, o, d, t_min, &limit, hit);
      break;
#endif
#if HAS_ROUNDBOX
    case SHAPE_ROUNDBOX:
      closest_in_roundbox(parameters, o, d, t_min, &limit, hit);
      break;
#endif
    default:
      break;
  }
  return hit->part != NO_PRIM;
}

#endif
