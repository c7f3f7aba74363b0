// The box and the round box: ray intersection, coordinates of a surface point p, and curvature there.
#pragma once
#include "lib/solids/spans.cl"
#include "lib/solids/surface_points.cl"

// A ray prepared for boxes around the origin.
typedef struct BoxRay {
  REAL3 o, d, inverse;
  bool flat;  // in some lane, a component is too small to divide by: leave_out_flat()
} BoxRay;

#define FLAT(component) MASK_OF(fabs(component) < 1e-37f)

static inline BoxRay make_box_ray(REAL3 o, REAL3 d) {
  BoxRay ray;
  ray.o = o;
  ray.d = d;
  ray.inverse = real3(rounded_inverse(d.x), rounded_inverse(d.y), rounded_inverse(d.z));
  ray.flat = any_lane(FLAT(real_min(fabs(d.x), real_min(fabs(d.y), fabs(d.z)))));
  return ray;
}

// Entry and exit of a line at a box, and at the slab of each axis.
typedef struct BoxSpan {
  REAL3 enters, leaves;
  Span span;
} BoxSpan;

static inline void cut_slab(REAL o, REAL inverse, float h, REAL* enter, REAL* leave) {
  const REAL side = copysign((REAL)(h), inverse);
  *enter = (-side - o) * inverse;
  *leave = (side - o) * inverse;
}

// A direction without a component along an axis is always or never inside the slab. Returns the lanes that
// may be inside.
static inline MASK leave_out_flat(REAL o, REAL d, float h, REAL* enter, REAL* leave) {
  const MASK flat = FLAT(d);
  *enter = select(*enter, (REAL)(-INFINITY), flat);
  *leave = select(*leave, (REAL)(INFINITY), flat);
  return ~(flat & MASK_OF(fabs(o) > h));
}

static inline BoxSpan box_span(const BoxRay* ray, float3 h) {
  BoxSpan box;
  REAL3 *in = &box.enters, *out = &box.leaves;
  cut_slab(ray->o.x, ray->inverse.x, h.x, &in->x, &out->x);
  cut_slab(ray->o.y, ray->inverse.y, h.y, &in->y, &out->y);
  cut_slab(ray->o.z, ray->inverse.z, h.z, &in->z, &out->z);
  MASK within = ALL_LANES;
  if (ray->flat) {
    within &= leave_out_flat(ray->o.x, ray->d.x, h.x, &in->x, &out->x);
    within &= leave_out_flat(ray->o.y, ray->d.y, h.y, &in->y, &out->y);
    within &= leave_out_flat(ray->o.z, ray->d.z, h.z, &in->z, &out->z);
  }
  box.span.enter = real_max(real_max(in->x, in->y), in->z);
  box.span.leave = real_min(real_min(out->x, out->y), out->z);
  box.span.crosses = within & MASK_OF(box.span.enter <= box.span.leave);
  return box;
}

// A hit's part until finish_faces(): the face across an axis, with the sign of d.
#define BOX_FACE 0x100
#define BOX_AXIS 3
static inline MASK axis_face(int axis, REAL d) {
  return (AS_MASK(d) & (int)0x80000000) | (MASK)(BOX_FACE | axis);
}

// Sets the unit normals of face hits in `lanes`; their parts become axes.
static inline REAL axis_normal(MASK here, MASK face) {
  return select((REAL)(0.0f), AS_REAL((face & (int)0x80000000) | as_int(1.0f)), here);
}
static inline void finish_faces(MASK lanes, SolidHits* hits) {
  if (!HAS_BOX) return;
  const MASK face = hits->part, faces = lanes & MASK_OF((face & BOX_FACE) != 0), axis = face & BOX_AXIS;
  const REAL3 normal = real3(axis_normal(MASK_OF(axis == 0), face), axis_normal(MASK_OF(axis == 1), face),
                             axis_normal(MASK_OF(axis == 2), face));
  hits->ng = select3(hits->ng, normal, faces);
  hits->part = select(face, axis, faces);
}

// A box with these half sizes; the face nearest to p.
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
  const BoxRay ray = make_box_ray(o, d);
  const BoxSpan box = box_span(&ray, (float3)(1.0f));
  active &= box.span.crosses;
  const MASK enters = MASK_OF(box.span.enter > t_min);
  const REAL t = select(box.span.leave, box.span.enter, enters);
  const MASK along_x = MASK_OF(select(box.leaves.x, box.enters.x, enters) == t),
             along_y = MASK_OF(select(box.leaves.y, box.enters.y, enters) == t);
  const MASK across = select(axis_face(2, d.z), axis_face(1, d.y), along_y);
  const MASK face = select(across, axis_face(0, d.x), along_x) ^ (enters & (int)0x80000000);
  offer_face(t, face, active, t_min, hits);
}

