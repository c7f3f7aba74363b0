// The base of layered materials at a point: the material's numbers or, if a texture gives its roughness,
// metalness or coat weight, values interpolated in the grid of shared/layers.h.
#include "plain/shade/bsdf.h"
#include "plain/shade/layer_lobes.cl"
#include "plain/shade/lobe_energy.cl"

HAVING(HAS_LAYERS);

typedef struct LayerBase {
  float metal;                    // metalness
  float glass, alpha_x, alpha_y;  // as in Layers, like the members below
  float straight, inner, shine_scale, matte_scale, matte_scale_bare;
  HAVING(HAS_LAYER_MAPS) int step;  // of the grid, and interpolation weight
  HAVING(HAS_LAYER_MAPS) float part;
  HAVING(HAS_COAT_MAPS) float coat;     // factor on the coat's weight
  HAVING(HAS_COAT_MAPS) int coat_step;  // of the weight, and interpolation weight
  HAVING(HAS_COAT_MAPS) float coat_part;
  HAVING(HAS_COAT_MAPS) float eta;  // of the base at both steps
  HAVING(HAS_COAT_MAPS) float eta_next;
  HAVING(HAS_FUZZ_MAPS) float3 fuzz;       // factor on the fuzz's color
  HAVING(HAS_SPECULAR_MAPS) float3 tint;   // factor on the reflectance of the dielectric's interface
  HAVING(HAS_SPECULAR_MAPS) float tinted;  // its largest component, for the loss of light below
} LayerBase;

// Whether a texture gives the coat's weight, and another one the roughness.
static inline bool maps_coat(UNIFORM __global const Layers* m) { return m->coat_grid != NO_LAYER_GRID; }
static inline bool has_coat_grids(UNIFORM __global const Layers* m) {
  return maps_coat(m) && m->coat_grid != 0u;
}

// The coat's weight, the strength of its darkening, and the light it transmits if its row has `row`.
static inline float coat_weight(UNIFORM __global const Layers* m, const LayerBase* base) {
  if (HAS_COAT_MAPS) return m->coat.w * base->coat;
  return m->coat.w;
}
static inline float darkening(UNIFORM __global const Layers* m, const LayerBase* base) {
  if (HAS_COAT_MAPS) return m->darkening * base->coat;
  return m->darkening;
}
static inline float past_coat(const LayerBase* base, float row) {
  if (HAS_COAT_MAPS) return fma(base->coat, row - 1.0f, 1.0f);
  return row;
}

// The light that the dielectric's interface transmits if its row has `row`, and its reflected colour.
static inline float past_interface(const LayerBase* base, float row) {
  if (HAS_SPECULAR_MAPS) return fma(base->tinted, row - 1.0f, 1.0f);
  return row;
}
static inline float3 interface_tint(UNIFORM __global const Layers* m, const LayerBase* base) {
  if (HAS_SPECULAR_MAPS) return m->specular.xyz * base->tint;
  return m->specular.xyz;
}

// The light that fuzz transmits if its row has `row`, and its color.
static inline float past_fibres(const LayerBase* base, float row) {
  if (HAS_FUZZ_MAPS) return fma(greatest(base->fuzz), row - 1.0f, 1.0f);
  return row;
}
static inline float3 fuzz_color(UNIFORM __global const Layers* m, const LayerBase* base) {
  if (HAS_FUZZ_MAPS) return m->fuzz.xyz * base->fuzz;
  return m->fuzz.xyz;
}

