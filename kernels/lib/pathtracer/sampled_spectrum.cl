// What a path carries: red, green and blue, or in scenes where a medium disperses four wavelengths, of which
// the first, the hero, decides where the path goes (Wilkie and others 2014, "Hero Wavelength Spectral
// Sampling"). The others lie evenly between, by the density of shared/spectra.h, and go along until the
// wavelengths part: from there on the hero stands for them. Colours become spectra by three fixed ones that
// together are white (host/scene/spectra/upsample.h). A path a lane.
#ifndef SUNDOG_LIB_SAMPLED_SPECTRUM_CL
#define SUNDOG_LIB_SAMPLED_SPECTRUM_CL
#include "lib/core/lanes.h"
#include "lib/pathtracer/numbers.cl"
#include "lib/shade/dispersion.cl"

#if HAS_DISPERSION
typedef struct SampledSpectrum {
  REAL of[WAVELENGTHS];
} SampledSpectrum;
#define EACH_WAVELENGTH(i) for (u32 i = 0; i < WAVELENGTHS; ++i)

// No function writes to a struct that it is given by value: some drivers (rusticl 22.3) hand over the
// caller's own.

// The wavelengths of paths: the hero's number in [0, 1), and the parts of red and blue that each has.
typedef struct SampledWavelengths {
  REAL hero;
  REAL red[WAVELENGTHS], blue[WAVELENGTHS];
  MASK alone;  // the hero is
} SampledWavelengths;

// tanh((wavelength - WAVELENGTH_MIDDLE) / WAVELENGTH_SCALE) of wavelength i; it is spread evenly.
static inline REAL wavelength_tanh(REAL hero, u32 i) {
  const REAL u = hero + (float)i / (float)WAVELENGTHS;
  return fma(u - floor(u), (REAL)(WAVELENGTH_HIGH - WAVELENGTH_LOW), (REAL)(WAVELENGTH_LOW));
}

// Where wavelength i lies among the rows of the table.
static inline REAL wavelength_row(REAL hero, u32 i) {
  const REAL t = wavelength_tanh(hero, i);
  const REAL row = fma(real_log((1.0f + t) / (1.0f - t)), (REAL)(0.5f * WAVELENGTH_SCALE / SPECTRUM_STEP),
                       (REAL)((WAVELENGTH_MIDDLE - SPECTRUM_FIRST) / SPECTRUM_STEP));
  return real_clamp(row, (REAL)(0.0f), (REAL)((float)(SPECTRUM_ROWS - 1u)));
}

static inline SampledWavelengths choose_wavelengths(const Scene* scene, const LaneSamples* at, MASK lanes) {
  SampledWavelengths chosen;
  chosen.hero = sample_lanes(at, (MASK)((int)(DIMENSION_TIME))).y;
  chosen.alone = NO_LANES;
  EACH_WAVELENGTH(i) {
    const REAL row = wavelength_row(chosen.hero, i);
    chosen.red[i] = spectrum_at(scene, SPECTRUM_OF_RED * SPECTRUM_ROWS, row, lanes);
    chosen.blue[i] = spectrum_at(scene, SPECTRUM_OF_BLUE * SPECTRUM_ROWS, row, lanes);
  }
  return chosen;
}

static inline void join_wavelengths(SampledWavelengths* mine, const SampledWavelengths* others, MASK lanes) {
  mine->hero = select(mine->hero, others->hero, lanes);
  mine->alone = select(mine->alone, others->alone, lanes);
  EACH_WAVELENGTH(i) {
    mine->red[i] = select(mine->red[i], others->red[i], lanes);
    mine->blue[i] = select(mine->blue[i], others->blue[i], lanes);
  }
}

static inline SampledSpectrum spectrum_all(float value) {
  SampledSpectrum all;
  EACH_WAVELENGTH(i) all.of[i] = (REAL)(value);
  return all;
}
static inline SampledSpectrum spectrum_select(SampledSpectrum a, SampledSpectrum b, MASK m) {
  SampledSpectrum made;
  EACH_WAVELENGTH(i) made.of[i] = select(a.of[i], b.of[i], m);
  return made;
}
static inline SampledSpectrum spectrum_add(SampledSpectrum a, SampledSpectrum b) {
  SampledSpectrum made;
  EACH_WAVELENGTH(i) made.of[i] = a.of[i] + b.of[i];
  return made;
}
static inline SampledSpectrum spectrum_multiply(SampledSpectrum a, SampledSpectrum b) {
  SampledSpectrum made;
  EACH_WAVELENGTH(i) made.of[i] = a.of[i] * b.of[i];
  return made;
}
static inline SampledSpectrum spectrum_scale(SampledSpectrum a, REAL s) {
  SampledSpectrum made;
  EACH_WAVELENGTH(i) made.of[i] = a.of[i] * s;
  return made;
}
static inline REAL spectrum_greatest(SampledSpectrum a) {
  return real_max(real_max(a.of[0], a.of[1]), real_max(a.of[2], a.of[3]));
}
// What the wavelengths are worth together.
static inline REAL spectrum_worth(SampledSpectrum a) {
  return (1.0f / (float)WAVELENGTHS) * ((a.of[0] + a.of[1]) + (a.of[2] + a.of[3]));
}
static inline REAL spectrum_mean(SampledSpectrum a) { return spectrum_worth(a); }

