// Intersects rays with a surface of revolution about the y axis. Its profile is a list of arcs, cubics (R(t),
// Y(t)) along which R, Y and the derivatives of both are monotone (host/models/values/revolution.h).
//
// In the half plane of radius r and height y a line is a hyperbola, whose halves part where the line is
// nearest to the axis. With a unit direction e, its sine S to the axis and its distance m from it, a half is
//   S (y - height of that place) = g q,   q = sqrt(r^2 - m^2), g = e.y or -e.y.
// It crosses an arc where E(t), the difference of both sides, changes its sign. Neighbouring arcs share their
// ends to the bit, and so the sign there: no ray slips between them, and a closed profile is left as often as
// entered. Intervals of t are halved until E is monotone, and then bracket its root.
#pragma once
#include "lib/core/config.h"
#include "lib/core/tables.h"
#include "lib/solids/arcs.cl"
#include "lib/solids/spans.cl"
#include "lib/solids/surface_points.cl"

#if HAS_LATHE
// The tracer by itself on a GPU has few registers. There rays and the ends of an arc stay in memory, and
// these and arcs are read where they are needed: compilers would keep them in registers, but cannot know that
// t is at most 1.
#if FEW_REGISTERS
#define KEEP_LATHE(type, name) KEEP_IN_MEMORY(type, name)
#define READ_AGAIN(pointer, t) ((pointer) + ((t) > 1.0f))
#else
#define KEEP_LATHE(type, name) \
  type kept_##name;            \
  type* const name = &kept_##name
#define READ_AGAIN(pointer, t) (pointer)
#endif

// Rays, with distances s from `base`, the line's point nearest to the origin, and their nearest hits so far.
typedef struct LatheRays {
  REAL m2;  // m squared
  REAL3 base, e;
  REAL shift, length;  // t = shift + s / length
  REAL sine, inverse;  // S, and 1 / S or 0
  REAL climb;          // 1 / e.y
  REAL middle, level;  // s where the line is nearest to the axis; S times the height there
  REAL from, to;       // the range of s, slightly wider
  MASK steep;
  REAL t_min, t;  // t: of the hit, else t_max
  REAL3 ng;
  MASK part;  // -1: no hit
} LatheRays;

// One of them, as arcs are searched with it.
typedef struct LatheRay {
  float sine, level, m2;
} LatheRay;

static inline LatheRays lathe_rays(REAL3 o, REAL3 d, REAL t_min, REAL t_max, MASK active) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  LatheRays rays;
  REAL3 near = o;
  const REAL shift = come_near(&near, d, active);
  rays.length = real_sqrt(dot3(d, d));
  const REAL3 e = real3(d.x / rays.length, d.y / rays.length, d.z / rays.length);
  const REAL back = dot3(near, e);
  const REAL3 base = along3(near, -back, e);
  rays.e = e;
  rays.base = base;
  rays.shift = shift - back / rays.length;
  rays.sine = real_sqrt(fma(e.x, e.x, e.z * e.z));
  const MASK upright = MASK_OF(rays.sine < 1e-15f);
  rays.sine = select(rays.sine, zero, upright);
  rays.inverse = select(1.0f / select(rays.sine, one, upright), zero, upright);
  rays.climb = 1.0f / select(e.y, one, MASK_OF(e.y == 0.0f));
  rays.steep = MASK_OF(rays.sine < fabs(e.y));
  const REAL along = fma(base.x, e.x, base.z * e.z) * rays.inverse,
             across = fma(base.x, e.z, -(base.z * e.x)) * rays.inverse;
  rays.middle = -along * rays.inverse;
  rays.level = fma(rays.sine, base.y, -(along * e.y));
  rays.m2 = select(across * across, fma(base.x, base.x, base.z * base.z), upright);
  const REAL from = (t_min - rays.shift) * rays.length, to = (t_max - rays.shift) * rays.length;
  rays.from = from - fma(fabs(from), (REAL)(1e-5f), (REAL)(1e-4f));
  rays.to = to + fma(fabs(to), (REAL)(1e-5f), (REAL)(1e-4f));
  rays.t_min = t_min;
  rays.t = t_max;
  rays.ng = real3(zero, zero, zero);
  rays.part = (MASK)(-1);
  return rays;
}