// A row of a table at the place x among its steps.
static inline float row_place(float c) { return real_clamp(c, 0.0f, 1.0f) * (float)(LAYER_STEPS - 1u); }
static inline int row_step(float x) { return min((int)x, (int)LAYER_STEPS - 2); }
static inline float between_steps(UNIFORM __global const float* from, int low, float part) {
  const float a = from[low], b = from[low + 1];
  return fma(part, b - a, a);
}
// A row of a material's table at the cosine c.
static inline float layer_row(UNIFORM const Scene* scene, UNIFORM __global const Layers* layers,
                              UNIFORM u32 row, float c) {
  const float x = row_place(c);
  const int low = row_step(x);
  return between_steps(scene->layer_rows + layers->first + row * LAYER_STEPS, low, x - (float)low);
}
// Between two rows, of which the other begins `after` behind `from`.
static inline float between_rows(UNIFORM __global const float* from, UNIFORM u32 after, int low, float along,
                                 float part) {
  const float near = between_steps(from, low, along), far = between_steps(from + after, low, along);
  return fma(part, far - near, near);
}
// A film's row at the cosine c, at the step of the coat's weight.
static inline float film_row(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                             const LayerBase* base, UNIFORM u32 row, float c) {
  if (HAS_COAT_MAPS && maps_coat(m)) {
    const float x = row_place(c);
    const int at = row_step(x), low = base->coat_step * (int)(LAYER_FILM_ROWS * LAYER_STEPS) + at;
    __global const float* from = scene->layer_rows + m->first + (LAYER_ROWS + row - LAYER_FILM) * LAYER_STEPS;
    return between_rows(from, LAYER_FILM_ROWS * LAYER_STEPS, low, x - (float)at, base->coat_part);
  }
  return layer_row(scene, m, row, c);
}
static inline float3 film_rows(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                               const LayerBase* base, UNIFORM u32 row, float c) {
  return (float3)(film_row(scene, m, base, row, c), film_row(scene, m, base, row + 1u, c),
                  film_row(scene, m, base, row + 2u, c));
}

// Position of a direction among the LAYER_TURNS rows by its azimuth.
static inline float turn_place(float3 w) {
  const float along = w.x * w.x, flat = real_max(fma(w.y, w.y, along), 1e-12f);
  return along / flat * (float)(LAYER_TURNS - 1u);
}
static inline int turn_step(float y) { return min((int)y, (int)LAYER_TURNS - 2); }

// Gain of anisotropic facets for a direction, from the rows starting at `first`.
static inline float turned_gain(UNIFORM const Scene* scene, UNIFORM u32 first, float3 w) {
  const float y = turn_place(w), x = row_place(w.z);
  const int row = turn_step(y), at = row_step(x), low = row * (int)LAYER_STEPS + at;
  return between_rows(scene->layer_rows + first, LAYER_STEPS, low, x - (float)at, y - (float)row);
}
static inline float coat_gain(UNIFORM const Scene* scene, UNIFORM __global const Layers* m, float3 w) {
  if (m->coat_gains == NO_LAYER_GAINS) return lobe_energy_at(scene, LOBE_GAINS, w.z, m->coat_alpha);
  return turned_gain(scene, m->coat_gains, w);
}

// Whether facets are isotropic: their gains are one row.
static inline bool round_facets(UNIFORM __global const Layers* m) { return m->narrowed == 1.0f; }

// Offset of the coat weight's grid by roughness from the material's first.
HAVING(HAS_LAYER_MAPS)
static inline int grid_of_coat(UNIFORM __global const Layers* m, const LayerBase* base) {
  int offset = 0;
  if (HAS_COAT_MAPS && has_coat_grids(m)) offset = base->coat_step * (int)m->coat_grid;
  return offset;
}

// Interpolates a number by roughness, in the grid `ahead` entries after that of the coat's weight.
HAVING(HAS_LAYER_MAPS)
static inline float number_in_grid(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                   const LayerBase* base, UNIFORM u32 ahead, UNIFORM u32 which) {
  __global const float* from = scene->layer_rows + m->grid + ahead + which;
  const int low = grid_of_coat(m, base) + base->step * (int)LAYER_GRID_NUMBERS;
  const float a = from[low], b = from[low + (int)LAYER_GRID_NUMBERS];
  return fma(base->part, b - a, a);
}
// Interpolates a row at the cosine c: row 0 is LAYER_SHINE, rows from 1 on are gains.
HAVING(HAS_LAYER_MAPS)
static inline float row_in_grid(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                const LayerBase* base, UNIFORM u32 ahead, int row, float c) {
  const u32 size = LAYER_STEPS * (round_facets(m) ? 2u : 1u + LAYER_TURNS);
  const float x = row_place(c);
  const int at = row_step(x);
  const int low = grid_of_coat(m, base) + (base->step * (int)size + row * (int)LAYER_STEPS + at);
  __global const float* from = scene->layer_rows + m->grid + ahead + LAYER_GRID_NUMBERS * LAYER_GRID_STEPS;
  return between_rows(from, size, low, x - (float)at, base->part);
}

