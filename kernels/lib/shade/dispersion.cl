// Wavelength-dependent refractive indices; a wavelength is a (fractional) row of the table `spectra`. One
// surface per lane.
#pragma once
#include "lib/path/media.cl"
#include "shared/spectra.h"

#if HAS_DISPERSION
// Interpolates a spectrum whose rows begin at `first`.
static inline REAL spectrum_at(const Scene* scene, u32 first, REAL row, MASK lanes) {
  const MASK low = min(TO_MASK(row), (MASK)((int)SPECTRUM_ROWS - 2));
  __global const float* from = scene->spectra + first;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + 1, low, lanes);
  return fma(row - TO_REAL(low), b - a, a);
}

static inline REAL index_at(const Scene* scene, MASK medium, REAL row, MASK lanes) {
  REAL index = (REAL)(1.0f);
  u32 at;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(medium, &left, &at);
    const u32 first = scene->media[at].spectrum;
    const REAL own =
        first == NO_SPECTRUM ? (REAL)(scene->media[at].absorption.w) : spectrum_at(scene, first, row, mine);
    index = select(index, own, mine);
  }
  return index;
}

// The interfaces of `lanes` whose relative index depends on the wavelength.
static inline MASK disperses(const Scene* scene, MASK before, MASK after, MASK lanes) {
  MASK found = NO_LANES;
  u32 at;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(before, &left, &at);
    if (scene->media[at].spectrum != NO_SPECTRUM) found |= mine;
  }
  for (u32 left = lane_bits(lanes & ~found); left;) {
    const MASK mine = take_alike(after, &left, &at);
    if (scene->media[at].spectrum != NO_SPECTRUM) found |= mine;
  }
  return found & MASK_OF(before != after);
}

// relative_index() at a row.
static inline REAL relative_index_at(const Scene* scene, MASK before, MASK after, REAL row, MASK lanes) {
  return index_at(scene, after, row, lanes) / index_at(scene, before, row, lanes);
}
#endif
