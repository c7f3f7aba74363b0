// The exact solids in object space, a ray a lane: nearest t in (t_min, t_max] and the outward normal. One
// function a solid of shared/shapes.h. Directions need not be unit length.
#ifndef SUNDOG_LIB_SOLIDS_CL
#define SUNDOG_LIB_SOLIDS_CL
#include "lib/core/config.h"
#include "lib/core/lanes.h"
#include "lib/trace/torus.cl"
#include "shared/bvh.h"

typedef struct SolidHits {
  REAL t;     // of the hit, else t_max
  REAL3 ng;   // outward, not normalised
  MASK part;  // face or part of the solid
  MASK found;
} SolidHits;

// Takes t as the hit where it is the nearest so far.
static inline void offer(REAL t, REAL3 ng, MASK part, MASK valid, REAL t_min, SolidHits* hits) {
  const MASK nearer = valid & MASK_OF(t > t_min) & MASK_OF(t <= hits->t);
  hits->t = select(hits->t, t, nearer);
  hits->ng = select3(hits->ng, ng, nearer);
  hits->part = select(hits->part, part, nearer);
  hits->found |= nearer;
}

static inline REAL3 up_or_down(REAL side) { return real3((REAL)(0.0f), side, (REAL)(0.0f)); }

// Where a line enters and leaves something.
typedef struct Span {
  REAL enter, leave;
  MASK crosses;
} Span;

// |o + t d| = r in the space of the given vectors (2-D when a component is zero in both), robust where the
// origin is far off (Haines et al. 2019, Ray Tracing Gems, chapter 7).
static inline Span round_span(REAL3 o, REAL3 d, float r) {
  const REAL a = dot3(d, d), inverse = 1.0f / a, b = -dot3(o, d);
  const REAL3 nearest = along3(o, b * inverse, d);
  const REAL remaining = r * r - dot3(nearest, nearest);
  Span span;
  span.crosses = MASK_OF(a > 0.0f) & MASK_OF(remaining >= 0.0f);
  const REAL c = dot3(o, o) - r * r;
  const REAL q = b + copysign(real_sqrt(a * remaining), b);
  const REAL t0 = select((REAL)(0.0f), c / q, MASK_OF(q != 0.0f)), t1 = q * inverse;
  span.enter = real_min(t0, t1);
  span.leave = real_max(t0, t1);
  return span;
}

#if HAS_SPHERE
static inline void closest_in_sphere(REAL3 o, REAL3 d, REAL t_min, MASK active, SolidHits* hits) {
  const Span span = round_span(o, d, 1.0f);
  const REAL t = select(span.leave, span.enter, MASK_OF(span.enter > t_min));
  offer(t, along3(o, t, d), NO_LANES, active & span.crosses, t_min, hits);
}
#endif

#if HAS_PLANE
static inline void closest_in_plane(REAL3 o, REAL3 d, REAL t_min, MASK active, SolidHits* hits) {
  offer(-o.y / d.y, up_or_down((REAL)(1.0f)), NO_LANES, active & MASK_OF(d.y != 0.0f), t_min, hits);
}
#endif

#if HAS_BOX || HAS_ROUNDBOX
// A ray for boxes around the origin. A direction without a component along an axis is inside it always or
// never.
typedef struct BoxSlabs {
  REAL3 o, size, inverse;  // size: of o
  MASK flat_x, flat_y, flat_z;
} BoxSlabs;

static inline BoxSlabs make_box_ray(REAL3 o, REAL3 d) {
  BoxSlabs ray;
  ray.o = o;
  ray.size = real3(fabs(o.x), fabs(o.y), fabs(o.z));
  ray.inverse = real3(1.0f / d.x, 1.0f / d.y, 1.0f / d.z);
  ray.flat_x = MASK_OF(fabs(d.x) < 1e-37f);
  ray.flat_y = MASK_OF(fabs(d.y) < 1e-37f);
  ray.flat_z = MASK_OF(fabs(d.z) < 1e-37f);
  return ray;
}

