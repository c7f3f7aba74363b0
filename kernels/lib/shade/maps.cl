// Textures of materials in lanes (plain/shade/maps.cl).
#pragma once
#include "lib/shade/interaction.cl"
#include "lib/shade/texels.cl"
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
#include "plain/shade/maps.cl"