// Also interpolates between steps of the coat's weight; gains are equal in all of these.
HAVING(HAS_LAYER_MAPS)
static inline float grid_number(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                const LayerBase* base, UNIFORM u32 which) {
  const float near = number_in_grid(scene, m, base, 0u, which);
  if (HAS_COAT_MAPS && has_coat_grids(m)) {
    const float far = number_in_grid(scene, m, base, m->coat_grid, which);
    return fma(base->coat_part, far - near, near);
  }
  return near;
}
HAVING(HAS_LAYER_MAPS)
static inline float grid_shine(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                               const LayerBase* base, float c) {
  const float near = row_in_grid(scene, m, base, 0u, 0, c);
  if (HAS_COAT_MAPS && has_coat_grids(m)) {
    const float far = row_in_grid(scene, m, base, m->coat_grid, 0, c);
    return fma(base->coat_part, far - near, near);
  }
  return near;
}
HAVING(HAS_LAYER_MAPS)
static inline float grid_gain(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                              const LayerBase* base, float3 w) {
  if (round_facets(m)) return row_in_grid(scene, m, base, 0u, 1, w.z);
  const float y = turn_place(w);
  const int row = turn_step(y);
  const float near = row_in_grid(scene, m, base, 0u, row + 1, w.z),
              far = row_in_grid(scene, m, base, 0u, row + 2, w.z);
  return fma(y - (float)row, far - near, near);
}

// The relative index of a dielectric base, above which the coat's index counts by its weight.
static inline float base_eta(UNIFORM __global const Layers* m, float weight) {
  return base_index(m->index, m->index_scale, fma(weight, m->coat_bends, 1.0f));
}
// Sets the coat's weight for the texture value `coat`, and dependent members.
HAVING(HAS_COAT_MAPS)
static inline void weigh_coat(UNIFORM __global const Layers* m, float coat, LayerBase* base) {
  base->coat = 1.0f;
  base->coat_step = 0;
  base->coat_part = 0.0f;
  base->eta = m->eta;
  base->eta_next = m->eta;
  if (!maps_coat(m)) return;
  const float intervals = (float)(LAYER_GRID_STEPS - 1u), interval = m->coat.w / intervals;
  const float y = coat * intervals;
  base->coat = coat;
  base->coat_step = min((int)y, (int)LAYER_GRID_STEPS - 2);
  base->coat_part = y - (float)base->coat_step;
  base->eta = base_eta(m, (float)base->coat_step * interval);
  base->eta_next = base_eta(m, (float)(base->coat_step + 1) * interval);
}

// Sets the base's facet widths for `roughness`, as seen through the coat's.
HAVING(HAS_LAYER_MAPS)
static inline void widen_base(UNIFORM __global const Layers* m, float roughness, LayerBase* base) {
  const float root = seen_roughness(roughness, m->haze, coat_weight(m, base));
  const float width = real_min(root * root * m->stretch, 1.0f);
  base->alpha_x = real_max(width, LEAST_LAYER_ALPHA);
  base->alpha_y = real_max(width * m->narrowed, LEAST_LAYER_ALPHA);
  const float y = root * (float)(LAYER_GRID_STEPS - 1u);
  base->step = min((int)y, (int)LAYER_GRID_STEPS - 2);
  const float part = LAYER_GRID_PART(y, (float)base->step);
  base->part = base->step == 0 ? part * part : part;
  if (HAS_COAT_MAPS && m->coat_grid == 0u) {  // a grid by the coat's weight alone
    base->step = base->coat_step;
    base->part = base->coat_part;
  }
}
HAVING(HAS_LAYER_MAPS)
static inline void map_base(UNIFORM const Scene* scene, UNIFORM __global const Layers* m, float metalness,
                            float roughness, LayerBase* base) {
  base->metal = metalness;
  base->step = 0;
  base->part = 0.0f;
  if (m->grid != NO_LAYER_GRID) {
    widen_base(m, roughness, base);
    base->straight = grid_number(scene, m, base, LAYER_GRID_STRAIGHT);
    base->shine_scale = grid_number(scene, m, base, LAYER_GRID_SHINE_SCALE);
    base->matte_scale = grid_number(scene, m, base, LAYER_GRID_MATTE_SCALE);
    base->matte_scale_bare = grid_number(scene, m, base, LAYER_GRID_MATTE_SCALE_BARE);
  }
  const float matte = base_diffuseness(base->straight, metalness, roughness);
  base->inner = fma(matte, m->inner_matte - m->inner_smooth, m->inner_smooth);
}