static inline LatheRay lathe_ray(const LatheRays* rays, u32 i) {
  const LatheRay ray = {REAL_LANE(rays->sine, i), REAL_LANE(rays->level, i), REAL_LANE(rays->m2, i)};
  return ray;
}

// A place on an arc: E = up - g q.
typedef struct ArcPlace {
  float t, r, up, q;
} ArcPlace;

static inline float outside_of(float r, float m2) { return fma(r, r, -m2); }

static inline ArcPlace arc_place(const LatheRay* ray, const ProfileArc* arc, float t) {
  const float2 p = arc_point(arc, t);
  const ArcPlace place = {t, p.x, fma(ray->sine, p.y, -ray->level),
                          sqrt(fmax(outside_of(p.x, ray->m2), 0.0f))};
  return place;
}
static inline float value_at(const ArcPlace* place, float g) { return place->up - g * place->q; }

typedef struct ArcEnds {
  ArcPlace first, last;
} ArcEnds;

// Where the radius becomes m on an arc of which an end, the first or the last, is inside. There both halves
// begin, with the same E.
static inline ArcPlace outer_end(const LatheRay* ray, __global const ProfileArc* arc, bool first_inside) {
  float low = 0.0f, high = 1.0f, t = 0.5f;
#pragma unroll 1
  for (u32 i = 0; i < 40u; ++i) {
    const ProfileArc now = *READ_AGAIN(arc, t);
    const float r = arc_point(&now, t).x, off = outside_of(r, ray->m2);
    if ((off < 0.0f) == first_inside)
      low = t;
    else
      high = t;
    if (!newton_step(&t, off, 2.0f * r * arc_slope(&now, t).x, low, high)) break;
  }
  const ProfileArc now = *READ_AGAIN(arc, t);
  ArcPlace end = arc_place(ray, &now, t);
  end.q = 0.0f;
  return end;
}

// The root of E between two places where its signs differ.
static inline float arc_root(const LatheRay* ray, __global const ProfileArc* arc, float g, const ArcPlace* a,
                             const ArcPlace* b) {
  const float at_a = value_at(a, g), at_b = value_at(b, g);
  float low = a->t, high = b->t, t = fma(high - low, at_a / (at_a - at_b), low);
  if (!(t > low && t < high)) t = 0.5f * (low + high);
#pragma unroll 1
  for (u32 i = 0; i < 40u; ++i) {
    const ProfileArc now = *READ_AGAIN(arc, t);
    const ArcPlace place = arc_place(ray, &now, t);
    const float off = value_at(&place, g);
    if ((off < 0.0f) == (at_a < 0.0f))
      low = t;
    else
      high = t;
    const float2 slope = arc_slope(&now, t);
    const float rise = fma(ray->sine * slope.y, place.q, -(g * place.r * slope.x));
    const bool ends = place.q == 0.0f;  // the slope of E is infinite
    if (!newton_step(&t, ends ? off : off * place.q, ends ? 0.0f : rise, low, high)) break;
  }
  return t;
}

// The distance of the ray's point at s from the surface, by its tangent at p; its slope and the direction
// away from the axis.
static inline float off_surface(const LatheRays* rays, u32 i, float2 p, float2 normal, float s, float* slope,
                                float2* out) {
  const float3 e = get3(&rays->e, i), at = get3(&rays->base, i) + s * e;
  const float rho = sqrt(fma(at.x, at.x, at.z * at.z));
  *out = rho > 0.0f ? (float2)(at.x, at.z) / rho : (float2)(0.0f);
  *slope = fma(normal.x, dot(*out, (float2)(e.x, e.z)), normal.y * e.y);
  return fma(normal.x, rho - p.x, normal.y * (at.y - p.y));
}

