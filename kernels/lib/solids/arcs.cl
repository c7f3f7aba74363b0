// Arcs of a lathe's profile: points, directions, and the arc of a hit.
#pragma once
#include "lib/core/config.h"
#include "lib/core/tables.h"

#if HAS_LATHE
// A hit's part: the number of the arc, above BOX_FACE.
#define ARC_SHIFT 9

// The radius and height at t; at both ends to the bit those of the neighbours.
static inline float2 arc_point(const ProfileArc* arc, float t) {
  if (t >= 1.0f) return arc->end.xy;
  return (float2)(fma(fma(fma(arc->r.w, t, arc->r.z), t, arc->r.y), t, arc->r.x),
                  fma(fma(fma(arc->y.w, t, arc->y.z), t, arc->y.y), t, arc->y.x));
}
static inline float2 arc_slope(const ProfileArc* arc, float t) {
  return (float2)(fma(fma(3.0f * arc->r.w, t, 2.0f * arc->r.z), t, arc->r.y),
                  fma(fma(3.0f * arc->y.w, t, 2.0f * arc->y.z), t, arc->y.y));
}
static inline float2 arc_bend(const ProfileArc* arc, float t) {
  return (float2)(fma(6.0f * arc->r.w, t, 2.0f * arc->r.z), fma(6.0f * arc->y.w, t, 2.0f * arc->y.z));
}
// The direction at t: the chord's at a cusp.
static inline float2 arc_way(const ProfileArc* arc, float t) {
  const float2 chord = arc->end.xy - (float2)(arc->r.x, arc->y.x), slope = arc_slope(arc, t);
  return dot(slope, slope) > 1e-12f * dot(chord, chord) ? slope : chord;
}

// Takes Newton's step from t if it stays between the bounds, else to their middle. False: t is found, as the
// step would be within rounding; bisection would then go far off.
static inline bool newton_step(float* t, float off, float slope, float low, float high) {
  if (fabs(off) <= 0x1p-23f * fabs(slope)) return false;
  const float next = slope != 0.0f ? *t - off / slope : low;
  const float before = *t;
  *t = next > low && next < high ? next : 0.5f * (low + high);
  return fabs(*t - before) > 0x1p-24f;
}

// The arc of a part, and its t at a point near it.
static inline float find_on_arc(const Scene* scene, float4 parameters, float3 p, int part, ProfileArc* arc,
                                float2* place) {
  const u32 index = min((u32)part >> ARC_SHIFT, (u32)parameters.y - 1u);
  *arc = scene->profiles[(u32)parameters.x + index];
  *place = (float2)(sqrt(fma(p.x, p.x, p.z * p.z)), p.y);
  const float2 change = arc->end.xy - (float2)(arc->r.x, arc->y.x);
  const bool by_radius = fabs(change.x) > fabs(change.y), rises = (by_radius ? change.x : change.y) > 0.0f;
  float low = 0.0f, high = 1.0f, t = 0.5f;
#pragma unroll 1
  for (u32 i = 0; i < 20u; ++i) {
    const float2 off = arc_point(arc, t) - *place, slope = arc_slope(arc, t);
    const float value = by_radius ? off.x : off.y;
    if ((value < 0.0f) == rises)
      low = t;
    else
      high = t;
    if (!newton_step(&t, value, by_radius ? slope.x : slope.y, low, high)) break;
  }
  return t;
}
#endif
