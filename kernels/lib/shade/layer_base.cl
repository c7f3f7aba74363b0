// The base of layered materials at a point: the material's numbers or, if a texture gives its roughness,
// metalness or coat weight, values interpolated in the grid of shared/layers.h. One surface per lane; the
// lanes of a call have one material.
#ifndef SUNDOG_LIB_LAYER_BASE_CL
#define SUNDOG_LIB_LAYER_BASE_CL
#include "lib/shade/layer_lobes.cl"

#if HAS_LAYERS
typedef struct LayerBase {
  REAL metal;                    // metalness
  REAL glass, alpha_x, alpha_y;  // as in Layers, like the members below
  REAL straight, inner, shine_scale, matte_scale, matte_scale_bare;
#if HAS_LAYER_MAPS
  MASK step;  // of the grid, and interpolation weight
  REAL part;
#endif
#if HAS_COAT_MAPS
  REAL coat;       // factor on the coat's weight
  MASK coat_step;  // of the weight, and interpolation weight
  REAL coat_part;
  REAL eta, eta_next;  // of the base at both steps
#endif
#if HAS_FUZZ_MAPS
  REAL3 fuzz;  // factor on the fuzz's color
#endif
#if HAS_SPECULAR_MAPS
  REAL3 tint;   // factor on the reflectance of the dielectric's interface
  REAL tinted;  // its largest component, for the loss of light below
#endif
} LayerBase;

// Whether a texture gives the coat's weight, and another one the roughness.
#if HAS_COAT_MAPS
static inline bool maps_coat(__global const Layers* m) { return m->coat_grid != NO_LAYER_GRID; }
static inline bool has_coat_grids(__global const Layers* m) { return maps_coat(m) && m->coat_grid != 0u; }
#endif

// The coat's weight, the strength of its darkening, and the light it transmits if its row has `row`.
#if HAS_COAT_MAPS
static inline REAL coat_weight(__global const Layers* m, const LayerBase* base) {
  return m->coat.w * base->coat;
}
static inline REAL darkening(__global const Layers* m, const LayerBase* base) {
  return m->darkening * base->coat;
}
static inline REAL past_coat(const LayerBase* base, REAL row) {
  return fma(base->coat, row - 1.0f, (REAL)(1.0f));
}
#else
static inline REAL coat_weight(__global const Layers* m, const LayerBase* base) { return (REAL)(m->coat.w); }
static inline REAL darkening(__global const Layers* m, const LayerBase* base) { return (REAL)(m->darkening); }
static inline REAL past_coat(const LayerBase* base, REAL row) { return row; }
#endif

// The light that the dielectric's interface transmits if its row has `row`, and its reflected colour.
#if HAS_SPECULAR_MAPS
static inline REAL past_interface(const LayerBase* base, REAL row) {
  return fma(base->tinted, row - 1.0f, (REAL)(1.0f));
}
static inline REAL3 interface_tint(__global const Layers* m, const LayerBase* base) {
  return multiply3(all3(m->specular.xyz), base->tint);
}
// matte_scale_bare is 1 over the mean transmission of the interface, which the tint changes. Layers above
// transmit less at grazing angles, like the interface, so the mean of both changes at most as much.
static inline void tint_base(const Bsdfs* bsdf, LayerBase* base) {
  base->tint = bsdf->tint;
  base->tinted = greatest3(bsdf->tint);
  const REAL gain = 1.0f / fma(1.0f - base->tinted, base->matte_scale_bare - 1.0f, (REAL)(1.0f));
  base->matte_scale *= gain;
  base->matte_scale_bare *= gain;
}
#else
static inline REAL past_interface(const LayerBase* base, REAL row) { return row; }
static inline REAL3 interface_tint(__global const Layers* m, const LayerBase* base) {
  return all3(m->specular.xyz);
}
static inline void tint_base(const Bsdfs* bsdf, LayerBase* base) {}
#endif

