// The base of layered materials at one place: what a material has of it as numbers, or where a texture gives
// its roughness or metalness, what the grid of shared/layers.h has between its steps. A surface a lane; the
// lanes of a call have one material.
#ifndef SUNDOG_LIB_LAYER_BASE_CL
#define SUNDOG_LIB_LAYER_BASE_CL
#include "lib/shade/layer_lobes.cl"

#if HAS_LAYERS
typedef struct LayerBase {
  REAL metal;                    // metalness
  REAL glass, alpha_x, alpha_y;  // these and the others are as in Layers
  REAL straight, inner, shine_scale, matte_scale, matte_scale_bare;
#if HAS_LAYER_MAPS
  MASK step;  // of the grid, and the part of the way to the next
  REAL part;
#endif
} LayerBase;

// A row of a material's table at the cosine c, for `lanes`.
static inline REAL layer_row(const Scene* scene, __global const Layers* layers, u32 row, REAL c, MASK lanes) {
  const REAL x = real_clamp(c, (REAL)(0.0f), (REAL)(1.0f)) * (float)(LAYER_STEPS - 1u);
  const MASK low = min(TO_MASK(x), (MASK)((int)LAYER_STEPS - 2));
  __global const float* from = scene->layer_rows + layers->first + row * LAYER_STEPS;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + 1, low, lanes);
  return fma(x - TO_REAL(low), b - a, a);
}
static inline REAL3 layer_row3(const Scene* scene, __global const Layers* layers, u32 row, REAL c,
                               MASK lanes) {
  return real3(layer_row(scene, layers, row, c, lanes), layer_row(scene, layers, row + 1u, c, lanes),
               layer_row(scene, layers, row + 2u, c, lanes));
}

// The place of a direction among the LAYER_TURNS rows by its turn about the normal.
static inline REAL turn_place(REAL3 w) {
  const REAL along = w.x * w.x, flat = real_max(fma(w.y, w.y, along), (REAL)(1e-12f));
  return along / flat * (float)(LAYER_TURNS - 1u);
}

// The gain of facets of two widths for a direction, of the rows from `first` on.
static inline REAL turned_gain(const Scene* scene, u32 first, REAL3 w, MASK lanes) {
  const REAL y = turn_place(w);
  const REAL x = real_clamp(w.z, (REAL)(0.0f), (REAL)(1.0f)) * (float)(LAYER_STEPS - 1u);
  const MASK row = min(TO_MASK(y), (MASK)((int)LAYER_TURNS - 2)),
             at = min(TO_MASK(x), (MASK)((int)LAYER_STEPS - 2));
  const MASK low = row * (int)LAYER_STEPS + at;
  __global const float* from = scene->layer_rows + first;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + 1, low, lanes);
  const REAL c = gather_floats(from + LAYER_STEPS, low, lanes),
             d = gather_floats(from + LAYER_STEPS + 1u, low, lanes);
  const REAL part = x - TO_REAL(at), near = fma(part, b - a, a), far = fma(part, d - c, c);
  return fma(y - TO_REAL(row), far - near, near);
}
static inline REAL plain_shine_gain(const Scene* scene, __global const Layers* layers, REAL3 w, MASK lanes) {
  if (layers->alpha_x == layers->alpha_y) return layer_row(scene, layers, LAYER_GAINS, w.z, lanes);
  return turned_gain(scene, layers->first + LAYER_GAINS * LAYER_STEPS, w, lanes);
}
static inline REAL coat_gain(const Scene* scene, __global const Layers* m, REAL3 w, MASK lanes) {
  if (m->coat_gains == NO_LAYER_GAINS)
    return lobe_energy_at(scene, LOBE_GAINS, w.z, (REAL)(m->coat_alpha), lanes);
  return turned_gain(scene, m->coat_gains, w, lanes);
}

#if HAS_LAYER_MAPS
// Facets are as wide across as along: their gains are one row.
static inline bool round_facets(__global const Layers* m) { return m->narrowed == 1.0f; }

