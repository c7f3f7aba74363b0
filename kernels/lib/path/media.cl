// The stack of media that travels with a ray. Where solids overlap, the medium of highest priority applies;
// among equal priorities, the last entered (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced
// Images").
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"

// Up to eight media in order of entry, the last in the lowest byte; a byte holds the medium's index plus one,
// 0 is empty. A single register, to keep waiting rays small. The host rejects scenes with more than MAX_MEDIA
// media.
typedef ulong MediaStack;

// Index of the effective medium; 0 is the world's.
static inline u32 current_medium(__global const Medium* restrict media, MediaStack stack) {
  if (!stack) return 0u;
  u32 best = (u32)(stack & 0xFFu) - 1u;
#pragma unroll 1
  for (stack >>= 8; stack; stack >>= 8) {
    const u32 medium = (u32)(stack & 0xFFu) - 1u;
    if (media[medium].priority > media[best].priority) best = medium;
  }
  return best;
}

// Enters or leaves `medium`. Returns false if the stack is full or the medium was never entered.
static inline bool cross_boundary(MediaStack* stack, u32 medium, bool entering) {
  const MediaStack entry = medium + 1u;
  if (entering) {
    if (*stack >> 56) return false;
    *stack = *stack << 8 | entry;
    return true;
  }
#pragma unroll 1
  for (u32 shift = 0; shift < 64u; shift += 8u) {
    if ((*stack >> shift & 0xFFu) != entry) continue;
    const MediaStack newer = *stack & ((1ul << shift) - 1ul), older = *stack >> shift >> 8;
    *stack = older << shift | newer;
    return true;
  }
  return false;
}

// Whether an interface between these media refracts at no wavelength.
static inline bool same_index(__global const Medium* a, __global const Medium* b) {
  if (HAS_DISPERSION && a->spectrum != b->spectrum) return false;
  return a->absorption.w == b->absorption.w;
}
