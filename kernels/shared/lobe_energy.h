// Where parts of the table lobe_energy (host/compile/lobe_energy.h) begin that are by index of refraction
// alone, and its axes: rows by the root of the distribution's width alpha, columns by LOBE_COLUMN. What
// narrow lobes lose depends on the cosine over alpha, so rows of small alpha have their columns at small
// cosines.
#ifndef SUNDOG_SHARED_LOBE_ENERGY_H
#define SUNDOG_SHARED_LOBE_ENERGY_H
#include "shared/scene.h"

// The part of light that goes through interfaces after further reflections: by 1 - 1 / eta and alpha.
#define GLASS_THROUGH (LOBE_GLASS + GLASS_INDICES * 2u * GLASS_STEPS * GLASS_STEPS)
// The means over directions of what single reflections lose, over alpha^2: by 1 - 1 / eta, side and alpha.
#define GLASS_LOST (GLASS_THROUGH + GLASS_INDICES * GLASS_STEPS)

// Narrower lobes have the columns of this width.
#define LEAST_LOBE_ALPHA 1e-4f
// The place in 0 .. 1 of the cosine c to the normal among the columns of a row, and back.
#define LOBE_COLUMN(c, alpha) ((c) * (1.0f + (alpha)) / ((c) + (alpha)))
#define LOBE_COSINE(t, alpha) ((alpha) * (t) / (1.0f + (alpha) - (t)))

#endif
