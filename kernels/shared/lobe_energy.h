// Layout of the table lobe_energy (host/compile/surfaces/lobe_energy.h): offsets of the parts that depend on
// the index of refraction, and its axes: rows by the square root of the width alpha, columns by LOBE_COLUMN.
// Losses of narrow lobes depend on the cosine over alpha, so rows of small alpha concentrate columns at small
// cosines.
#pragma once
#include "shared/scene.h"

// Fraction of light that passes interfaces after multiple reflections: by 1 - 1 / eta and alpha.
#define GLASS_THROUGH (LOBE_GLASS + GLASS_INDICES * 2u * GLASS_STEPS * GLASS_STEPS)
// Mean loss of single reflections over directions, divided by alpha^2: by 1 - 1 / eta, side and alpha.
#define GLASS_LOST (GLASS_THROUGH + GLASS_INDICES * GLASS_STEPS)

// Narrower lobes use the columns of this width.
#define LEAST_LOBE_ALPHA 1e-4f
// The column position in 0 .. 1 of the cosine c to the normal, and the inverse.
#define LOBE_COLUMN(c, alpha) ((c) * (1.0f + (alpha)) / ((c) + (alpha)))
#define LOBE_COSINE(t, alpha) ((alpha) * (t) / (1.0f + (alpha) - (t)))
