// Scattering at surfaces: the Bsdfs of plain/shade, and what they use.
#pragma once
#include "lib/core/directions.cl"
#include "lib/core/optics.cl"
#include "lib/path/media.cl"
#include "lib/shade/dispersion.cl"
#include "lib/shade/interaction.cl"
#include "lib/shade/lobe_energy.cl"
#include "lib/shade/maps.cl"
#include "plain/shade/bsdf.cl"

// The surfaces of `lanes` whose materials have any of the flags.
static inline MASK of_kind(const Bsdfs* bsdf, u32 flags, MASK lanes) {
  return lanes & MASK_OF((bsdf->flags & (int)flags) != 0);
}