static inline REAL grid_number(const Scene* scene, __global const Layers* m, const LayerBase* base, u32 which,
                               MASK lanes) {
  __global const float* from = scene->layer_rows + m->grid + which;
  const MASK low = base->step * (int)LAYER_GRID_NUMBERS;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + LAYER_GRID_NUMBERS, low, lanes);
  return fma(base->part, b - a, a);
}
// A row of each step at the cosine c: number 0 is LAYER_SHINE, those from 1 on are gains.
static inline REAL grid_row(const Scene* scene, __global const Layers* m, const LayerBase* base, MASK row,
                            REAL c, MASK lanes) {
  const u32 size = LAYER_STEPS * (round_facets(m) ? 2u : 1u + LAYER_TURNS);
  const REAL x = real_clamp(c, (REAL)(0.0f), (REAL)(1.0f)) * (float)(LAYER_STEPS - 1u);
  const MASK at = min(TO_MASK(x), (MASK)((int)LAYER_STEPS - 2));
  const MASK low = base->step * (int)size + row * (int)LAYER_STEPS + at;
  __global const float* from = scene->layer_rows + m->grid + LAYER_GRID_NUMBERS * LAYER_GRID_STEPS;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + 1, low, lanes);
  const REAL c0 = gather_floats(from + size, low, lanes), d = gather_floats(from + size + 1u, low, lanes);
  const REAL along = x - TO_REAL(at), near = fma(along, b - a, a), far = fma(along, d - c0, c0);
  return fma(base->part, far - near, near);
}
static inline REAL grid_gain(const Scene* scene, __global const Layers* m, const LayerBase* base, REAL3 w,
                             MASK lanes) {
  if (round_facets(m)) return grid_row(scene, m, base, (MASK)(1), w.z, lanes);
  const REAL y = turn_place(w);
  const MASK row = min(TO_MASK(y), (MASK)((int)LAYER_TURNS - 2));
  const REAL near = grid_row(scene, m, base, row + 1, w.z, lanes),
             far = grid_row(scene, m, base, row + 2, w.z, lanes);
  return fma(y - TO_REAL(row), far - near, near);
}

// The base's facets as wide as `roughness` makes them, seen through the coat's.
static inline void widen_base(__global const Layers* m, REAL roughness, LayerBase* base) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f), square = roughness * roughness;
  const REAL both = real_sqrt(real_sqrt(real_min(one, fma(square, square, (REAL)(m->haze)))));
  const REAL root = real_clamp(fma((REAL)(m->coat.w), both - roughness, roughness), zero, one);
  const REAL along = real_min(root * root * m->stretch, one);
  base->alpha_x = real_max(along, (REAL)(LEAST_LAYER_ALPHA));
  base->alpha_y = real_max(along * m->narrowed, (REAL)(LEAST_LAYER_ALPHA));
  const REAL y = root * (float)(LAYER_GRID_STEPS - 1u);
  base->step = min(TO_MASK(y), (MASK)((int)LAYER_GRID_STEPS - 2));
  const REAL part = LAYER_GRID_PART(y, TO_REAL(base->step));
  base->part = select(part, part * part, MASK_OF(base->step == 0));
}
static inline void map_base(const Scene* scene, __global const Layers* m, REAL metalness, REAL roughness,
                            MASK lanes, LayerBase* base) {
  base->metal = metalness;
  base->step = NO_LANES;
  base->part = (REAL)(0.0f);
  if (m->grid != NO_LAYER_GRID) {
    widen_base(m, roughness, base);
    base->straight = grid_number(scene, m, base, LAYER_GRID_STRAIGHT, lanes);
    base->shine_scale = grid_number(scene, m, base, LAYER_GRID_SHINE_SCALE, lanes);
    base->matte_scale = grid_number(scene, m, base, LAYER_GRID_MATTE_SCALE, lanes);
    base->matte_scale_bare = grid_number(scene, m, base, LAYER_GRID_MATTE_SCALE_BARE, lanes);
  }
  const REAL of_glass = fma(base->straight, roughness - 1.0f, (REAL)(1.0f));
  const REAL matte = fma(metalness, roughness - of_glass, of_glass);
  base->inner = fma(matte, (REAL)(m->inner_matte - m->inner_smooth), (REAL)(m->inner_smooth));
}
#endif

// The base of `lanes`.
static inline LayerBase base_of(const Scene* scene, __global const Layers* m, const Bsdfs* bsdf, MASK lanes) {
  LayerBase base;
  base.metal = (REAL)(m->specular.w);
  base.glass = (REAL)(m->glass);
  base.alpha_x = (REAL)(m->alpha_x);
  base.alpha_y = (REAL)(m->alpha_y);
  base.straight = (REAL)(m->straight);
  base.inner = (REAL)(m->inner);
  base.shine_scale = (REAL)(m->shine_scale);
  base.matte_scale = (REAL)(m->matte_scale);
  base.matte_scale_bare = (REAL)(m->matte_scale_bare);
#if HAS_LAYER_MAPS
  base.glass = bsdf->glass;
  map_base(scene, m, bsdf->metalness, bsdf->roughness, lanes, &base);
#endif
  return base;
}

// What the base's interface leaves at the cosine c, and the gain of its facets for a direction.
static inline REAL past_shine(const Scene* scene, __global const Layers* m, const LayerBase* base, REAL c,
                              MASK lanes) {
#if HAS_LAYER_MAPS
  if (m->grid != NO_LAYER_GRID) return grid_row(scene, m, base, (MASK)(0), c, lanes);
#endif
  return layer_row(scene, m, LAYER_SHINE, c, lanes);
}
static inline REAL shine_gain(const Scene* scene, __global const Layers* m, const LayerBase* base, REAL3 w,
                              MASK lanes) {
#if HAS_LAYER_MAPS
  if (m->grid != NO_LAYER_GRID) return grid_gain(scene, m, base, w, lanes);
#endif
  return plain_shine_gain(scene, m, w, lanes);
}
#endif

#endif
