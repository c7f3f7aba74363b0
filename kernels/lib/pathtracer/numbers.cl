// Random numbers of paths and photons, four dimensions at a time: one function that is called, because
// compilers would repeat it in each place.
#pragma once
#include "lib/core/sampler_lanes.cl"

// chosen_lanes().
NEVER_INLINE FourNumbers wanted_lanes(const LaneSamples* at, MASK dimension, bool first, bool later) {
  return chosen_lanes(at, dimension, first, later);
}
static inline FourNumbers sample_lanes(const LaneSamples* at, MASK dimension) {
  return wanted_lanes(at, dimension, true, true);
}
