// Segments of rays through media that scatter: where on them light is scattered, by the medium's decay or
// towards a light (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating
// Media"), and whereto (Henyey and Greenstein 1941).
#include "plain/core.h"
#include "plain/pathtracer/spectrum.cl"

// The segment that a path was scattered on.
typedef struct Scattered {
  bool is;       // scattered last by a medium
  float3 o, d;   // the segment's beginning and direction
  float length;  // may be infinite
  float at;      // where on it
  float decay;   // of the medium, the mean of the colours
  float chance;  // the density of `at` by next_distance()
} Scattered;

#define TOWARDS_LIGHT 0.5f  // the greatest part of the distances that are chosen for a near light

// Beer's transmittance over a distance that may be infinite.
static inline float kept_over(float decay, float distance) {
  return decay == 0.0f ? 1.0f : real_exp(-decay * distance);
}

// 1 - exp(-x), and -log(1 - y), exact for small numbers.
static inline float lost_part(float x) {
  const float small = x * fma(x, fma(x, 1.0f / 6.0f, -0.5f), 1.0f);
  return x < 0.01f ? small : 1.0f - real_exp(-x);
}
static inline float depth_of_lost(float y) {
  const float small = y * fma(y, fma(y, 1.0f / 3.0f, 0.5f), 1.0f);
  return y < 0.01f ? small : -real_log(real_max(1.0f - y, 0x1p-24f));
}

// The density of a distance within the length by one decay, times its share.
static inline float next_of(float decay, float share, float length, float at) {
  return share * decay > 0.0f ? share * decay * kept_over(decay, at) / lost_part(decay * length) : 0.0f;
}

// Decays and shares have a number a colour or wavelength: the transmittance over a distance; the sum; the
// decay that u chooses by the shares, whose sum is 1; the density of a distance by all of them.
static inline SampledSpectrum spectrum_over(SampledSpectrum decay, float distance) {
  SampledSpectrum kept;
  kept.x = kept_over(decay.x, distance);
  kept.y = kept_over(decay.y, distance);
  kept.z = kept_over(decay.z, distance);
  if (HAS_DISPERSION) kept.w = kept_over(decay.w, distance);
  return kept;
}
static inline float spectrum_sum(SampledSpectrum a) {
  if (HAS_DISPERSION) return (a.x + a.y) + (a.z + a.w);
  return a.x + a.y + a.z;
}
static inline float by_share(SampledSpectrum of, SampledSpectrum shares, float u) {
  float chosen = of.x;
  if (u >= shares.x && shares.y > 0.0f) chosen = of.y;
  if (u >= shares.x + shares.y && shares.z > 0.0f) chosen = of.z;
  if (HAS_DISPERSION && u >= shares.x + shares.y + shares.z && shares.w > 0.0f) chosen = of.w;
  return chosen;
}
static inline float next_pdf(SampledSpectrum decay, SampledSpectrum shares, float length, float at) {
  float pdf = next_of(decay.x, shares.x, length, at) + next_of(decay.y, shares.y, length, at) +
              next_of(decay.z, shares.z, length, at);
  if (HAS_DISPERSION) pdf += next_of(decay.w, shares.w, length, at);
  return pdf;
}
static inline SampledSpectrum where_positive(SampledSpectrum a, SampledSpectrum b) {
  SampledSpectrum made;
  made.x = b.x > 0.0f ? a.x : 0.0f;
  made.y = b.y > 0.0f ? a.y : 0.0f;
  made.z = b.z > 0.0f ? a.z : 0.0f;
  if (HAS_DISPERSION) made.w = b.w > 0.0f ? a.w : 0.0f;
  return made;
}

// Numbers that are not negative as shares; where all are 0, even ones.
static inline SampledSpectrum shares_of(SampledSpectrum a) {
  const SampledSpectrum one = (SampledSpectrum)(1.0f);
  const float sum = spectrum_sum(a);
  return sum > 0.0f && sum < INFINITY ? a * (1.0f / sum) : one * (1.0f / spectrum_sum(one));
}

// A distance within the length by the decay; u chooses it, u_color the decay's component.
static inline float next_distance(SampledSpectrum decay, SampledSpectrum shares, float length, float u,
                                  float u_color) {
  const float chosen = by_share(decay, shares, u_color);
  return real_min(depth_of_lost(u * lost_part(chosen * length)) / nonzero(chosen), length);
}

// A segment as a light sees it: the place nearest to the light, how far that is, the way from there to the
// beginning, and the angle that the segment takes up.
typedef struct SeenSegment {
  float nearest, height, begin, angle;
  float part;  // of the distances that are chosen evenly in the angle
} SeenSegment;

static inline SeenSegment see_segment(float3 o, float3 d, float length, float decay, UNIFORM float4 light) {
  SeenSegment s;
  const float3 to = light.xyz - o;
  s.nearest = dot(to, d);
  const float3 across = along(to, -s.nearest, d);
  s.height = real_sqrt(real_max(dot(across, across) + light.w, 1e-12f * dot(to, to) + 1e-30f));
  s.begin = -s.nearest;
  const float end = length - s.nearest;
  // The angle at a long segment's end is a right one.
  const bool far = end > 1e6f * (s.height + fabs(s.begin));
  s.angle = atan2(far ? s.height : length * s.height, far ? s.begin : fma(s.begin, end, s.height * s.height));
  const float way = real_clamp(s.nearest, 0.0f, length);
  s.part = s.angle > 1e-6f ? TOWARDS_LIGHT * real_exp(-decay * way) : 0.0f;
  return s;
}

static inline float distance_by_angle(const SeenSegment* s, float length, float u) {
  const float tangent = tan(u * s->angle);
  const float x = s->height * fma(s->height, tangent, s->begin) / nonzero(fma(-s->begin, tangent, s->height));
  return real_clamp(s->nearest + x, 0.0f, length);
}

// The density of a distance that is chosen both ways, where the other way's is `chance`.
static inline float pdf_towards(const SeenSegment* s, float at, float chance) {
  const float x = at - s->nearest, square = fma(x, x, s->height * s->height);
  const float seen = s->height / (real_max(s->angle, 1e-6f) * square);
  return fma(s->part, seen, (1.0f - s->part) * chance);
}

// The density of directions at the cosine to the way that light went.
static inline float phase_pdf(float g, float cosine) {
  const float base = real_max(fma(g, g - 2.0f * cosine, 1.0f), 1e-12f);
  return 0.25f / M_PI_F * fma(-g, g, 1.0f) / (base * real_sqrt(base));
}
static inline float phase_cosine(float g, float u) {
  const bool even = fabs(g) < 1e-3f;
  const float some = even ? 0.5f : g;
  const float root = fma(-some, some, 1.0f) / fma(2.0f * some, u, 1.0f - some);
  const float cosine = fma(some, some, fma(-root, root, 1.0f)) / (2.0f * some);
  return real_clamp(even ? fma(-2.0f, u, 1.0f) : cosine, -1.0f, 1.0f);
}

// Where a segment stands for its points when a light is chosen for it.
static inline float3 place_for_lights(float3 o, float3 d, float length, float decay) {
  return along(o, real_min(0.5f * length, 1.0f / nonzero(decay)), d);
}