// Offers the hit at t of an arc, on the half `side` of the line, -1 or 1.
static inline void offer_on_arc(__global const ProfileArc* arc, int part, float side, float t,
                                LatheRays* kept, u32 i) {
  const ProfileArc now = *READ_AGAIN(arc, t);
  LatheRays* rays = READ_AGAIN(kept, t);
  const float2 p = arc_point(&now, t), way = arc_way(&now, t);
  const float2 normal = (float2)(way.y, -way.x) / sqrt(dot(way, way));
  const float inverse = REAL_LANE(rays->inverse, i);
  const float by_height = (p.y - REAL_LANE(rays->base.y, i)) / REAL_LANE(rays->e.y, i),
              q = sqrt(fmax(outside_of(p.x, REAL_LANE(rays->m2, i)), 0.0f)),
              by_radius = fma(side * q, inverse, REAL_LANE(rays->middle, i));
  float slope;
  float2 out;
  // From the height or from the radius: the one nearer to the surface.
  const float high = off_surface(rays, i, p, normal, by_height, &slope, &out),
              wide = off_surface(rays, i, p, normal, by_radius, &slope, &out);
  float s = fabs(high) < fabs(wide) || inverse == 0.0f ? by_height : by_radius;
  for (u32 k = 0; k < 2u; ++k) {
    const float off = off_surface(rays, i, p, normal, s, &slope, &out);
    if (k == 0u && fabs(slope) >= 0.05f) s -= off / slope;
  }
  const float along = REAL_LANE(rays->shift, i) + s / REAL_LANE(rays->length, i);
  if (!(along > REAL_LANE(rays->t_min, i) && along <= REAL_LANE(rays->t, i))) return;
  REAL_LANE(rays->t, i) = along;
  set3(&rays->ng, i, (float3)(normal.x * out.x, normal.y, normal.x * out.y));
  MASK_LANE(rays->part, i) = part;
}

// Whether E is monotone between two places where the radius and the height pull it different ways: one of
// them outdoes the other.
static inline bool one_outdoes(const LatheRay* ray, __global const ProfileArc* arc, float g,
                               const ArcPlace* a, const ArcPlace* b) {
  const ProfileArc now = *READ_AGAIN(arc, a->t);
  const float2 from = fabs(arc_slope(&now, a->t)), to = fabs(arc_slope(&now, b->t));
  const ArcPlace inner = a->r < b->r ? *a : *b, outer = a->r < b->r ? *b : *a;
  return ray->sine * fmin(from.y, to.y) * inner.q > fabs(g) * fmax(from.x, to.x) * inner.r ||
         ray->sine * fmax(from.y, to.y) * outer.q < fabs(g) * fmin(from.x, to.x) * outer.r;
}

// Whether E may be 0 between two places.
static inline bool may_be_zero(float g, const ArcPlace* a, const ArcPlace* b) {
  const float p = g * a->q, q = g * b->q;
  return fmin(a->up, b->up) <= fmax(p, q) && fmax(a->up, b->up) >= fmin(p, q);
}

// Intervals are halved this often: what a chord of the 4096th part of an arc cuts off is within rounding.
#define ARC_HALVINGS 12u