// The part of the line where |x| <= h along one axis, cut off `span`; the axis of entry and exit is kept.
static inline void cut_slab(REAL o, REAL size, REAL inverse, MASK flat, float h, int axis, Span* span,
                            MASK* axis_in, MASK* axis_out) {
  const REAL side = copysign((REAL)(h), inverse);
  const REAL enter = (-side - o) * inverse, leave = (side - o) * inverse;
  const MASK later = MASK_OF(enter > span->enter) & ~flat, sooner = MASK_OF(leave < span->leave) & ~flat;
  span->enter = select(span->enter, enter, later);
  span->leave = select(span->leave, leave, sooner);
  *axis_in = select(*axis_in, (MASK)(axis), later);
  *axis_out = select(*axis_out, (MASK)(axis), sooner);
  span->crosses &= ~(flat & MASK_OF(size > h));
}

static inline Span box_span(const BoxSlabs* ray, float3 h, MASK* axis_in, MASK* axis_out) {
  Span span = {(REAL)(-INFINITY), (REAL)(INFINITY), ALL_LANES};
  *axis_in = NO_LANES;
  *axis_out = NO_LANES;
  cut_slab(ray->o.x, ray->size.x, ray->inverse.x, ray->flat_x, h.x, 0, &span, axis_in, axis_out);
  cut_slab(ray->o.y, ray->size.y, ray->inverse.y, ray->flat_y, h.y, 1, &span, axis_in, axis_out);
  cut_slab(ray->o.z, ray->size.z, ray->inverse.z, ray->flat_z, h.z, 2, &span, axis_in, axis_out);
  span.crosses &= MASK_OF(span.enter <= span.leave);
  return span;
}
#endif

#if HAS_BOX
// Unit normal along an axis, with the direction's sign or against it.
static inline REAL3 axis_normals(MASK axis, REAL3 d, float along) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(along);
  return real3(select(zero, copysign(one, d.x * along), MASK_OF(axis == 0)),
               select(zero, copysign(one, d.y * along), MASK_OF(axis == 1)),
               select(zero, copysign(one, d.z * along), MASK_OF(axis == 2)));
}

static inline void closest_in_box(REAL3 o, REAL3 d, REAL t_min, MASK active, SolidHits* hits) {
  const BoxSlabs ray = make_box_ray(o, d);
  MASK axis_in, axis_out;
  const Span span = box_span(&ray, (float3)(1.0f), &axis_in, &axis_out);
  const MASK enters = MASK_OF(span.enter > t_min);
  const REAL3 ng = select3(axis_normals(axis_out, d, 1.0f), axis_normals(axis_in, d, -1.0f), enters);
  offer(select(span.leave, span.enter, enters), ng, select(axis_out, axis_in, enters), active & span.crosses,
        t_min, hits);
}
#endif

#if HAS_DISK || HAS_CYLINDER || HAS_CONE
// A ring in the plane y = height, inner <= radius <= outer, normal towards `side` of y.
static inline void offer_ring(REAL3 o, REAL3 d, float height, float inner, float outer, float side, int part,
                              REAL t_min, MASK active, SolidHits* hits) {
  const REAL t = (height - o.y) / d.y;
  const REAL x = fma(t, d.x, o.x), z = fma(t, d.z, o.z);
  const REAL r2 = fma(x, x, z * z);
  const MASK within = MASK_OF(d.y != 0.0f) & MASK_OF(r2 <= outer * outer) & MASK_OF(r2 >= inner * inner);
  offer(t, up_or_down((REAL)(side)), (MASK)(part), active & within, t_min, hits);
}
#endif

#if HAS_CYLINDER
static inline void closest_in_cylinder(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                       SolidHits* hits) {
  const REAL zero = (REAL)(0.0f);
  const Span span = round_span(real3(o.x, zero, o.z), real3(d.x, zero, d.z), 1.0f);
  for (u32 i = 0; i < 2u; ++i) {
    const REAL t = i ? span.leave : span.enter;
    const REAL3 p = along3(o, t, d);
    offer(t, real3(p.x, zero, p.z), NO_LANES, active & span.crosses & MASK_OF(fabs(p.y) <= 1.0f), t_min,
          hits);
  }
  if (parameters.x != 0.0f) {
    offer_ring(o, d, 1.0f, 0.0f, 1.0f, 1.0f, 1, t_min, active, hits);
    offer_ring(o, d, -1.0f, 0.0f, 1.0f, -1.0f, 2, t_min, active, hits);
  }
}
#endif