// The spectrum of a colour.
static inline SampledSpectrum spectrum_of(const SampledWavelengths* w, REAL3 color) {
  SampledSpectrum made;
  EACH_WAVELENGTH(i)
  made.of[i] = fma(w->red[i], color.x - color.y, fma(w->blue[i], color.z - color.y, color.y));
  return made;
}

// The spectrum of what absorption leaves: of the optical depth, so that two lengths of a medium leave what
// they leave one after the other.
static inline SampledSpectrum spectrum_kept(const SampledWavelengths* w, REAL3 kept) {
  if (!HAS_ABSORPTION) return spectrum_of(w, kept);
  const REAL least = (REAL)(1e-30f);
  const REAL3 depth = real3(real_log(real_max(kept.x, least)), real_log(real_max(kept.y, least)),
                            real_log(real_max(kept.z, least)));
  SampledSpectrum made = spectrum_of(w, depth);
  EACH_WAVELENGTH(i) made.of[i] = real_exp(made.of[i]);
  return made;
}

// The wavelengths of `lanes` part: the hero stands for all.
static inline void terminate_secondary(SampledWavelengths* w, SampledSpectrum* carried, MASK lanes) {
  const MASK parting = lanes & ~w->alone;
  carried->of[0] = select(carried->of[0], carried->of[0] * (float)WAVELENGTHS, parting);
  for (u32 i = 1; i < WAVELENGTHS; ++i) carried->of[i] = select(carried->of[i], (REAL)(0.0f), parting);
  w->alone |= lanes;
}

// What paths have gathered, as linear RGB.
NEVER_INLINE REAL3 spectrum_seen(const Scene* scene, const SampledWavelengths* w,
                                 const SampledSpectrum* light, MASK lanes) {
  REAL3 seen = all3((float3)(0.0f));
  EACH_WAVELENGTH(i) {
    const REAL t = wavelength_tanh(w->hero, i), row = wavelength_row(w->hero, i);
    // The density's inverse, and each wavelength is one of all.
    const REAL span =
        (WAVELENGTH_HIGH - WAVELENGTH_LOW) * WAVELENGTH_SCALE / (float)WAVELENGTHS / fma(-t, t, (REAL)(1.0f));
    const REAL3 weight = real3(spectrum_at(scene, SPECTRUM_RED * SPECTRUM_ROWS, row, lanes),
                               spectrum_at(scene, (SPECTRUM_RED + 1u) * SPECTRUM_ROWS, row, lanes),
                               spectrum_at(scene, (SPECTRUM_RED + 2u) * SPECTRUM_ROWS, row, lanes));
    seen = along3(seen, light->of[i] * span, weight);
  }
  return seen;
}

#else
typedef REAL3 SampledSpectrum;
typedef struct SampledWavelengths {
  MASK unused;
} SampledWavelengths;
static inline SampledWavelengths choose_wavelengths(const Scene* scene, const LaneSamples* at, MASK lanes) {
  const SampledWavelengths none = {NO_LANES};
  return none;
}
static inline void join_wavelengths(SampledWavelengths* mine, const SampledWavelengths* others, MASK lanes) {}
static inline SampledSpectrum spectrum_all(float value) { return all3((float3)(value)); }
static inline SampledSpectrum spectrum_select(SampledSpectrum a, SampledSpectrum b, MASK m) {
  return select3(a, b, m);
}
static inline SampledSpectrum spectrum_add(SampledSpectrum a, SampledSpectrum b) { return add3(a, b); }
static inline SampledSpectrum spectrum_multiply(SampledSpectrum a, SampledSpectrum b) {
  return multiply3(a, b);
}
static inline SampledSpectrum spectrum_scale(SampledSpectrum a, REAL s) { return scale3(a, s); }
static inline REAL spectrum_greatest(SampledSpectrum a) { return greatest3(a); }
static inline REAL spectrum_worth(SampledSpectrum a) { return greatest3(a); }
static inline REAL spectrum_mean(SampledSpectrum a) { return (a.x + a.y + a.z) * (1.0f / 3.0f); }
static inline SampledSpectrum spectrum_of(const SampledWavelengths* w, REAL3 color) { return color; }
static inline SampledSpectrum spectrum_kept(const SampledWavelengths* w, REAL3 kept) { return kept; }
static inline void terminate_secondary(SampledWavelengths* w, SampledSpectrum* carried, MASK lanes) {}
static inline REAL3 spectrum_seen(const Scene* scene, const SampledWavelengths* w,
                                  const SampledSpectrum* light, MASK lanes) {
  return *light;
}
#endif

#endif
