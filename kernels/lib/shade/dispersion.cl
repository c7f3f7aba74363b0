// Spectra; a wavelength is a (fractional) row of the table `spectra`.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"
#include "shared/spectra.h"

#if HAS_DISPERSION
// Interpolates a spectrum whose rows begin at `first`.
static inline REAL spectrum_at(const Scene* scene, u32 first, REAL row, MASK lanes) {
  const MASK low = min(TO_MASK(row), (MASK)((int)SPECTRUM_ROWS - 2));
  __global const float* from = scene->spectra + first;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + 1, low, lanes);
  return fma(row - TO_REAL(low), b - a, a);
}
#endif