// The light that fuzz transmits if its row has `row`, and its color.
#if HAS_FUZZ_MAPS
static inline REAL past_fibres(const LayerBase* base, REAL row) {
  return fma(greatest3(base->fuzz), row - 1.0f, (REAL)(1.0f));
}
static inline REAL3 fuzz_color(__global const Layers* m, const LayerBase* base) {
  return multiply3(all3(m->fuzz.xyz), base->fuzz);
}
#else
static inline REAL past_fibres(const LayerBase* base, REAL row) { return row; }
static inline REAL3 fuzz_color(__global const Layers* m, const LayerBase* base) { return all3(m->fuzz.xyz); }
#endif

// Light that fuzz transmits to the ground, with mean matte_scale, is linear in its weight; below a coat
// slightly less returns.
#if HAS_FUZZ_MAPS
static inline void set_fuzz(__global const Layers* m, const Bsdfs* bsdf, LayerBase* base) {
  base->fuzz = bsdf->fuzz;
  if (m->fuzz.w == 0.0f) return;
  const REAL bare = 1.0f / base->matte_scale_bare, full = 1.0f / base->matte_scale;
  base->matte_scale = 1.0f / fma(greatest3(bsdf->fuzz), full - bare, bare);
}
#else
static inline void set_fuzz(__global const Layers* m, const Bsdfs* bsdf, LayerBase* base) {}
#endif

// A row of a material's table at the cosine c, for `lanes`.
static inline REAL layer_row(const Scene* scene, __global const Layers* layers, u32 row, REAL c, MASK lanes) {
  const REAL x = real_clamp(c, (REAL)(0.0f), (REAL)(1.0f)) * (float)(LAYER_STEPS - 1u);
  const MASK low = min(TO_MASK(x), (MASK)((int)LAYER_STEPS - 2));
  __global const float* from = scene->layer_rows + layers->first + row * LAYER_STEPS;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + 1, low, lanes);
  return fma(x - TO_REAL(low), b - a, a);
}
// A film's row at the cosine c, at the step of the coat's weight.
#if HAS_COAT_MAPS
static inline REAL film_row(const Scene* scene, __global const Layers* m, const LayerBase* base, u32 row,
                            REAL c, MASK lanes) {
  if (!maps_coat(m)) return layer_row(scene, m, row, c, lanes);
  const REAL x = real_clamp(c, (REAL)(0.0f), (REAL)(1.0f)) * (float)(LAYER_STEPS - 1u);
  const MASK at = min(TO_MASK(x), (MASK)((int)LAYER_STEPS - 2));
  const MASK low = base->coat_step * (int)(LAYER_FILM_ROWS * LAYER_STEPS) + at;
  __global const float* from = scene->layer_rows + m->first + (LAYER_ROWS + row - LAYER_FILM) * LAYER_STEPS;
  __global const float* next = from + LAYER_FILM_ROWS * LAYER_STEPS;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + 1, low, lanes);
  const REAL c0 = gather_floats(next, low, lanes), d = gather_floats(next + 1, low, lanes);
  const REAL along = x - TO_REAL(at), near = fma(along, b - a, a), far = fma(along, d - c0, c0);
  return fma(base->coat_part, far - near, near);
}
#else
static inline REAL film_row(const Scene* scene, __global const Layers* m, const LayerBase* base, u32 row,
                            REAL c, MASK lanes) {
  return layer_row(scene, m, row, c, lanes);
}
#endif
static inline REAL3 film_rows(const Scene* scene, __global const Layers* m, const LayerBase* base, u32 row,
                              REAL c, MASK lanes) {
  return real3(film_row(scene, m, base, row, c, lanes), film_row(scene, m, base, row + 1u, c, lanes),
               film_row(scene, m, base, row + 2u, c, lanes));
}

// Position of a direction among the LAYER_TURNS rows by its azimuth.
static inline REAL turn_place(REAL3 w) {
  const REAL along = w.x * w.x, flat = real_max(fma(w.y, w.y, along), (REAL)(1e-12f));
  return along / flat * (float)(LAYER_TURNS - 1u);
}

// Gain of anisotropic facets for a direction, from the rows starting at `first`.
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
// Whether facets are isotropic: their gains are one row.
static inline bool round_facets(__global const Layers* m) { return m->narrowed == 1.0f; }

// Offset of the coat weight's grid by roughness from the material's first.
#if HAS_COAT_MAPS
static inline MASK grid_of_coat(__global const Layers* m, const LayerBase* base) {
  return has_coat_grids(m) ? base->coat_step * (int)m->coat_grid : NO_LANES;
}
#else
static inline MASK grid_of_coat(__global const Layers* m, const LayerBase* base) { return NO_LANES; }
#endif