// Offers the hits of the half `side` of a line on an arc, between the ends.
static inline void meet_half(__global const ProfileArc* arc, int part, float side, const ArcEnds* ends,
                             LatheRays* rays, u32 i) {
  const LatheRay ray = lathe_ray(rays, i);
  const float g = side * REAL_LANE(rays->e.y, i);
  ArcPlace a = ends->first;
  const ProfileArc whole = *READ_AGAIN(arc, a.t);
  const bool pulled_apart = (whole.end.y - whole.y.x) * g * (whole.end.x - whole.r.x) > 0.0f;
  u32 number = 0, halvings = 0;  // of the interval that begins at a
#pragma unroll 1
  while (number < 1u << halvings) {
    const u32 all = 1u << halvings;
    ArcPlace b = READ_AGAIN(ends, a.t)->last;
    if (number + 1u < all) {
      const float first = READ_AGAIN(ends, a.t)->first.t,
                  t = fma(b.t - first, (float)(number + 1u) / (float)(all), first);
      const ProfileArc now = *READ_AGAIN(arc, t);
      b = arc_place(&ray, &now, t);
    }
    const bool meets = may_be_zero(g, &a, &b);
    if (meets && pulled_apart && halvings < ARC_HALVINGS && !one_outdoes(&ray, arc, g, &a, &b)) {
      number *= 2u;
      ++halvings;
    } else {
      if (meets && (value_at(&a, g) < 0.0f) != (value_at(&b, g) < 0.0f))
        offer_on_arc(arc, part, side, arc_root(&ray, arc, g, &a, &b), rays, i);
      a = b;
      ++number;
      const u32 ended = min(halvings, lowest_bit(number));  // halves whose second half is done
      number >>= ended;
      halvings -= ended;
    }
  }
}

// Offers the arc's hits. `sides`: bit 0, the half before the line's point nearest to the axis; bit 1, the
// other.
NEVER_INLINE void closest_on_arc(__global const ProfileArc* arc, int part, u32 sides, LatheRays* rays,
                                 u32 i) {
  const LatheRay ray = lathe_ray(rays, i);
  const ProfileArc whole = *arc;
  KEEP_LATHE(ArcEnds, ends);
  ends->first = arc_place(&ray, &whole, 0.0f);
  ends->last = arc_place(&ray, &whole, 1.0f);
  const bool first_inside = outside_of(ends->first.r, ray.m2) < 0.0f,
             last_inside = outside_of(ends->last.r, ray.m2) < 0.0f;
  if (first_inside && last_inside) return;
  if (first_inside || last_inside) {
    const ArcPlace end = outer_end(&ray, arc, first_inside);
    if (first_inside)
      ends->first = end;
    else
      ends->last = end;
  }
#pragma unroll 1
  for (u32 k = 0; k < 2u; ++k)
    if (sides >> k & 1u) meet_half(arc, part, k ? 1.0f : -1.0f, ends, rays, i);
}

// The box around an arc, as lines see it: S times heights less the level, and q.
typedef struct ArcBoxes {
  float low, high;
  REAL up_low, up_high, q_low, q_high;
  MASK reached;
} ArcBoxes;

static inline ArcBoxes arc_boxes(const LatheRays* rays, __global const ProfileArc* arc) {
  const REAL zero = (REAL)(0.0f), inner = (REAL)(fmin(arc->r.x, arc->end.x)),
             outer = (REAL)(fmax(arc->r.x, arc->end.x));
  const REAL outside = fma(outer, outer, -rays->m2);
  ArcBoxes box;
  box.low = fmin(arc->y.x, arc->end.y);
  box.high = fmax(arc->y.x, arc->end.y);
  box.up_low = fma(rays->sine, (REAL)(box.low), -rays->level);
  box.up_high = fma(rays->sine, (REAL)(box.high), -rays->level);
  box.q_low = real_sqrt(real_max(fma(inner, inner, -rays->m2), zero));
  box.q_high = real_sqrt(real_max(outside, zero));
  box.reached = MASK_OF(outside > 0.0f);
  return box;
}

// The lines whose half `side` may cross an arc in its box, and within the range of s.
static inline MASK may_meet_arc(const LatheRays* rays, const ArcBoxes* box, float side) {
  const REAL g = side * rays->e.y, near = g * box->q_low, far = g * box->q_high;
  const MASK crosses =
      MASK_OF(box->up_low <= real_max(near, far)) & MASK_OF(box->up_high >= real_min(near, far));
  const REAL a = select(fma(side * box->q_low, rays->inverse, rays->middle),
                        (box->low - rays->base.y) * rays->climb, rays->steep),
             b = select(fma(side * box->q_high, rays->inverse, rays->middle),
                        (box->high - rays->base.y) * rays->climb, rays->steep);
  return crosses & MASK_OF(real_max(a, b) >= rays->from) & MASK_OF(real_min(a, b) <= rays->to);
}

