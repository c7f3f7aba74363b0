// What a path carries: red, green and blue in x, y and z, or in scenes where a medium disperses four
// wavelengths in x, y, z and w, of which the first, the hero, decides where the path goes (Wilkie and others
// 2014, "Hero Wavelength Spectral Sampling"). The others lie evenly between, by the density of
// shared/spectra.h, and go along until the wavelengths part: from there on the hero stands for them. Colours
// become spectra by three fixed ones that together are white (host/scene/spectra/upsample.h).
#include "plain/core.h"
#include "shared/spectra.h"

LANE_VECTOR(SampledSpectrum, SampledSpectrum, spectrum, 4);

// The hero's number in [0, 1), and the parts of red and blue that each wavelength has.
typedef struct SampledWavelengths {
  bool alone;  // the hero is
  HAVING(HAS_DISPERSION) float hero;
  HAVING(HAS_DISPERSION) SampledSpectrum red, blue;
} SampledWavelengths;

// tanh((wavelength - WAVELENGTH_MIDDLE) / WAVELENGTH_SCALE) of wavelength i; it is spread evenly.
static inline float wavelength_tanh(float hero, UNIFORM u32 i) {
  const float u = hero + (float)i / (float)WAVELENGTHS;
  return fma(u - floor(u), WAVELENGTH_HIGH - WAVELENGTH_LOW, WAVELENGTH_LOW);
}

// Where wavelength i lies among the rows of the table.
static inline float wavelength_row(float hero, UNIFORM u32 i) {
  const float t = wavelength_tanh(hero, i);
  const float row = fma(real_log((1.0f + t) / (1.0f - t)), 0.5f * WAVELENGTH_SCALE / SPECTRUM_STEP,
                        (WAVELENGTH_MIDDLE - SPECTRUM_FIRST) / SPECTRUM_STEP);
  return real_clamp(row, 0.0f, (float)(SPECTRUM_ROWS - 1u));
}

// A column of the table at the wavelengths.
HAVING(HAS_DISPERSION)
static inline SampledSpectrum spectrum_along(UNIFORM const Scene* scene, UNIFORM u32 column, float hero) {
  SampledSpectrum made;
  made.x = spectrum_at(scene, column * SPECTRUM_ROWS, wavelength_row(hero, 0u));
  made.y = spectrum_at(scene, column * SPECTRUM_ROWS, wavelength_row(hero, 1u));
  made.z = spectrum_at(scene, column * SPECTRUM_ROWS, wavelength_row(hero, 2u));
  made.w = spectrum_at(scene, column * SPECTRUM_ROWS, wavelength_row(hero, 3u));
  return made;
}

static inline SampledWavelengths choose_wavelengths(UNIFORM const Scene* scene, const SampleAt* at) {
  SampledWavelengths w;
  w.alone = false;
  if (HAS_DISPERSION) {
    w.hero = numbers_at(at, (int)DIMENSION_TIME, true, true).y;
    w.red = spectrum_along(scene, SPECTRUM_OF_RED, w.hero);
    w.blue = spectrum_along(scene, SPECTRUM_OF_BLUE, w.hero);
  }
  return w;
}

static inline float spectrum_greatest(SampledSpectrum a) {
  if (HAS_DISPERSION) return real_max(real_max(a.x, a.y), real_max(a.z, a.w));
  return real_max(a.x, real_max(a.y, a.z));
}
// Its worth for the choice of paths.
static inline float spectrum_worth(SampledSpectrum a) {
  if (HAS_DISPERSION) return (1.0f / (float)WAVELENGTHS) * ((a.x + a.y) + (a.z + a.w));
  return real_max(a.x, real_max(a.y, a.z));
}
static inline float spectrum_mean(SampledSpectrum a) {
  if (HAS_DISPERSION) return spectrum_worth(a);
  return (a.x + a.y + a.z) * (1.0f / 3.0f);
}

// A wavelength's part of a colour, by its parts of red and blue.
static inline float part_of_color(float red, float blue, float3 color) {
  return fma(red, color.x - color.y, fma(blue, color.z - color.y, color.y));
}
// The spectrum of a colour.
static inline SampledSpectrum spectrum_of(const SampledWavelengths* w, float3 color) {
  SampledSpectrum made;
  if (HAS_DISPERSION) {
    made.x = part_of_color(w->red.x, w->blue.x, color);
    made.y = part_of_color(w->red.y, w->blue.y, color);
    made.z = part_of_color(w->red.z, w->blue.z, color);
    made.w = part_of_color(w->red.w, w->blue.w, color);
  } else {
    made.x = color.x;
    made.y = color.y;
    made.z = color.z;
  }
  return made;
}

// The spectrum of what absorption leaves: of the optical depth, so that two lengths of a medium leave what
// they leave one after the other.
static inline SampledSpectrum spectrum_kept(const SampledWavelengths* w, float3 kept) {
  SampledSpectrum made = spectrum_of(w, kept);
  if (HAS_DISPERSION && HAS_ABSORPTION) {
    const float3 depth = (float3)(real_log(real_max(kept.x, 1e-30f)), real_log(real_max(kept.y, 1e-30f)),
                                  real_log(real_max(kept.z, 1e-30f)));
    made = spectrum_of(w, depth);
    made.x = real_exp(made.x);
    made.y = real_exp(made.y);
    made.z = real_exp(made.z);
    made.w = real_exp(made.w);
  }
  return made;
}

// The wavelengths part: the hero stands for all.
static inline void terminate_secondary(SampledWavelengths* w, SampledSpectrum* carried) {
  if (HAS_DISPERSION && !w->alone) {
    (*carried).x *= (float)WAVELENGTHS;
    (*carried).y = 0.0f;
    (*carried).z = 0.0f;
    (*carried).w = 0.0f;
    w->alone = true;
  }
}

// `seen` with the light of wavelength i.
HAVING(HAS_DISPERSION)
static inline float3 with_wavelength(UNIFORM const Scene* scene, float hero, UNIFORM u32 i, float light,
                                     float3 seen) {
  const float t = wavelength_tanh(hero, i), row = wavelength_row(hero, i);
  // The density's inverse, and each wavelength is one of all.
  const float span =
      (WAVELENGTH_HIGH - WAVELENGTH_LOW) * WAVELENGTH_SCALE / (float)WAVELENGTHS / fma(-t, t, 1.0f);
  const float3 weight = (float3)(spectrum_at(scene, SPECTRUM_RED * SPECTRUM_ROWS, row),
                                 spectrum_at(scene, (SPECTRUM_RED + 1u) * SPECTRUM_ROWS, row),
                                 spectrum_at(scene, (SPECTRUM_RED + 2u) * SPECTRUM_ROWS, row));
  return along(seen, light * span, weight);
}

// A path's radiance as linear RGB.
ENTRY static float3 spectrum_seen(UNIFORM const Scene* scene, const SampledWavelengths* w,
                                  const SampledSpectrum* light) {
  float3 seen = (float3)(0.0f);
  if (HAS_DISPERSION) {
    seen = with_wavelength(scene, w->hero, 0u, (*light).x, seen);
    seen = with_wavelength(scene, w->hero, 1u, (*light).y, seen);
    seen = with_wavelength(scene, w->hero, 2u, (*light).z, seen);
    seen = with_wavelength(scene, w->hero, 3u, (*light).w, seen);
  } else {
    seen = (float3)((*light).x, (*light).y, (*light).z);
  }
  return seen;
}
