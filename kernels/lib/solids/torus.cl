// Intersects one ray with a torus about the y axis: (|p|^2 + 1 - r^2)^2 = 4 (x^2 + z^2), major radius 1,
// minor radius r. The extrema of the quartic isolate all four roots.
#pragma once
#include "lib/core/config.h"
#include "lib/core/quartic.cl"
#include "lib/solids/spans.cl"
#include "lib/solids/surface_points.cl"

typedef struct TorusHit {
  float t;
  float3 ng;
} TorusHit;

// Returns whether there is a hit in (t_min, hit->t].
NEVER_INLINE bool closest_in_one_torus(float r, float3 o, float3 d, float t_min, TorusHit* hit) {
  const float length_d = sqrt(dot(d, d));
  const float3 e = d / length_d;
  const float shift = -dot(o, e);  // the line's point nearest to the centre, in units of length
  const float3 s = o + shift * e;
  // Slightly beyond the ball around the torus; otherwise rounding hides the change of sign at its equator.
  const float reach2 = 1.001f * (1.0f + r) * (1.0f + r) - dot(s, s);
  if (!(reach2 > 0.0f)) return false;
  const float reach = sqrt(reach2);
  // With p = s + x e and s.e = 0: |p|^2 = x^2 + |s|^2.
  const float g = dot(s, s) + 1.0f - r * r;
  const float a2 = fma(-4.0f, fma(e.x, e.x, e.z * e.z), 2.0f * g);
  const float a1 = -8.0f * fma(s.x, e.x, s.z * e.z);
  const float a0 = fma(g, g, -4.0f * fma(s.x, s.x, s.z * s.z));
  float roots[MOST_ROOTS];
  const u32 count = quartic_roots(a2, a1, a0, -reach, reach, roots);
  bool found = false;
#pragma unroll 1
  for (u32 i = 0; i < count; ++i) {
    float x = roots[i];
    float3 p = s + x * e;
    float off = 0.0f;
    // Newton's method on the distance, which is more precise than the quartic: two steps, and along a
    // silhouette, where the quartic has lost its digits, until it converges.
    for (u32 step = 0; step < 8u; ++step) {
      const float rho = sqrt(fma(p.x, p.x, p.z * p.z));
      const float ring = rho - 1.0f, tube = sqrt(fma(ring, ring, p.y * p.y));
      const float slope =
          ((p.x * e.x + p.z * e.z) * (ring / fmax(rho, 1e-12f)) + p.y * e.y) / fmax(tube, 1e-12f);
      off = tube - r;
      if (step >= 2u && fabs(slope) >= 0.05f) break;
      x -= clamp(off / copysign(fmax(fabs(slope), 1e-6f), slope), -0.25f * r, 0.25f * r);
      p = s + x * e;
    }
    const float rho = sqrt(fma(p.x, p.x, p.z * p.z)), inward = 1.0f - 1.0f / fmax(rho, 1e-12f);
    const float t = (x + shift) / length_d;
    if (!(t > t_min && t <= hit->t) || fabs(off) > 1e-6f) continue;
    hit->t = t;
    hit->ng = (float3)(p.x * inward, p.y, p.z * inward);
    found = true;
  }
  return found;
}

static inline void closest_in_torus(float4 parameters, REAL3 o, REAL3 d, REAL t_min, MASK active,
                                    SolidHits* hits) {
  EACH_LANE(i, active) {
    TorusHit hit = {REAL_LANE(hits->t, i), (float3)(0.0f)};
    if (!closest_in_one_torus(parameters.x, get3(&o, i), get3(&d, i), REAL_LANE(t_min, i), &hit)) continue;
    REAL_LANE(hits->t, i) = hit.t;
    set3(&hits->ng, i, hit.ng);
    MASK_LANE(hits->part, i) = 0;
    MASK_LANE(hits->found, i) = -1;
  }
}

static inline SurfacePoints points_on_torus(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  const REAL r = radius_about_y(p), zero = (REAL)(0.0f);
  SurfacePoints at;
  at.u = turns(p.x, -p.z);
  at.v = turns(r - 1.0f, p.y);
  at.dpdu = round_tangents(p);
  at.dpdv = scale3(along3(real3(zero, r - 1.0f, zero), -p.y, away_from_axis(p, r)), (REAL)(2.0f * M_PI_F));
  return at;
}

static inline REAL curvature_of_torus(const Scene* scene, float4 parameters, REAL3 p, MASK part) {
  const REAL radius = radius_about_y(p);
  return 0.5f * (1.0f / parameters.x + (radius - 1.0f) / (parameters.x * nonzero(radius)));
}
static inline float4 reach_of_torus(float4 parameters) {
  return (float4)(1.0f + parameters.x, parameters.x, 1.0f + parameters.x, REACH_ROUND);
}
static inline u32 convexity_of_torus(float4 parameters) { return CONCAVE; }
