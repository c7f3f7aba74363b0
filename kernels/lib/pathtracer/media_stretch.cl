// Stretches of rays through media that scatter: where on them light is scattered, by the medium's decay or
// towards a light (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating
// Media"), and whereto (Henyey and Greenstein 1941). A ray a lane.
#ifndef SUNDOG_LIB_MEDIA_STRETCH_CL
#define SUNDOG_LIB_MEDIA_STRETCH_CL
#include "lib/core/directions.cl"
#include "lib/core/tables.h"
#include "lib/light/area_light.cl"
#include "lib/pathtracer/sampled_spectrum.cl"

#if HAS_SCATTERING
// What a scattered path remembers of the stretch that it was scattered on.
typedef struct Scattered {
  MASK lanes;   // those that were scattered last by a medium
  REAL3 o, d;   // the stretch's beginning and direction
  REAL length;  // may be infinite
  REAL at;      // where on it
  REAL decay;   // of the medium, the mean of the colours
  REAL chance;  // the density of `at` by next_distance()
} Scattered;

#define TOWARDS_LIGHT 0.5f  // the greatest part of the distances that are chosen for a near light

// Of light, over a distance that may be infinite.
static inline REAL kept_over(REAL decay, REAL distance) {
  return select(real_exp(-decay * distance), (REAL)(1.0f), MASK_OF(decay == 0.0f));
}

// 1 - exp(-x), and -log(1 - y), exact for small numbers.
static inline REAL lost_part(REAL x) {
  const REAL small = x * fma(x, fma(x, (REAL)(1.0f / 6.0f), (REAL)(-0.5f)), (REAL)(1.0f));
  return select(1.0f - real_exp(-x), small, MASK_OF(x < 0.01f));
}
static inline REAL depth_of_lost(REAL y) {
  const REAL small = y * fma(y, fma(y, (REAL)(1.0f / 3.0f), (REAL)(0.5f)), (REAL)(1.0f));
  return select(-real_log(real_max(1.0f - y, (REAL)(0x1p-24f))), small, MASK_OF(y < 0.01f));
}

// The density of a distance within the length by one decay, times its share.
static inline REAL next_of(REAL decay, REAL share, REAL length, REAL at) {
  const MASK some = MASK_OF(share * decay > 0.0f);
  const REAL lost = lost_part(decay * length);
  return select((REAL)(0.0f), share * decay * kept_over(decay, at) / select((REAL)(1.0f), lost, some), some);
}

// Of decays and shares, one a colour or a wavelength: what is kept over a distance; the sum; the decay that
// the number u chooses by the shares, whose sum is 1; and the density of a distance by all of them.
#if HAS_DISPERSION
static inline SampledSpectrum spectrum_over(SampledSpectrum decay, REAL distance) {
  SampledSpectrum kept;
  EACH_WAVELENGTH(i) kept.of[i] = kept_over(decay.of[i], distance);
  return kept;
}
static inline REAL spectrum_sum(SampledSpectrum a) { return (a.of[0] + a.of[1]) + (a.of[2] + a.of[3]); }
static inline REAL by_share(SampledSpectrum of, SampledSpectrum shares, REAL u) {
  REAL chosen = of.of[0], sum = shares.of[0];
  for (u32 i = 1; i < WAVELENGTHS; ++i) {
    chosen = select(chosen, of.of[i], MASK_OF(u >= sum) & MASK_OF(shares.of[i] > 0.0f));
    sum += shares.of[i];
  }
  return chosen;
}
static inline REAL next_pdf(SampledSpectrum decay, SampledSpectrum shares, REAL length, REAL at) {
  REAL pdf = (REAL)(0.0f);
  EACH_WAVELENGTH(i) pdf += next_of(decay.of[i], shares.of[i], length, at);
  return pdf;
}
static inline SampledSpectrum where_positive(SampledSpectrum a, SampledSpectrum b) {
  SampledSpectrum made;
  EACH_WAVELENGTH(i) made.of[i] = select((REAL)(0.0f), a.of[i], MASK_OF(b.of[i] > 0.0f));
  return made;
}
#else
static inline SampledSpectrum spectrum_over(SampledSpectrum decay, REAL distance) {
  return real3(kept_over(decay.x, distance), kept_over(decay.y, distance), kept_over(decay.z, distance));
}
static inline REAL spectrum_sum(SampledSpectrum a) { return a.x + a.y + a.z; }
static inline REAL by_share(SampledSpectrum of, SampledSpectrum shares, REAL u) {
  const REAL two = select(of.x, of.y, MASK_OF(u >= shares.x) & MASK_OF(shares.y > 0.0f));
  return select(two, of.z, MASK_OF(u >= shares.x + shares.y) & MASK_OF(shares.z > 0.0f));
}
static inline REAL next_pdf(SampledSpectrum decay, SampledSpectrum shares, REAL length, REAL at) {
  return next_of(decay.x, shares.x, length, at) + next_of(decay.y, shares.y, length, at) +
         next_of(decay.z, shares.z, length, at);
}
static inline SampledSpectrum where_positive(SampledSpectrum a, SampledSpectrum b) {
  const REAL zero = (REAL)(0.0f);
  return real3(select(zero, a.x, MASK_OF(b.x > 0.0f)), select(zero, a.y, MASK_OF(b.y > 0.0f)),
               select(zero, a.z, MASK_OF(b.z > 0.0f)));
}
#endif

