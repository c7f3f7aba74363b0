// The vector that plain/pathtracer/spectrum.cl calls SampledSpectrum.
#pragma once
#include "lib/core/lanes.h"
#include "lib/pathtracer/numbers.cl"
#include "lib/shade/dispersion.cl"

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
