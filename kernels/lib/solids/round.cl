// The sphere, planar solids and solids of revolution about y: ray intersection, coordinates of a surface
// point p and the mean curvature there (shared/shapes.h).
#pragma once
#include "lib/solids/spans.cl"
#include "lib/solids/surface_points.cl"

static inline void closest_in_sphere(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                     SolidHits* hits) {
  REAL3 near = o;
  const REAL shift = come_near(&near, d, active);
  const Span span = round_span(near, d, 1.0f);
  const REAL t = select(span.leave, span.enter, MASK_OF(shift + span.enter > t_min));
  offer(shift + t, along3(near, t, d), NO_LANES, active & span.crosses, t_min, hits);
}

static inline SurfacePoints points_on_sphere(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  const REAL r = radius_about_y(p), zero = (REAL)(0.0f);
  SurfacePoints at;
  at.u = turns(p.x, -p.z);
  at.v = 0.5f + 2.0f * copysign(turns(r, fabs(p.y)), p.y);
  at.dpdu = round_tangents(p);
  at.dpdv = scale3(along3(real3(zero, r, zero), -p.y, away_from_axis(p, r)), (REAL)(M_PI_F));
  return at;
}

static inline REAL curvature_of_sphere(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return (REAL)(1.0f);
}
static inline float4 reach_of_sphere(float4 parameters) { return (float4)(1.0f, 1.0f, 1.0f, REACH_BALL); }
static inline u32 convexity_of_sphere(float4 parameters) { return CONVEX; }

static inline void closest_in_plane(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                    SolidHits* hits) {
  offer(-o.y / d.y, up_or_down((REAL)(1.0f)), NO_LANES, active & MASK_OF(d.y != 0.0f), t_min, hits);
}

static inline SurfacePoints points_on_plane(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  const SurfacePoints at = {p.x, -p.z, all3((float3)(1.0f, 0.0f, 0.0f)), all3((float3)(0.0f, 0.0f, -1.0f))};
  return at;
}

static inline REAL curvature_of_plane(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return (REAL)(0.0f);
}
static inline float4 reach_of_plane(float4 parameters) { return (float4)(0.0f); }
static inline u32 convexity_of_plane(float4 parameters) { return CONVEX; }

// A ring in a plane of constant y, with its normal towards `side` of y. `ring`: y, inner and outer radius,
// side.
static inline void offer_ring(REAL3 o, REAL3 d, float4 ring, int part, REAL t_min, MASK active,
                              SolidHits* hits) {
  const REAL t = (ring.x - o.y) / d.y;
  const REAL x = fma(t, d.x, o.x), z = fma(t, d.z, o.z);
  const REAL r2 = fma(x, x, z * z);
  const MASK within = MASK_OF(d.y != 0.0f) & MASK_OF(r2 <= ring.z * ring.z) & MASK_OF(r2 >= ring.y * ring.y);
  offer(t, up_or_down((REAL)(ring.w)), (MASK)(part), active & within, t_min, hits);
}

static inline void closest_in_disk(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                   SolidHits* hits) {
  offer_ring(o, d, (float4)(0.0f, parameters.x, 1.0f, 1.0f), 0, t_min, active, hits);
}

// Coordinates on the square around a unit disk, seen from above or, if `below`, from below.
static inline SurfacePoints points_in_plane(REAL3 p, MASK below) {
  const REAL zero = (REAL)(0.0f), up = select((REAL)(-1.0f), (REAL)(1.0f), below);
  const SurfacePoints at = {0.5f + 0.5f * p.x, fma(0.5f * up, p.z, (REAL)(0.5f)),
                            all3((float3)(2.0f, 0.0f, 0.0f)), real3(zero, zero, 2.0f * up)};
  return at;
}

static inline SurfacePoints points_on_disk(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return points_in_plane(p, NO_LANES);
}
static inline REAL curvature_of_disk(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return (REAL)(0.0f);
}
static inline float4 reach_of_disk(float4 parameters) { return (float4)(1.0f, 0.0f, 1.0f, REACH_ROUND); }
static inline u32 convexity_of_disk(float4 parameters) {
  return parameters.x == 0.0f ? CONVEX : CONVEX_OUTSIDE;
}

