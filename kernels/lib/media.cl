// The stack of media that travels with a ray. Where solids overlap, the medium of the highest priority is the
// one light is in; of equal priorities the one entered last (Schmidt and Budge 2002, "Simple Nested
// Dielectrics in Ray Traced Images").
#ifndef SUNDOG_LIB_MEDIA_CL
#define SUNDOG_LIB_MEDIA_CL
#include "lib/config.h"
#include "lib/tables.h"

typedef struct MediaStack {
  u32 count;
  u32 medium[MEDIA_STACK];  // in the order of entry
} MediaStack;

// Index of the medium that light is in; 0 is the world's.
static inline u32 current_medium(__global const Medium* restrict media, const MediaStack* stack) {
  u32 best = 0;
  for (u32 i = 0; i < stack->count; ++i)
    if (i == 0u || media[stack->medium[i]].priority >= media[best].priority) best = stack->medium[i];
  return best;
}

// Enters or leaves `medium`. Returns false when that cannot be: the stack is full, or the medium was never
// entered.
static inline bool cross_boundary(MediaStack* stack, u32 medium, bool entering) {
  if (entering) {
    if (stack->count == MEDIA_STACK) return false;
    stack->medium[stack->count++] = medium;
    return true;
  }
  for (u32 i = stack->count; i-- > 0u;) {
    if (stack->medium[i] != medium) continue;
    stack->count -= 1u;
    for (u32 j = i; j < stack->count; ++j) stack->medium[j] = stack->medium[j + 1u];
    return true;
  }
  return false;
}

// Beer-Lambert: what is left of light after `distance` in the medium.
static inline float3 absorb(__global const Medium* restrict media, u32 medium, float distance) {
  const float3 a = media[medium].absorption.xyz;
  // A colour that is not absorbed keeps its bits, over infinite distances too.
  return (float3)(a.x == 0.0f ? 1.0f : exp(-a.x * distance), a.y == 0.0f ? 1.0f : exp(-a.y * distance),
                  a.z == 0.0f ? 1.0f : exp(-a.z * distance));
}

#endif
