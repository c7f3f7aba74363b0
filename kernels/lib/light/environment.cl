// Light of the environment's picture. A direction a lane.
#pragma once
#include "lib/core/directions.cl"
#include "lib/core/tables.h"
#include "lib/path/camera.cl"
#include "plain/light/light_sample.cl"

// Where directions lie in the picture: shares of its width and, from the top, of its height.
static inline void environment_place(__global const Environment* e, REAL3 d, REAL* x, REAL* y) {
  const REAL right = dot3(d, all3(e->right.xyz)), ahead = dot3(d, all3(e->ahead.xyz));
  const REAL up = real_clamp(dot3(d, all3(e->up.xyz)), (REAL)(-1.0f), (REAL)(1.0f));
  const REAL turn = fma(atan2(right, ahead), (REAL)(0.5f / M_PI_F), (REAL)(0.5f));
  *x = real_clamp(turn, (REAL)(0.0f), (REAL)(1.0f));
  *y = real_acos(up) * (1.0f / M_PI_F);
}

// The picture there, blended between the middles of its pixels and round its seam.
NEVER_INLINE REAL3 environment_at(const Scene* scene, REAL x, REAL y, MASK lanes) {
  const int width = (int)scene->environments->width, height = (int)scene->environments->height;
  const REAL across = x * (float)width - 0.5f, down = y * (float)height - 0.5f;
  const REAL left = floor(across), top = floor(down), a = across - left, b = down - top;
  const MASK column = TO_MASK(left), row = TO_MASK(top),
             x0 = select(column, column + width, MASK_OF(column < 0));
  const MASK x1 = select((MASK)(0), x0 + 1, MASK_OF(x0 + 1 < width));
  const MASK y0 = max(row, (MASK)(0)) * width, y1 = min(row + 1, (MASK)(height - 1)) * width;
  REAL3 light = all3((float3)(0.0f));
  EACH_LANE(i, lanes) {
    __global const float4 *upper = scene->environment + MASK_LANE(y0, i),
                          *lower = scene->environment + MASK_LANE(y1, i);
    const int p = MASK_LANE(x0, i), q = MASK_LANE(x1, i);
    const float4 above = upper[p] + REAL_LANE(a, i) * (upper[q] - upper[p]);
    const float4 below = lower[p] + REAL_LANE(a, i) * (lower[q] - lower[p]);
    set3(&light, i, (above + REAL_LANE(b, i) * (below - above)).xyz);
  }
  return light;
}

// Running sums: where they and their words begin, and how many steps they have.
typedef struct RunningSums {
  u32 first, words, count;
} RunningSums;

static inline RunningSums sums_of_rows(__global const Environment* e) {
  const RunningSums sums = {e->rows + 1u, 0u, e->rows};
  return sums;
}
static inline RunningSums sums_of_cells(__global const Environment* e, u32 row) {
  const RunningSums sums = {row * (e->columns + 1u) + 2u * (e->rows + 1u),
                            row * CUTPOINTS_OF(e->columns) + CUTPOINTS_OF(e->rows), e->columns};
  return sums;
}

// The word for u in [0, 1).
static inline __global const u32* word_of(const Scene* scene, RunningSums sums, float u) {
  const u32 words = CUTPOINTS_OF(sums.count);
  return scene->environment_cutpoints + sums.words + min((u32)(u * (float)words), words - 1u);
}

// The last step that begins at or before u, one that has light, for u in [0, 1); `place`: where in it u lies.
// Found between cutpoints (Chen and Asau 1974, "On Generating Random Variates from an Empirical
// Distribution"), several sums at once.
static inline u32 choose_step(const Scene* scene, RunningSums of, float u, float* share, float* place) {
  __global const float* sums = scene->environment_shares + of.first;
  const u32 word = *word_of(scene, of, u);
  u32 low = word & ((1u << CUTPOINT_SHIFT) - 1u), high = word >> CUTPOINT_SHIFT;
  while (high - low >= LANES) {
    const u32 middle = (low + high + 1u) >> 1;
    const bool before = sums[middle] <= u;
    low = before ? middle : low;
    high = before ? high : middle - 1u;
  }
  low += popcount(lane_bits(MASK_OF(load_lanes(sums + low + 1u) <= u)) & ((1u << (high - low)) - 1u));
  *share = sums[low + 1u] - sums[low];
  *place = clamp((u - sums[low]) / fmax(*share, 1e-37f), 0.0f, 1.0f);
  return low;
}

// Cells by two numbers in [0, 1), with their share of the light, and places in them; the luminances of the
// pixels at the corners of cells between pixels: left and right of the top, left and right of the bottom.
typedef struct ChosenCells {
  MASK column, row;
  REAL share, across, down;
  REAL corner[4];
} ChosenCells;

