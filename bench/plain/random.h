// Random numbers by hash, equal to the kernels' (kernels/lib/core/sampler.cl).
#pragma once
#include "shared/types.h"

namespace sundog {

/// PCG's output function on a linear congruential step (O'Neill 2014): a random 32-bit word from x.
inline u32 random_word(u32 x) {
  const u32 state = x * 747796405u + 2891336453u;
  const u32 word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

/// A float in [0, 1) from the upper 24 bits.
inline float unit_float(u32 bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace sundog