#if HAS_CONE
// The side: x^2 + z^2 = (m + k y)^2 with the mean radius m and slope k, |y| <= 1.
static inline void closest_in_cone(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                   SolidHits* hits) {
  const float m = 0.5f * (parameters.x + parameters.y), k = 0.5f * (parameters.y - parameters.x);
  // Measured from the point of the ray nearest to the origin, the coefficients keep their digits.
  const REAL shift = -dot3(o, d) / dot3(d, d);
  const REAL3 s = along3(o, shift, d);
  const REAL ro = fma((REAL)(k), s.y, (REAL)(m)), rd = k * d.y;
  const REAL a = fma(d.x, d.x, fma(d.z, d.z, -(rd * rd)));
  const REAL b = fma(s.x, d.x, fma(s.z, d.z, -(ro * rd)));
  const REAL c = fma(s.x, s.x, fma(s.z, s.z, -(ro * ro)));
  const REAL discriminant = fma(b, b, -(a * c));
  const MASK real = active & MASK_OF(discriminant >= 0.0f);
  const REAL q = -(b + copysign(real_sqrt(discriminant), b));
  const REAL t0 = select((REAL)(0.0f), c / q, MASK_OF(q != 0.0f)), t1 = select(t0, q / a, MASK_OF(a != 0.0f));
  for (u32 i = 0; i < 2u; ++i) {
    const REAL t = i ? t1 : t0;
    const REAL3 p = along3(s, t, d);
    const REAL r = fma((REAL)(k), p.y, (REAL)(m));
    offer(t + shift, real3(p.x, -k * r, p.z), NO_LANES,
          real & MASK_OF(fabs(p.y) <= 1.0f) & MASK_OF(r >= 0.0f), t_min, hits);
  }
  if (parameters.z != 0.0f) {
    offer_ring(o, d, 1.0f, 0.0f, parameters.y, 1.0f, 1, t_min, active, hits);
    offer_ring(o, d, -1.0f, 0.0f, parameters.x, -1.0f, 2, t_min, active, hits);
  }
}
#endif

#if HAS_TORUS
static inline void closest_in_torus(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                    SolidHits* hits) {
  for (u32 bits = lane_bits(active); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    TorusHit hit;
    hit.t = REAL_LANE(hits->t, i);
    if (!closest_in_one_torus(parameters.x, get3(&o, i), get3(&d, i), REAL_LANE(t_min, i), &hit)) continue;
    REAL_LANE(hits->t, i) = hit.t;
    set3(&hits->ng, i, hit.ng);
    MASK_LANE(hits->part, i) = 0;
    MASK_LANE(hits->found, i) = -1;
  }
}
#endif

#if HAS_ROUNDBOX
static inline void unite_spans(Span* whole, Span part) {
  whole->enter = select(whole->enter, real_min(whole->enter, part.enter), part.crosses);
  whole->leave = select(whole->leave, real_max(whole->leave, part.leave), part.crosses);
}

static inline REAL component(REAL3 v, u32 axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }

// A rounded box is convex, and the union of three boxes, twelve cylinders along the edges and eight spheres
// at the corners: the line is inside from the least entry to the greatest exit of any of them.
static inline void closest_in_roundbox(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                       SolidHits* hits) {
  const float3 half_size = parameters.xyz;
  const float r = parameters.w;
  const BoxSlabs ray = make_box_ray(o, d);
  MASK axis_in, axis_out;
  const Span bounds = box_span(&ray, half_size, &axis_in, &axis_out);
  active &= bounds.crosses & MASK_OF(bounds.leave > t_min) & MASK_OF(bounds.enter <= hits->t);
  if (!any_lane(active)) return;
  Span span = {(REAL)(INFINITY), (REAL)(-INFINITY), ALL_LANES};
  const float3 core = half_size - r;
  unite_spans(&span, box_span(&ray, core + (float3)(r, 0.0f, 0.0f), &axis_in, &axis_out));
  unite_spans(&span, box_span(&ray, core + (float3)(0.0f, r, 0.0f), &axis_in, &axis_out));
  unite_spans(&span, box_span(&ray, core + (float3)(0.0f, 0.0f, r), &axis_in, &axis_out));
#pragma unroll 1
  for (u32 corner = 0; corner < 8u; ++corner) {
    const REAL3 center = all3((float3)(corner & 1u ? core.x : -core.x, corner & 2u ? core.y : -core.y,
                                       corner & 4u ? core.z : -core.z));
    const REAL3 c = subtract3(o, center);
    unite_spans(&span, round_span(c, d, r));
#pragma unroll 1
    for (u32 axis = 0; axis < 3u; ++axis) {  // each edge once: from the corner on its negative end
      if (corner & (1u << axis)) continue;
      const REAL3 keep =
          all3((float3)(axis == 0u ? 0.0f : 1.0f, axis == 1u ? 0.0f : 1.0f, axis == 2u ? 0.0f : 1.0f));
      const Span edge = round_span(multiply3(c, keep), multiply3(d, keep), r);
      const float extent = axis == 0u ? core.x : axis == 1u ? core.y : core.z;
      const REAL oa = component(o, axis), da = component(d, axis);
      const MASK enters = edge.crosses & MASK_OF(fabs(fma(edge.enter, da, oa)) <= extent),
                 leaves = edge.crosses & MASK_OF(fabs(fma(edge.leave, da, oa)) <= extent);
      span.enter = select(span.enter, real_min(span.enter, edge.enter), enters);
      span.leave = select(span.leave, real_max(span.leave, edge.leave), leaves);
    }
  }
  const REAL t = select(span.leave, span.enter, MASK_OF(span.enter > t_min));
  const REAL3 p = along3(o, t, d), limit = all3(core);
  const REAL3 within = real3(real_clamp(p.x, -limit.x, limit.x), real_clamp(p.y, -limit.y, limit.y),
                             real_clamp(p.z, -limit.z, limit.z));
  offer(t, subtract3(p, within), NO_LANES, active & MASK_OF(span.enter <= span.leave), t_min, hits);
}
#endif

// The nearest hits of the lanes of `active` in (t_min, hits->t]; sets `found`, and the rest where there is
// one.
ALWAYS_INLINE void closest_in_solid(u32 shape, float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                    SolidHits* hits) {
  switch (shape) {
#if HAS_SPHERE
    case SHAPE_SPHERE:
      closest_in_sphere(o, d, t_min, active, hits);
      break;
#endif
#if HAS_PLANE
    case SHAPE_PLANE:
      closest_in_plane(o, d, t_min, active, hits);
      break;
#endif
#if HAS_BOX
    case SHAPE_BOX:
      closest_in_box(o, d, t_min, active, hits);
      break;
#endif
#if HAS_CYLINDER
    case SHAPE_CYLINDER:
      closest_in_cylinder(parameters, o, d, t_min, active, hits);
      break;
#endif
#if HAS_CONE
    case SHAPE_CONE:
      closest_in_cone(parameters, o, d, t_min, active, hits);
      break;
#endif
#if HAS_DISK
    case SHAPE_DISK:
      offer_ring(o, d, 0.0f, parameters.x, 1.0f, 1.0f, 0, t_min, active, hits);
      break;
#endif
#if HAS_TORUS
    case SHAPE_TORUS:
      closest_in_torus(parameters, o, d, t_min, active, hits);
      break;
#endif
#if HAS_ROUNDBOX
    case SHAPE_ROUNDBOX:
      closest_in_roundbox(parameters, o, d, t_min, active, hits);
      break;
#endif
    default:
      break;
  }
}

#endif