// Its members for fuzz and coat alone.
static inline LayerBase above_base(UNIFORM __global const Layers* m, const Bsdf* bsdf) {
  LayerBase base;
  if (HAS_COAT_MAPS) weigh_coat(m, bsdf->coat, &base);
  if (HAS_FUZZ_MAPS) base.fuzz = bsdf->fuzz;
  return base;
}

static inline LayerBase base_of(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                const Bsdf* bsdf) {
  LayerBase base = above_base(m, bsdf);
  base.metal = m->specular.w;
  base.glass = m->glass;
  base.alpha_x = m->alpha_x;
  base.alpha_y = m->alpha_y;
  base.straight = m->straight;
  base.inner = m->inner;
  base.shine_scale = m->shine_scale;
  base.matte_scale = m->matte_scale;
  base.matte_scale_bare = m->matte_scale_bare;
  if (HAS_LAYER_MAPS) {
    base.glass = bsdf->glass;
    map_base(scene, m, bsdf->metalness, bsdf->roughness, &base);
  }
  // matte_scale_bare is 1 over the mean transmission of the interface, which the tint changes. Layers above
  // transmit less at grazing angles, like the interface, so the mean of both changes at most as much.
  if (HAS_SPECULAR_MAPS) {
    base.tint = bsdf->tint;
    base.tinted = greatest(bsdf->tint);
    const float gain = 1.0f / fma(1.0f - base.tinted, base.matte_scale_bare - 1.0f, 1.0f);
    base.matte_scale *= gain;
    base.matte_scale_bare *= gain;
  }
  // Light that fuzz transmits to the ground, with mean matte_scale, is linear in its weight; below a coat
  // slightly less returns.
  if (HAS_FUZZ_MAPS) {
    if (m->fuzz.w != 0.0f) {
      const float bare = 1.0f / base.matte_scale_bare, full = 1.0f / base.matte_scale;
      base.matte_scale = 1.0f / fma(greatest(bsdf->fuzz), full - bare, bare);
    }
  }
  return base;
}

// Reflectance of a dielectric base's interface at the cosine c. Interpolated between two steps of the coat's
// weight, like the rows of transmitted light.
static inline float base_reflectance(UNIFORM __global const Layers* m, const LayerBase* base, float c) {
  if (HAS_COAT_MAPS) {
    const float near = interface_reflectance(c, base->eta);
    if (!maps_coat(m)) return near;
    return fma(base->coat_part, interface_reflectance(c, base->eta_next) - near, near);
  }
  return interface_reflectance(c, m->eta);
}

// Light that the base's interface transmits at the cosine c, and the gain of its facets for a direction.
static inline float past_shine(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                               const LayerBase* base, float c) {
  if (HAS_LAYER_MAPS && m->grid != NO_LAYER_GRID) return past_interface(base, grid_shine(scene, m, base, c));
  return past_interface(base, layer_row(scene, m, LAYER_SHINE, c));
}
static inline float shine_gain(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                               const LayerBase* base, float3 w) {
  if (HAS_LAYER_MAPS && m->grid != NO_LAYER_GRID) return grid_gain(scene, m, base, w);
  if (m->alpha_x == m->alpha_y) return layer_row(scene, m, LAYER_GAINS, w.z);
  return turned_gain(scene, m->first + LAYER_GAINS * LAYER_STEPS, w);
}
