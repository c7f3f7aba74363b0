// Tabulated spectra: their wavelengths, and the table `spectra` of a scene with a dispersive medium.
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// Wavelengths in nm: 380, 385, ..., 780; spectra are linear in between.
#define SPECTRUM_FIRST 380.0f
#define SPECTRUM_LAST 780.0f
#define SPECTRUM_STEP 5.0f
#define SPECTRUM_ROWS 81u

// The table `spectra`: SPECTRUM_COLUMNS times SPECTRUM_ROWS floats, column by column, then SPECTRUM_ROWS
// refractive indices for each dispersive medium (Medium.spectrum is their offset).
#define SPECTRUM_RED 0u     // three columns: linear RGB contributed by white light of this wavelength, per nm
#define SPECTRUM_OF_RED 3u  // spectrum of the colour red 1
#define SPECTRUM_OF_BLUE 4u  // spectrum of blue 1; green has the rest to 1
#define SPECTRUM_COLUMNS 5u
#define NO_SPECTRUM 0u  // Medium.spectrum of a medium without dispersion

// Wavelengths are sampled with a density proportional to 1 / cosh((wavelength - WAVELENGTH_MIDDLE) /
// WAVELENGTH_SCALE)^2, which resembles the eye's sensitivity.
#define WAVELENGTHS 4u  // per path
#define WAVELENGTH_MIDDLE 545.0f
#define WAVELENGTH_SCALE 110.0f
#define WAVELENGTH_LOW (-0.905148253645f)  // tanh of that quotient, for the first and last wavelength
#define WAVELENGTH_HIGH 0.972496100271f

SUNDOG_SHARED_END
