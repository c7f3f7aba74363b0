// The box and the round box: for each where a ray meets it, the coordinates of a point p on it and the
// curvature there.
#ifndef SUNDOG_LIB_BOXES_CL
#define SUNDOG_LIB_BOXES_CL
#include "lib/solids/spans.cl"
#include "lib/solids/surface_points.cl"

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

// Unit normal along an axis, with the direction's sign or against it.
static inline REAL3 axis_normals(MASK axis, REAL3 d, float along) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(along);
  return real3(select(zero, copysign(one, d.x * along), MASK_OF(axis == 0)),
               select(zero, copysign(one, d.y * along), MASK_OF(axis == 1)),
               select(zero, copysign(one, d.z * along), MASK_OF(axis == 2)));
}

// A box with these half sizes; the face is the one that p is nearest to.
static inline SurfacePoints points_on_faces(REAL3 p, float3 half_size) {
  const REAL3 q = real3(p.x / half_size.x, p.y / half_size.y, p.z / half_size.z);
  const REAL3 size = real3(fabs(q.x), fabs(q.y), fabs(q.z));
  const REAL zero = (REAL)(0.0f), a = (REAL)(2.0f * half_size.x), b = (REAL)(2.0f * half_size.y),
             c = (REAL)(2.0f * half_size.z);
  const MASK top = MASK_OF(size.y >= size.x) & MASK_OF(size.y >= size.z);
  const MASK side = ~top & MASK_OF(size.x >= size.z);
  SurfacePoints at;
  at.u = 0.5f + 0.5f * select(select(copysign(q.x, q.x * q.z), -copysign(q.z, q.z * q.x), side), q.x, top);
  at.v = 0.5f + 0.5f * select(q.y, -copysign(q.z, q.z * q.y), top);
  at.dpdu = select3(select3(real3(copysign(a, q.z), zero, zero), real3(zero, zero, copysign(c, -q.x)), side),
                    real3(a, zero, zero), top);
  at.dpdv = select3(real3(zero, b, zero), real3(zero, zero, copysign(c, -q.y)), top);
  return at;
}

static inline void closest_in_box(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                  SolidHits* hits) {
  const BoxSlabs ray = make_box_ray(o, d);
  MASK axis_in, axis_out;
  const Span span = box_span(&ray, (float3)(1.0f), &axis_in, &axis_out);
  active &= span.crosses;
  if (!any_lane(active)) return;
  const MASK enters = MASK_OF(span.enter > t_min);
  const REAL3 ng = select3(axis_normals(axis_out, d, 1.0f), axis_normals(axis_in, d, -1.0f), enters);
  offer(select(span.leave, span.enter, enters), ng, select(axis_out, axis_in, enters), active, t_min, hits);
}

static inline SurfacePoints points_on_box(float4 parameters, REAL3 p, MASK part) {
  return points_on_faces(p, (float3)(1.0f));
}
static inline REAL curvature_of_box(float4 parameters, REAL3 p, MASK part) { return (REAL)(0.0f); }

static inline void unite_spans(Span* whole, Span part) {
  whole->enter = select(whole->enter, real_min(whole->enter, part.enter), part.crosses);
  whole->leave = select(whole->leave, real_max(whole->leave, part.leave), part.crosses);
}

static inline REAL component(REAL3 v, u32 axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }

// A rounded box is convex, and the union of three boxes, twelve cylinders along the edges and eight spheres
// at the corners: the line is inside from the least entry to the greatest exit of any of them.
static inline void closest_in_round_box(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
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

static inline SurfacePoints points_on_round_box(float4 parameters, REAL3 p, MASK part) {
  return points_on_faces(p, parameters.xyz);
}
// Of its faces; its edges count as flat.
static inline REAL curvature_of_round_box(float4 parameters, REAL3 p, MASK part) { return (REAL)(0.0f); }

#endif
