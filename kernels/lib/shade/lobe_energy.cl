// Light that facets lose, in tables of host/compile/surfaces/lobe_energy.h. One surface per lane.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"
#include "shared/lobe_energy.h"

#if HAS_ROUGH || HAS_LAYERS
// Position in the tables of the width alpha and the cosine c, both from 0 to 1.
static inline float2 lobe_place(float c, float alpha) {
  const float a = clamp(alpha, LEAST_LOBE_ALPHA, 1.0f), x = clamp(c, 0.0f, 1.0f);
  return (float2)(LOBE_COLUMN(x, a), sqrt(a));
}

// Looks up one of these tables by alpha and the cosine c; `first` is its first value's index. 1 outside
// `lanes`.
static inline REAL lobe_energy_at(const Scene* scene, u32 first, REAL c, REAL alpha, MASK lanes) {
  REAL energy = (REAL)(1.0f);
  EACH_LANE(i, lanes) {
    const float2 place = lobe_place(REAL_LANE(c, i), REAL_LANE(alpha, i)) * (LOBE_STEPS - 1u);
    const float x = place.x, y = place.y;
    const u32 x0 = min((u32)x, LOBE_STEPS - 2u), y0 = min((u32)y, LOBE_STEPS - 2u);
    __global const float* at = scene->lobe_energy + first + y0 * LOBE_STEPS + x0;
    const float low = mix(at[0], at[1], x - (float)x0),
                high = mix(at[LOBE_STEPS], at[LOBE_STEPS + 1u], x - (float)x0);
    REAL_LANE(energy, i) = mix(low, high, y - (float)y0);
  }
  return energy;
}
#endif

// The values of rough glass by eta, the index behind over before; 1 outside `lanes`.
#if HAS_ROUGH_GLASS
static inline float glass_cell(__global const float* at, float x, float y) {
  const float low = mix(at[0], at[1], x), high = mix(at[GLASS_STEPS], at[GLASS_STEPS + 1u], x);
  return mix(low, high, y);
}
static inline REAL glass_value(const Scene* scene, REAL eta, REAL c, REAL alpha, MASK lanes) {
  REAL value = (REAL)(1.0f);
  EACH_LANE(i, lanes) {
    const float e = REAL_LANE(eta, i), less = 1.0f - fmin(e, 1.0f / e);
    const float z = sqrt(clamp(less / GLASS_REACH, 0.0f, 1.0f)) * (GLASS_INDICES - 1u);
    const float2 place = lobe_place(REAL_LANE(c, i), REAL_LANE(alpha, i)) * (GLASS_STEPS - 1u);
    const float x = place.x, y = place.y;
    const u32 x0 = min((u32)x, GLASS_STEPS - 2u), y0 = min((u32)y, GLASS_STEPS - 2u),
              z0 = min((u32)z, GLASS_INDICES - 2u), side = e > 1.0f ? 0u : 1u;
    __global const float* at =
        scene->lobe_energy + LOBE_GLASS + ((z0 * 2u + side) * GLASS_STEPS + y0) * GLASS_STEPS + x0;
    const float near = glass_cell(at, x - (float)x0, y - (float)y0),
                far = glass_cell(at + 2u * GLASS_STEPS * GLASS_STEPS, x - (float)x0, y - (float)y0);
    REAL_LANE(value, i) = mix(near, far, z - (float)z0);
  }
  return value;
}
// Looks up one of the tables by index and alpha that follow; `rows` per index.
static inline REAL glass_row(const Scene* scene, u32 first, u32 rows, REAL thick, REAL alpha, MASK lanes) {
  REAL value = (REAL)(1.0f);
  EACH_LANE(i, lanes) {
    const float less = 1.0f - 1.0f / REAL_LANE(thick, i);
    const float z = sqrt(clamp(less / GLASS_REACH, 0.0f, 1.0f)) * (GLASS_INDICES - 1u);
    const float y = lobe_place(1.0f, REAL_LANE(alpha, i)).y * (GLASS_STEPS - 1u);
    const u32 y0 = min((u32)y, GLASS_STEPS - 2u), z0 = min((u32)z, GLASS_INDICES - 2u);
    __global const float* at = scene->lobe_energy + first + z0 * rows * GLASS_STEPS + y0;
    __global const float* far = at + rows * GLASS_STEPS;
    REAL_LANE(value, i) =
        mix(mix(at[0], at[1], y - (float)y0), mix(far[0], far[1], y - (float)y0), z - (float)z0);
  }
  return value;
}
#endif