static inline void closest_in_lathe(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                    SolidHits* hits) {
  KEEP_LATHE(LatheRays, rays);
  *rays = lathe_rays(o, d, t_min, hits->t, active);
  active &= MASK_OF(rays->length > 0.0f) & MASK_OF(rays->m2 < parameters.z * parameters.z);
  if (!any_lane(active)) return;
  __global const ProfileArc* arcs = hits->profiles + (u32)parameters.x;
#pragma unroll 1
  for (u32 index = 0; index < (u32)parameters.y; ++index) {
    const ArcBoxes box = arc_boxes(rays, arcs + index);
    const MASK reached = active & box.reached, before = reached & may_meet_arc(rays, &box, -1.0f),
               behind = reached & may_meet_arc(rays, &box, 1.0f);
    EACH_LANE(i, before | behind) {
      const u32 sides = (u32)(-MASK_LANE(before, i) - 2 * MASK_LANE(behind, i));
      closest_on_arc(arcs + index, (int)(index << ARC_SHIFT), sides, rays, i);
    }
  }
  const MASK found = MASK_OF(rays->part >= 0);
  hits->t = select(hits->t, rays->t, found);
  hits->ng = select3(hits->ng, rays->ng, found);
  hits->part = select(hits->part, rays->part, found);
  hits->found |= found;
}

// v is the share of the profile's length, on an arc by a cubic with the right slopes at its ends.
static inline SurfacePoints points_on_lathe(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  SurfacePoints at;
  at.u = turns(p.x, -p.z);
  at.v = (REAL)(0.0f);
  at.dpdu = at.dpdv = round_tangents(p);
  EACH_LANE(i, MASK_OF(part >= 0)) {
    ProfileArc arc;
    float2 place;
    const float3 q = get3(&p, i);
    const float t = find_on_arc(scene, parameters, q, MASK_LANE(part, i), &arc, &place);
    const float s = 1.0f - t, before = arc.along.x, own = arc.along.y, whole = arc.along.z;
    const float way = own * (t * t * fma(2.0f, s, 1.0f)) + length(arc_slope(&arc, 0.0f)) * (s * s * t) -
                      length(arc_slope(&arc, 1.0f)) * (t * t * s);
    REAL_LANE(at.v, i) = (before + clamp(way, 0.0f, own)) / whole;
    const float2 tangent = normalize(arc_way(&arc, t)) * whole,
                 out = place.x > 0.0f ? (float2)(q.x, q.z) / place.x : (float2)(1.0f, 0.0f);
    set3(&at.dpdv, i, (float3)(tangent.x * out.x, tangent.y, tangent.x * out.y));
  }
  return at;
}

static inline REAL curvature_of_lathe(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  REAL curvature = (REAL)(0.0f);
  EACH_LANE(i, MASK_OF(part >= 0)) {
    ProfileArc arc;
    float2 place;
    const float t = find_on_arc(scene, parameters, get3(&p, i), MASK_LANE(part, i), &arc, &place);
    const float2 way = arc_way(&arc, t), bend = arc_bend(&arc, t);
    const float size = length(way);
    REAL_LANE(curvature, i) = 0.5f * ((way.x * bend.y - way.y * bend.x) / (size * size * size) +
                                      way.y / (size * fmax(place.x, 1e-6f)));
  }
  return curvature;
}
#endif

static inline float4 reach_of_lathe(float4 parameters) {
  return (float4)(parameters.z, parameters.w, parameters.z, REACH_ROUND);
}
static inline u32 convexity_of_lathe(float4 parameters) { return CONCAVE; }