static inline SurfacePoints points_on_box(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return points_on_faces(p, (float3)(1.0f));
}
static inline REAL curvature_of_box(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return (REAL)(0.0f);
}
static inline float4 reach_of_box(float4 parameters) { return (float4)(1.0f, 1.0f, 1.0f, REACH_BOX); }
static inline u32 convexity_of_box(float4 parameters) { return CONVEX; }

static inline void unite_spans(Span* whole, Span part) {
  whole->enter = select(whole->enter, real_min(whole->enter, part.enter), part.crosses);
  whole->leave = select(whole->leave, real_max(whole->leave, part.leave), part.crosses);
}

static inline REAL component(REAL3 v, u32 axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }

// A rounded box is convex, and the union of three boxes, twelve cylinders along the edges and eight spheres
// at the corners: the line is inside from the first entry to the last exit of any of them.
static inline void closest_in_round_box(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                        SolidHits* hits) {
  const float3 half_size = parameters.xyz;
  const float r = parameters.w;
  REAL3 near = o;
  const REAL shift = come_near(&near, d, active);
  const BoxRay ray = make_box_ray(near, d);
  const Span bounds = box_span(&ray, half_size).span;
  active &= bounds.crosses & MASK_OF(shift + bounds.leave > t_min) & MASK_OF(shift + bounds.enter <= hits->t);
  if (!any_lane(active)) return;
  Span span = {(REAL)(INFINITY), (REAL)(-INFINITY), ALL_LANES};
  const float3 core = half_size - r;
  unite_spans(&span, box_span(&ray, core + (float3)(r, 0.0f, 0.0f)).span);
  unite_spans(&span, box_span(&ray, core + (float3)(0.0f, r, 0.0f)).span);
  unite_spans(&span, box_span(&ray, core + (float3)(0.0f, 0.0f, r)).span);
#pragma unroll 1
  for (u32 corner = 0; corner < 8u; ++corner) {
    const REAL3 center = all3((float3)(corner & 1u ? core.x : -core.x, corner & 2u ? core.y : -core.y,
                                       corner & 4u ? core.z : -core.z));
    const REAL3 c = subtract3(near, center);
    unite_spans(&span, round_span(c, d, r));
#pragma unroll 1
    for (u32 axis = 0; axis < 3u; ++axis) {  // each edge once, from its corner on the negative end
      if (corner & (1u << axis)) continue;
      const REAL3 keep =
          all3((float3)(axis == 0u ? 0.0f : 1.0f, axis == 1u ? 0.0f : 1.0f, axis == 2u ? 0.0f : 1.0f));
      const Span edge = round_span(multiply3(c, keep), multiply3(d, keep), r);
      const float extent = axis == 0u ? core.x : axis == 1u ? core.y : core.z;
      const REAL oa = component(near, axis), da = component(d, axis);
      const MASK enters = edge.crosses & MASK_OF(fabs(fma(edge.enter, da, oa)) <= extent),
                 leaves = edge.crosses & MASK_OF(fabs(fma(edge.leave, da, oa)) <= extent);
      span.enter = select(span.enter, real_min(span.enter, edge.enter), enters);
      span.leave = select(span.leave, real_max(span.leave, edge.leave), leaves);
    }
  }
  const REAL t = select(span.leave, span.enter, MASK_OF(shift + span.enter > t_min));
  const REAL3 p = along3(near, t, d), limit = all3(core);
  const REAL3 within = real3(real_clamp(p.x, -limit.x, limit.x), real_clamp(p.y, -limit.y, limit.y),
                             real_clamp(p.z, -limit.z, limit.z));
  offer(shift + t, subtract3(p, within), NO_LANES, active & MASK_OF(span.enter <= span.leave), t_min, hits);
}

static inline SurfacePoints points_on_round_box(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return points_on_faces(p, parameters.xyz);
}
// The faces' curvature; edges count as flat.
static inline REAL curvature_of_round_box(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return (REAL)(0.0f);
}
static inline float4 reach_of_round_box(float4 parameters) { return (float4)(parameters.xyz, REACH_BOX); }
static inline u32 convexity_of_round_box(float4 parameters) { return CONVEX; }
