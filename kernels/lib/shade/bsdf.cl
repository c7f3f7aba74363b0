// Bsdfs in lanes: those of plain/shade, and the hand-written functions that they call.
#pragma once
#include "lib/core/directions.cl"
#include "lib/core/optics.cl"
#include "lib/path/media.cl"
#include "lib/shade/dispersion.cl"
#include "lib/shade/interaction.cl"
#include "lib/shade/maps.cl"
#include "plain/shade/bsdf.cl"
#include "shared/lobe_energy.h"

// Surfaces that rays have met, and what they do to light.
typedef struct Shading {
  SurfaceInteractions s;
  Bsdfs bsdf;
} Shading;

// The surfaces of `lanes` whose materials have any of the flags.
static inline MASK of_kind(const Bsdfs* bsdf, u32 flags, MASK lanes) {
  return lanes & MASK_OF((bsdf->flags & (int)flags) != 0);
}
