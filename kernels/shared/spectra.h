// Spectra as tables: the wavelengths that they are kept at, and the table `spectra` of a scene in which some
// medium disperses.
#ifndef SUNDOG_SHARED_SPECTRA_H
#define SUNDOG_SHARED_SPECTRA_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// Wavelengths in nm: 380, 385, ..., 780; between them spectra are linear.
#define SPECTRUM_FIRST 380.0f
#define SPECTRUM_LAST 780.0f
#define SPECTRUM_STEP 5.0f
#define SPECTRUM_ROWS 81u

// The table `spectra`: SPECTRUM_COLUMNS times SPECTRUM_ROWS floats, column by column, then SPECTRUM_ROWS
// indices of refraction for each medium that disperses (Medium.spectrum is where they begin).
#define SPECTRUM_RED 0u      // three: what white light of this wavelength adds to linear RGB, per nm
#define SPECTRUM_OF_RED 3u   // part of a red of 1 that it has
#define SPECTRUM_OF_BLUE 4u  // of a blue; of a green it has the rest to 1
#define SPECTRUM_COLUMNS 5u
#define NO_SPECTRUM 0u  // Medium.spectrum of a medium that does not disperse

// Wavelengths are chosen with a density in proportion to 1 / cosh((wavelength - WAVELENGTH_MIDDLE) /
// WAVELENGTH_SCALE)^2, which has about the shape of the eye's sensitivity.
#define WAVELENGTHS 4u  // of a path
#define WAVELENGTH_MIDDLE 545.0f
#define WAVELENGTH_SCALE 110.0f
#define WAVELENGTH_LOW (-0.905148253645f)  // tanh of that quotient, of the first wavelength and the last
#define WAVELENGTH_HIGH 0.972496100271f

SUNDOG_SHARED_END
#endif