// Numbers that are not negative as shares; where all are 0, even ones.
static inline SampledSpectrum shares_of(SampledSpectrum a) {
  const REAL sum = spectrum_sum(a), all = spectrum_sum(spectrum_all(1.0f));
  const MASK some = MASK_OF(sum > 0.0f) & MASK_OF(sum < INFINITY);
  return spectrum_select(spectrum_scale(spectrum_all(1.0f), 1.0f / all),
                         spectrum_scale(a, 1.0f / select((REAL)(1.0f), sum, some)), some);
}

// A distance within the length by the decay; u chooses it, u_color the decay's component.
static inline REAL next_distance(SampledSpectrum decay, SampledSpectrum shares, REAL length, REAL u,
                                 REAL u_color) {
  const REAL chosen = by_share(decay, shares, u_color);
  return real_min(depth_of_lost(u * lost_part(chosen * length)) / nonzero(chosen), length);
}

// A stretch as a light sees it: the place nearest to the light, how far that is, the way from there to the
// beginning, and the angle that the stretch takes up.
typedef struct SeenStretch {
  REAL nearest, height, begin, angle;
  REAL part;  // of the distances that are chosen evenly in the angle
} SeenStretch;

static inline SeenStretch see_stretch(REAL3 o, REAL3 d, REAL length, REAL decay, float4 light) {
  SeenStretch s;
  const REAL3 to = subtract3(all3(light.xyz), o);
  s.nearest = dot3(to, d);
  const REAL3 across = along3(to, -s.nearest, d);
  s.height = real_sqrt(real_max(dot3(across, across) + light.w, 1e-12f * dot3(to, to) + 1e-30f));
  s.begin = -s.nearest;
  const REAL end = length - s.nearest;
  // Of a long stretch's end the angle is a right one.
  const MASK far = MASK_OF(end > 1e6f * (s.height + fabs(s.begin)));
  s.angle = atan2(select(length * s.height, s.height, far),
                  select(fma(s.begin, end, s.height * s.height), s.begin, far));
  const REAL way = real_clamp(s.nearest, (REAL)(0.0f), length);
  s.part = select((REAL)(0.0f), TOWARDS_LIGHT * real_exp(-decay * way), MASK_OF(s.angle > 1e-6f));
  return s;
}

static inline REAL distance_by_angle(const SeenStretch* s, REAL length, REAL u) {
  const REAL tangent = tan(u * s->angle);
  const REAL x = s->height * fma(s->height, tangent, s->begin) / nonzero(fma(-s->begin, tangent, s->height));
  return real_clamp(s->nearest + x, (REAL)(0.0f), length);
}

// The density of a distance that is chosen both ways, where the other way's is `chance`.
static inline REAL pdf_towards(const SeenStretch* s, REAL at, REAL chance) {
  const REAL x = at - s->nearest, square = fma(x, x, s->height * s->height);
  const REAL seen = s->height / (real_max(s->angle, (REAL)(1e-6f)) * square);
  return fma(s->part, seen, (1.0f - s->part) * chance);
}

// The density of directions at the cosine to the way that light went.
static inline REAL phase_pdf(REAL g, REAL cosine) {
  const REAL base = real_max(fma(g, g - 2.0f * cosine, (REAL)(1.0f)), (REAL)(1e-12f));
  return 0.25f / M_PI_F * fma(-g, g, (REAL)(1.0f)) / (base * real_sqrt(base));
}
static inline REAL phase_cosine(REAL g, REAL u) {
  const MASK even = MASK_OF(fabs(g) < 1e-3f);
  const REAL some = select(g, (REAL)(0.5f), even);
  const REAL root = fma(-some, some, (REAL)(1.0f)) / fma(2.0f * some, u, 1.0f - some);
  const REAL cosine = fma(some, some, fma(-root, root, (REAL)(1.0f))) / (2.0f * some);
  return real_clamp(select(cosine, fma((REAL)(-2.0f), u, (REAL)(1.0f)), even), (REAL)(-1.0f), (REAL)(1.0f));
}

// Where a stretch stands for its points when a light is chosen for it.
static inline REAL3 place_for_lights(REAL3 o, REAL3 d, REAL length, REAL decay) {
  return along3(o, real_min(0.5f * length, 1.0f / nonzero(decay)), d);
}
#endif

#endif
