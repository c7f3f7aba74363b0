// Light that facets lose, in tables of host/compile/surfaces/lobe_energy.h.
#include "plain/shade/interface.h"

// The square root of the width alpha, its place in the tables; the place of the cosine c there.
static inline float width_place(float alpha) { return sqrt(clamp(alpha, LEAST_LOBE_ALPHA, 1.0f)); }
static inline float cosine_place(float c, float alpha) {
  const float a = clamp(alpha, LEAST_LOBE_ALPHA, 1.0f), x = clamp(c, 0.0f, 1.0f);
  return LOBE_COLUMN(x, a);
}

// The value at (x, y) of rows of `steps` values that begin at `first`.
static inline float table_value(UNIFORM const Scene* scene, u32 first, UNIFORM u32 steps, float x, float y) {
  const u32 x0 = min((u32)x, steps - 2u), y0 = min((u32)y, steps - 2u), at = first + y0 * steps + x0;
  __global const float* table = scene->lobe_energy;
  const float low = mix(table[at], table[at + 1u], x - (float)x0);
  return mix(low, mix(table[at + steps], table[at + steps + 1u], x - (float)x0), y - (float)y0);
}

// Looks up one of these tables by alpha and the cosine c; `first` is its first value's index.
static inline float lobe_energy_at(UNIFORM const Scene* scene, UNIFORM u32 first, float c, float alpha) {
  const float last = (float)(LOBE_STEPS - 1u);
  return table_value(scene, first, LOBE_STEPS, cosine_place(c, alpha) * last, width_place(alpha) * last);
}

// The place of an index of refraction, of which 1 - `less` is the smaller over the greater.
static inline float index_place(float less) {
  return sqrt(clamp(less / GLASS_REACH, 0.0f, 1.0f)) * (float)(GLASS_INDICES - 1u);
}

// The value of rough glass by eta, the index behind over before.
static inline float glass_value(UNIFORM const Scene* scene, float eta, float c, float alpha) {
  const float last = (float)(GLASS_STEPS - 1u), z = index_place(1.0f - fmin(eta, 1.0f / eta));
  const float x = cosine_place(c, alpha) * last, y = width_place(alpha) * last;
  const u32 z0 = min((u32)z, GLASS_INDICES - 2u), side = eta > 1.0f ? 0u : 1u,
            page = GLASS_STEPS * GLASS_STEPS;
  const u32 at = LOBE_GLASS + (z0 * 2u + side) * page;
  return mix(table_value(scene, at, GLASS_STEPS, x, y), table_value(scene, at + 2u * page, GLASS_STEPS, x, y),
             z - (float)z0);
}

// Looks up one of the tables by index and alpha that follow; `rows` per index.
static inline float glass_row(UNIFORM const Scene* scene, UNIFORM u32 first, UNIFORM u32 rows, float thick,
                              float alpha) {
  const float z = index_place(1.0f - 1.0f / thick), y = width_place(alpha) * (float)(GLASS_STEPS - 1u);
  const u32 y0 = min((u32)y, GLASS_STEPS - 2u), z0 = min((u32)z, GLASS_INDICES - 2u);
  const u32 at = first + z0 * rows * GLASS_STEPS + y0, far = at + rows * GLASS_STEPS;
  __global const float* table = scene->lobe_energy;
  return mix(mix(table[at], table[at + 1u], y - (float)y0), mix(table[far], table[far + 1u], y - (float)y0),
             z - (float)z0);
}