static inline void closest_in_rectangle(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                        SolidHits* hits) {
  const REAL t = -o.y / d.y;
  const REAL x = fma(t, d.x, o.x), z = fma(t, d.z, o.z);
  const MASK within = MASK_OF(d.y != 0.0f) & MASK_OF(real_max(fabs(x), fabs(z)) <= 1.0f);
  offer(t, up_or_down((REAL)(1.0f)), NO_LANES, active & within, t_min, hits);
}

static inline SurfacePoints points_on_rectangle(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return points_in_plane(p, NO_LANES);
}
static inline REAL curvature_of_rectangle(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return (REAL)(0.0f);
}
static inline float4 reach_of_rectangle(float4 parameters) { return (float4)(1.0f, 0.0f, 1.0f, REACH_BOX); }
static inline u32 convexity_of_rectangle(float4 parameters) { return CONVEX; }

// Coordinates on a cylinder or cone; `growth`: of the radius with height.
static inline SurfacePoints on_tube(REAL3 p, float growth) {
  const REAL3 up = all3((float3)(0.0f, 1.0f, 0.0f));
  SurfacePoints at;
  at.u = turns(p.x, -p.z);
  at.v = 0.5f + 0.5f * p.y;
  at.dpdu = round_tangents(p);
  at.dpdv = scale3(along3(up, (REAL)(growth), away_from_axis(p, radius_about_y(p))), (REAL)(2.0f));
  return at;
}

// For the side of a cylinder or cone; caps are flat.
static inline REAL tube_curvature(REAL3 p, MASK part) {
  return select((REAL)(0.0f), 0.5f / nonzero(radius_about_y(p)), MASK_OF(part == 0));
}

static inline void closest_in_cylinder(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                       SolidHits* hits) {
  const REAL zero = (REAL)(0.0f);
  REAL3 near = o;
  const REAL shift = come_near(&near, d, active);
  const Span span = round_span(real3(near.x, zero, near.z), real3(d.x, zero, d.z), 1.0f);
  for (u32 i = 0; i < 2u; ++i) {
    const REAL t = i ? span.leave : span.enter;
    const REAL3 p = along3(near, t, d);
    offer(shift + t, real3(p.x, zero, p.z), NO_LANES, active & span.crosses & MASK_OF(fabs(p.y) <= 1.0f),
          t_min, hits);
  }
  if (parameters.x != 0.0f) {
    offer_ring(o, d, (float4)(1.0f, 0.0f, 1.0f, 1.0f), 1, t_min, active, hits);
    offer_ring(o, d, (float4)(-1.0f, 0.0f, 1.0f, -1.0f), 2, t_min, active, hits);
  }
}

static inline SurfacePoints points_on_cylinder(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return select_points(on_tube(p, 0.0f), points_in_plane(p, MASK_OF(part == 2)), MASK_OF(part != 0));
}
static inline REAL curvature_of_cylinder(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return tube_curvature(p, part);
}
static inline float4 reach_of_cylinder(float4 parameters) { return (float4)(1.0f, 1.0f, 1.0f, REACH_ROUND); }
static inline u32 convexity_of_cylinder(float4 parameters) {
  return parameters.x != 0.0f ? CONVEX : CONVEX_OUTSIDE;
}

// The side: x^2 + z^2 = (m + k y)^2 with the mean radius m and slope k, |y| <= 1.
static inline void closest_in_cone(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                   SolidHits* hits) {
  const float m = 0.5f * (parameters.x + parameters.y), k = 0.5f * (parameters.y - parameters.x);
  // Relative to the ray's point nearest to the origin, the coefficients keep their precision.
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
    offer_ring(o, d, (float4)(1.0f, 0.0f, parameters.y, 1.0f), 1, t_min, active, hits);
    offer_ring(o, d, (float4)(-1.0f, 0.0f, parameters.x, -1.0f), 2, t_min, active, hits);
  }
}

static inline SurfacePoints points_on_cone(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return select_points(on_tube(p, 0.5f * (parameters.y - parameters.x)),
                       points_in_plane(p, MASK_OF(part == 2)), MASK_OF(part != 0));
}
static inline REAL curvature_of_cone(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  return tube_curvature(p, part);
}
static inline float4 reach_of_cone(float4 parameters) {
  const float radius = fmax(parameters.x, parameters.y);
  return (float4)(radius, 1.0f, radius, REACH_ROUND);
}
static inline u32 convexity_of_cone(float4 parameters) {
  return parameters.z != 0.0f ? CONVEX : CONVEX_OUTSIDE;
}
