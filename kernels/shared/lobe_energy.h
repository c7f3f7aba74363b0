// Where parts of the table lobe_energy begin that are by index of refraction alone
// (host/compile/lobe_energy.h).
#ifndef SUNDOG_SHARED_LOBE_ENERGY_H
#define SUNDOG_SHARED_LOBE_ENERGY_H
#include "shared/scene.h"

// The part of light that goes through interfaces after further reflections: by 1 - 1 / eta and alpha.
#define GLASS_THROUGH (LOBE_GLASS + GLASS_INDICES * 2u * GLASS_STEPS * GLASS_STEPS)
// The means over directions of what single reflections lose: by 1 - 1 / eta, side and alpha.
#define GLASS_LOST (GLASS_THROUGH + GLASS_INDICES * GLASS_STEPS)

#endif