// Interpolates a number by roughness, in the grid `ahead` entries after that of the coat's weight.
static inline REAL number_in_grid(const Scene* scene, __global const Layers* m, const LayerBase* base,
                                  u32 ahead, u32 which, MASK lanes) {
  __global const float* from = scene->layer_rows + m->grid + ahead + which;
  const MASK low = grid_of_coat(m, base) + base->step * (int)LAYER_GRID_NUMBERS;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + LAYER_GRID_NUMBERS, low, lanes);
  return fma(base->part, b - a, a);
}
// Interpolates a row at the cosine c: row 0 is LAYER_SHINE, rows from 1 on are gains.
static inline REAL row_in_grid(const Scene* scene, __global const Layers* m, const LayerBase* base, u32 ahead,
                               MASK row, REAL c, MASK lanes) {
  const u32 size = LAYER_STEPS * (round_facets(m) ? 2u : 1u + LAYER_TURNS);
  const REAL x = real_clamp(c, (REAL)(0.0f), (REAL)(1.0f)) * (float)(LAYER_STEPS - 1u);
  const MASK at = min(TO_MASK(x), (MASK)((int)LAYER_STEPS - 2));
  const MASK low = grid_of_coat(m, base) + (base->step * (int)size + row * (int)LAYER_STEPS + at);
  __global const float* from = scene->layer_rows + m->grid + ahead + LAYER_GRID_NUMBERS * LAYER_GRID_STEPS;
  const REAL a = gather_floats(from, low, lanes), b = gather_floats(from + 1, low, lanes);
  const REAL c0 = gather_floats(from + size, low, lanes), d = gather_floats(from + size + 1u, low, lanes);
  const REAL along = x - TO_REAL(at), near = fma(along, b - a, a), far = fma(along, d - c0, c0);
  return fma(base->part, far - near, near);
}

// Also interpolates between steps of the coat's weight; gains are equal in all of these.
#if HAS_COAT_MAPS
static inline REAL grid_number(const Scene* scene, __global const Layers* m, const LayerBase* base, u32 which,
                               MASK lanes) {
  const REAL near = number_in_grid(scene, m, base, 0u, which, lanes);
  if (!has_coat_grids(m)) return near;
  const REAL far = number_in_grid(scene, m, base, m->coat_grid, which, lanes);
  return fma(base->coat_part, far - near, near);
}
static inline REAL grid_shine(const Scene* scene, __global const Layers* m, const LayerBase* base, REAL c,
                              MASK lanes) {
  const REAL near = row_in_grid(scene, m, base, 0u, (MASK)(0), c, lanes);
  if (!has_coat_grids(m)) return near;
  const REAL far = row_in_grid(scene, m, base, m->coat_grid, (MASK)(0), c, lanes);
  return fma(base->coat_part, far - near, near);
}
#else
static inline REAL grid_number(const Scene* scene, __global const Layers* m, const LayerBase* base, u32 which,
                               MASK lanes) {
  return number_in_grid(scene, m, base, 0u, which, lanes);
}
static inline REAL grid_shine(const Scene* scene, __global const Layers* m, const LayerBase* base, REAL c,
                              MASK lanes) {
  return row_in_grid(scene, m, base, 0u, (MASK)(0), c, lanes);
}
#endif
static inline REAL grid_gain(const Scene* scene, __global const Layers* m, const LayerBase* base, REAL3 w,
                             MASK lanes) {
  if (round_facets(m)) return row_in_grid(scene, m, base, 0u, (MASK)(1), w.z, lanes);
  const REAL y = turn_place(w);
  const MASK row = min(TO_MASK(y), (MASK)((int)LAYER_TURNS - 2));
  const REAL near = row_in_grid(scene, m, base, 0u, row + 1, w.z, lanes),
             far = row_in_grid(scene, m, base, 0u, row + 2, w.z, lanes);
  return fma(y - TO_REAL(row), far - near, near);
}