// The rows of pixels above and below the middle of a row of cells between pixels.
static inline __global const float4* pixels_above(const Scene* scene, u32 row) {
  return scene->environment + (max(row, 1u) - 1u) * scene->environments->width;
}
static inline __global const float4* pixels_below(const Scene* scene, u32 row) {
  return scene->environment + min(row, scene->environments->height - 1u) * scene->environments->width;
}

static inline void find_corners(const Scene* scene, MASK lanes, ChosenCells* cells) {
  EACH_LANE(i, lanes) {
    const u32 row = (u32)MASK_LANE(cells->row, i), right = (u32)MASK_LANE(cells->column, i),
              left = (right ? right : scene->environments->width) - 1u;
    __global const float4 *above = pixels_above(scene, row), *below = pixels_below(scene, row);
    REAL_LANE(cells->corner[0], i) = above[left].w;
    REAL_LANE(cells->corner[1], i) = above[right].w;
    REAL_LANE(cells->corner[2], i) = below[left].w;
    REAL_LANE(cells->corner[3], i) = below[right].w;
  }
}

// A step after the other for all lanes, so that what one needs from memory comes while others are at work.
NEVER_INLINE void choose_cells(const Scene* scene, REAL u_x, REAL u_y, MASK lanes, ChosenCells* cells) {
  __global const Environment* e = scene->environments;
  const RunningSums rows = sums_of_rows(e);
  const bool blended = e->up.w == CELLS_BETWEEN_PIXELS;
  cells->column = cells->row = NO_LANES;
  cells->share = cells->across = cells->down = (REAL)(0.0f);
  for (u32 i = 0; i < 4u; ++i) cells->corner[i] = (REAL)(0.0f);
  EACH_LANE(i, lanes) {
    float share, down;
    const u32 row = choose_step(scene, rows, REAL_LANE(u_y, i), &share, &down);
    FETCH_ROW(word_of(scene, sums_of_cells(e, row), REAL_LANE(u_x, i)));
    MASK_LANE(cells->row, i) = (int)row;
    REAL_LANE(cells->share, i) = share;
    REAL_LANE(cells->down, i) = down;
  }
  EACH_LANE(i, lanes) {
    const u32 row = (u32)MASK_LANE(cells->row, i);
    float share, across;
    const u32 column = choose_step(scene, sums_of_cells(e, row), REAL_LANE(u_x, i), &share, &across);
    if (blended) {
      FETCH_ROW(pixels_above(scene, row) + column);
      FETCH_ROW(pixels_below(scene, row) + column);
    }
    MASK_LANE(cells->column, i) = (int)column;
    REAL_LANE(cells->share, i) *= share;
    REAL_LANE(cells->across, i) = across;
  }
  if (blended) find_corners(scene, lanes, cells);
}

// The share of steps of running sums that begin at `first`.
static inline REAL share_of_step(const Scene* scene, MASK first, MASK step, MASK lanes) {
  return gather_floats(scene->environment_shares, first + step + 1, lanes) -
         gather_floats(scene->environment_shares, first + step, lanes);
}

static inline REAL mix_lanes(REAL from, REAL to, REAL part) { return fma(part, to - from, from); }

// The place in [0, 1] by the number u, where the density goes evenly from `from` to `to`.
static inline REAL place_by_slope(REAL u, REAL from, REAL to) {
  const REAL v = real_max(u, (REAL)(1e-7f)), sum = from + to;
  const REAL root = real_sqrt(mix_lanes(from * from, to * to, v));
  return select(v, real_min(v * sum / nonzero(from + root), (REAL)(1.0f)), MASK_OF(sum > 0.0f));
}

// Moves places in cells between pixels, even in [0, 1], to where luminance puts them.
static inline void place_by_light(ChosenCells* cells) {
  const REAL* c = cells->corner;
  cells->down = place_by_slope(cells->down, c[0] + c[1], c[2] + c[3]);
  cells->across =
      place_by_slope(cells->across, mix_lanes(c[0], c[2], cells->down), mix_lanes(c[1], c[3], cells->down));
}

static inline REAL row_fact(const Scene* scene, MASK row, MASK lanes) {
  return gather_floats(scene->environment_shares, row, lanes);
}

// The density, per steradian, of directions that rows of cells between pixels choose by their radiance.
static inline REAL blended_pdf(const Scene* scene, REAL3 radiance, MASK row, REAL sine, MASK lanes) {
  const REAL light =
      fma((REAL)(0.0722f), radiance.z, fma((REAL)(0.7152f), radiance.y, (REAL)(0.2126f) * radiance.x));
  return light * row_fact(scene, row, lanes) / real_max(sine, (REAL)(1e-6f));
}

