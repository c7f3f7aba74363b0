// Bsdfs in lanes: those of plain/shade, and the hand-written functions that they call.
#pragma once
#include "lib/path/segment.cl"
#include "lib/shade/texels.cl"
#include "shared/lobe_energy.h"
#include "shared/metal_rough.h"
#if HAS_CONES
#include "generated/patterns.cl"
#endif

typedef struct ValueStack {
  REAL4 value[TEXTURE_STACK > 1 ? TEXTURE_STACK : 1];
} ValueStack;
typedef struct SlotValues {
  REAL4 of[MAP_COUNT];
} SlotValues;
#include "plain/shade/bsdf.cl"
#include "plain/shade/relief.cl"
#include "plain/shade/relief_hits.cl"