// The relative index of a dielectric base over what lies above it, which has the coat's index in proportion
// to the coat's weight; inverted if below 1 (OpenPBR 1.1, "Coat", "Index of refraction").
#if HAS_COAT_MAPS
static inline REAL base_eta(__global const Layers* m, REAL weight) {
  const REAL above = fma(weight, (REAL)(m->coat_bends), (REAL)(1.0f));
  const REAL root = m->index_scale * fabs(m->index - above) / (m->index + above);
  const REAL bounded = real_min(root, (REAL)(0.99949987f));
  return (1.0f + bounded) / (1.0f - bounded);
}
// Sets the coat's weight for the texture value `coat`, and dependent members.
static inline void weigh_coat(__global const Layers* m, REAL coat, LayerBase* base) {
  base->coat = (REAL)(1.0f);
  base->coat_step = NO_LANES;
  base->coat_part = (REAL)(0.0f);
  base->eta = base->eta_next = (REAL)(m->eta);
  if (!maps_coat(m)) return;
  const float intervals = (float)(LAYER_GRID_STEPS - 1u), interval = m->coat.w / intervals;
  const REAL y = coat * intervals;
  base->coat = coat;
  base->coat_step = min(TO_MASK(y), (MASK)((int)LAYER_GRID_STEPS - 2));
  base->coat_part = y - TO_REAL(base->coat_step);
  base->eta = base_eta(m, TO_REAL(base->coat_step) * interval);
  base->eta_next = base_eta(m, TO_REAL(base->coat_step + 1) * interval);
}
// Steps of a grid by the coat's weight alone.
static inline void step_by_coat(__global const Layers* m, LayerBase* base) {
  if (m->coat_grid != 0u) return;
  base->step = base->coat_step;
  base->part = base->coat_part;
}
#else
static inline void step_by_coat(__global const Layers* m, LayerBase* base) {}
#endif

// Sets the base's facet widths for `roughness`, as seen through the coat's.
static inline void widen_base(__global const Layers* m, REAL roughness, LayerBase* base) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f), square = roughness * roughness;
  const REAL both = real_sqrt(real_sqrt(real_min(one, fma(square, square, (REAL)(m->haze)))));
  const REAL root = real_clamp(fma(coat_weight(m, base), both - roughness, roughness), zero, one);
  const REAL along = real_min(root * root * m->stretch, one);
  base->alpha_x = real_max(along, (REAL)(LEAST_LAYER_ALPHA));
  base->alpha_y = real_max(along * m->narrowed, (REAL)(LEAST_LAYER_ALPHA));
  const REAL y = root * (float)(LAYER_GRID_STEPS - 1u);
  base->step = min(TO_MASK(y), (MASK)((int)LAYER_GRID_STEPS - 2));
  const REAL part = LAYER_GRID_PART(y, TO_REAL(base->step));
  base->part = select(part, part * part, MASK_OF(base->step == 0));
  step_by_coat(m, base);
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
#if HAS_COAT_MAPS
  weigh_coat(m, bsdf->coat, &base);
#endif
  map_base(scene, m, bsdf->metalness, bsdf->roughness, lanes, &base);
#endif
  tint_base(bsdf, &base);
  set_fuzz(m, bsdf, &base);
  return base;
}

// Reflectance of a dielectric base's interface at the cosine c. Interpolated between two steps of the coat's
// weight, like the rows of transmitted light.
#if HAS_COAT_MAPS
static inline REAL base_reflectance(__global const Layers* m, const LayerBase* base, REAL c) {
  const REAL near = interface_reflectance(c, base->eta);
  if (!maps_coat(m)) return near;
  return fma(base->coat_part, interface_reflectance(c, base->eta_next) - near, near);
}
#else
static inline REAL base_reflectance(__global const Layers* m, const LayerBase* base, REAL c) {
  return interface_reflectance(c, (REAL)(m->eta));
}
#endif

// Light that the base's interface transmits at the cosine c, and the gain of its facets for a direction.
static inline REAL past_shine(const Scene* scene, __global const Layers* m, const LayerBase* base, REAL c,
                              MASK lanes) {
#if HAS_LAYER_MAPS
  if (m->grid != NO_LAYER_GRID) return past_interface(base, grid_shine(scene, m, base, c, lanes));
#endif
  return past_interface(base, layer_row(scene, m, LAYER_SHINE, c, lanes));
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