// The density, per steradian, of the directions of cells with the share `share`, which are chosen evenly in
// them; `height`: the difference of the cosines of their row's borders.
static inline REAL even_pdf(__global const Environment* e, REAL share, REAL height) {
  return share * (float)e->columns / (2.0f * M_PI_F * height);
}

// The environment's radiance along the directions of `lanes`, and the density with which
// sample_environment() chooses them.
static inline REAL3 environment_along(const Scene* scene, REAL3 d, MASK lanes, REAL* pdf) {
  __global const Environment* e = scene->environments;
  REAL x, y;
  environment_place(e, d, &x, &y);
  const REAL3 radiance = environment_at(scene, x, y, lanes);
  if (e->up.w == CELLS_BETWEEN_PIXELS) {
    REAL sine, cosine;
    sincos_of_turn(0.5f * y, &sine, &cosine);
    const MASK row = TO_MASK(fma(y, (REAL)((float)e->height), (REAL)(0.5f)));
    *pdf = blended_pdf(scene, radiance, row, sine, lanes);
    return radiance;
  }
  const MASK column = min(TO_MASK(x * (float)e->columns), (MASK)((int)e->columns - 1)),
             row = min(TO_MASK(y * (float)e->rows), (MASK)((int)e->rows - 1));
  const int above = (int)e->rows + 1;
  const REAL row_share = share_of_step(scene, (MASK)(above), row, lanes),
             share = share_of_step(scene, row * ((int)e->columns + 1) + 2 * above, column, lanes);
  *pdf = even_pdf(e, share * row_share, row_fact(scene, row, lanes) - row_fact(scene, row + 1, lanes));
  return radiance;
}

// Directions by two numbers in [0, 1): a row of cells by its share of the light, a cell in it, a place there.
static inline LightSamples sample_environment(const Scene* scene, REAL u_x, REAL u_y, MASK lanes) {
  __global const Environment* e = scene->environments;
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  ChosenCells cells;
  choose_cells(scene, u_x, u_y, lanes, &cells);
  LightSamples sample;
  sample.pdf = zero;
  REAL x, y, up, side;
  const bool blended = e->up.w == CELLS_BETWEEN_PIXELS;
  if (blended) {
    place_by_light(&cells);
    const REAL height = (REAL)((float)e->height), row = TO_REAL(cells.row);
    const REAL top = real_max(row - 0.5f, zero), bottom = real_min(row + 0.5f, height);
    x = (TO_REAL(cells.column) + cells.across - 0.5f) / (float)e->width;
    y = mix_lanes(top, bottom, cells.down) / height;
    sincos_of_turn(0.5f * y, &side, &up);
  } else {
    const REAL top = row_fact(scene, cells.row, lanes), height = top - row_fact(scene, cells.row + 1, lanes);
    x = (TO_REAL(cells.column) + cells.across) / (float)e->columns;
    up = fma(-cells.down, height, top);
    side = real_sqrt(real_max(fma(-up, up, one), zero));
    y = real_acos(real_clamp(up, -one, one)) * (1.0f / M_PI_F);
    sample.pdf = even_pdf(e, cells.share, height);
  }
  REAL sine, cosine;
  sincos_of_turn(x - 0.5f, &sine, &cosine);
  sample.wi = along3(along3(scale3(all3(e->up.xyz), up), side * sine, all3(e->right.xyz)), side * cosine,
                     all3(e->ahead.xyz));
  sample.distance = (REAL)(INFINITY);
  sample.delta = NO_LANES;
  sample.radiance = environment_at(scene, x, y, lanes);
  if (blended) sample.pdf = blended_pdf(scene, sample.radiance, cells.row, side, lanes);
  return sample;
}

// The environment where rays see it, with the density of choosing it, else the background.
static inline bool sees_environment(const Scene* scene) {
  return HAS_ENVIRONMENT && scene->info->sees_environment;
}
static inline REAL3 distant_along(const Scene* scene, REAL3 d, MASK lanes, REAL* pdf) {
  return sees_environment(scene) ? environment_along(scene, d, lanes, pdf) : background_along(scene->info, d);
}

// The same, where the rays of `camera` do not see what is hidden from them.
static inline REAL3 hide_environment(const Scene* scene, REAL3 d, REAL3 light, MASK camera) {
  if (scene->info->sees_environment != SEEN_OFF_CAMERA) return light;
  return select3(light, background_along(scene->info, d), camera);
}
