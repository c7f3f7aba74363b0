// Hand-written code that the plain path tracer calls (plain/pathtracer/interface.h).
#pragma once
#include "lib/core/sampler_lanes.cl"
#include "lib/path/environment_cells.cl"
#include "lib/path/ray_counts.cl"
#include "lib/pathtracer/photon_search.cl"
#include "lib/shade/bsdf.cl"

// chosen_lanes(), which compilers would repeat in each place.
NEVER_INLINE FourNumbers wanted_lanes(const LaneSamples* at, MASK dimension, bool first, bool later) {
  return chosen_lanes(at, dimension, first, later);
}

// The vector that plain/pathtracer/spectrum.cl calls SampledSpectrum.
#if HAS_DISPERSION
typedef REAL4 SampledSpectrum;
#define OF_SPECTRUM(function) function##4
#else
typedef REAL3 SampledSpectrum;
#define OF_SPECTRUM(function) function##3
#endif
#define spectrum_all(value) OF_SPECTRUM(all)((OF_SPECTRUM(float))(value))
#define spectrum_select OF_SPECTRUM(select)
#define spectrum_add OF_SPECTRUM(add)
#define spectrum_subtract OF_SPECTRUM(subtract)
#define spectrum_multiply OF_SPECTRUM(multiply)
#define spectrum_scale OF_SPECTRUM(scale)
