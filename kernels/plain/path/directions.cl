// Directions about an axis and points in a disk; `turn`: a part of a circle.
#include "plain/core.h"

// Sine and cosine, both to 1.2e-7 (polynomials at Chebyshev nodes). Unlike the library's, they have the same
// bits on every device.
ENTRY static inline void sincos_of_turn(float turn, OUT float* sine, OUT float* cosine) {
  const float quarters = 4.0f * turn, nearest = rint(quarters);
  const float x = quarters - nearest, z = x * x;
  float s = fma(z, -0.0046021631f, 0.0796802229f);
  s = x * fma(z, fma(z, s, -0.645963478f), 1.57079632f);
  float c = fma(z, 0.000903975442f, -0.0208602648f);
  c = fma(z, fma(z, fma(z, c, 0.25366924f), -1.23370054f), 1.0f);
  const int quarter = (int)nearest;
  const bool odd = (quarter & 1) != 0;
  *sine = as_float(as_int(odd ? c : s) ^ ((quarter & 2) << 30));
  *cosine = as_float(as_int(odd ? s : c) ^ (((quarter + 1) & 2) << 30));
}

// The arc cosine of x in [-1, 1], to 3e-7, from the smaller of x and the sine of the half angle.
ENTRY static inline float real_acos(float x) {
  const float size = fabs(x);
  const bool steep = size > 0.5f;
  const float z = steep ? fma(size, -0.5f, 0.5f) : size * size, s = steep ? real_sqrt(z) : size;
  float p = fma(z, 0.0421473649f, 0.0241886496f);
  p = fma(z, fma(z, fma(z, p, 0.0454691882f), 0.0749529794f), 0.166667529f);
  p = fma(s * z, p, s);
  const float angle = steep ? 2.0f * p : 0.5f * M_PI_F - p;
  return x < 0.0f ? M_PI_F - angle : angle;
}

// Completes the unit vector n to an orthonormal basis (Duff and others 2017, "Building an Orthonormal Basis,
// Revisited").
static inline void tangent_frame(float3 n, OUT float3* s, OUT float3* t) {
  const float sign = copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  *s = (float3)(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
  *t = (float3)(b, sign + n.y * n.y * a, -n.y);
}

// The direction with this cosine and sine to the unit axis.
static inline float3 direction_at(float3 axis, float cosine, float sine, float turn) {
  float3 s, t;
  float across, along;
  tangent_frame(axis, &s, &t);
  sincos_of_turn(turn, &across, &along);
  return axis * cosine + (s * (sine * along) + t * (sine * across));
}
static inline float3 direction_about(float3 axis, float c, float turn) {
  return direction_at(axis, c, real_sqrt(real_max(1.0f - c * c, 0.0f)), turn);
}

// The unit vector across the axis, and the direction at the distance `side` from the axis; drop: 1 minus its
// cosine.
static inline float3 across_axis(float3 axis, float turn) {
  float3 s, t;
  tangent_frame(axis, &s, &t);
  return cospi(2.0f * turn) * s + sinpi(2.0f * turn) * t;
}
static inline float3 direction_beside(float3 axis, float drop, float side, float turn) {
  const float3 d = (1.0f - drop) * axis + side * across_axis(axis, turn);
  return d * rsqrt(plain_dot(d, d));
}

// A uniformly distributed point of the unit disk (Shirley and Chiu 1997, "A Low Distortion Map Between Disk
// and Square").
static inline void place_in_disk(float u_x, float u_y, OUT float* x, OUT float* y) {
  const float a = fma(u_x, 2.0f, -1.0f), b = fma(u_y, 2.0f, -1.0f);
  const bool wide = fabs(a) > fabs(b);
  const float r = wide ? a : b, part = (wide ? b : a) / nonzero(r) * 0.125f;
  float sine, cosine;
  sincos_of_turn(wide ? part : 0.25f - part, &sine, &cosine);
  *x = r * cosine;
  *y = r * sine;
}
