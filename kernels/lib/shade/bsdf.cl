// Bsdfs in lanes: those of plain/shade, and the hand-written functions that they call.
#pragma once
#include "lib/path/segment.cl"
#include "lib/shade/texels.cl"
#include "shared/lobe_energy.h"
#if HAS_CONES
#include "generated/patterns.cl"
#endif

typedef struct ValueStack {
  REAL4 value[TEXTURE_STACK > 1 ? TEXTURE_STACK : 1];
} ValueStack;
// Slots that the scene has not take no room. Normals and heights are read alone.
#define KEPT_SLOTS (MAP_SLOTS_USED & ~(1u << MAP_NORMAL | 1u << MAP_HEIGHT))
#define COUNT_SLOT(constant, name) +(KEPT_SLOTS >> MAP_##constant & 1u)
typedef struct SlotValues {
  REAL4 of[1 MAP_SLOTS(COUNT_SLOT)];
} SlotValues;
static inline u32 place_of_slot(u32 slot) { return popcount(KEPT_SLOTS & ((1u << slot) - 1u)); }
#include "plain/shade/bsdf.cl"
#include "plain/shade/meet_interfaces.cl"
#include "plain/shade/relief.cl"
