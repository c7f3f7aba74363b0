// Reads the environment's tables at a place a lane (plain/light/environment.cl). By hand, since
// the gathers of plain text are slower.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"

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
// Distribution"), at the end in several sums at once.
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

typedef struct ChosenCells {
  MASK column, row;
  REAL share, across, down;
  REAL corner[4];
} ChosenCells;

// A step after the other for all lanes, so that what one needs from memory comes while others are at work.
NEVER_INLINE void choose_cells(const Scene* scene, REAL u_x, REAL u_y, MASK lanes, ChosenCells* cells) {
  __global const Environment* e = scene->environments;
  const RunningSums rows = {e->rows + 1u, 0u, e->rows};
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
  const MASK above = (max(cells->row, (MASK)(1)) - 1) * (int)e->width,
             below = min(cells->row, (MASK)((int)e->height - 1)) * (int)e->width;
  EACH_LANE(i, lanes) {
    float share, across;
    const u32 row = (u32)MASK_LANE(cells->row, i);
    const u32 column = choose_step(scene, sums_of_cells(e, row), REAL_LANE(u_x, i), &share, &across);
    if (blended) {
      FETCH_ROW(scene->environment + MASK_LANE(above, i) + (int)column);
      FETCH_ROW(scene->environment + MASK_LANE(below, i) + (int)column);
    }
    MASK_LANE(cells->column, i) = (int)column;
    REAL_LANE(cells->share, i) *= share;
    REAL_LANE(cells->across, i) = across;
  }
  if (!blended) return;
  const MASK left = select((MASK)((int)e->width), cells->column, MASK_OF(cells->column != 0)) - 1;
  EACH_LANE(i, lanes) {
    __global const float4 *upper = scene->environment + MASK_LANE(above, i),
                          *lower = scene->environment + MASK_LANE(below, i);
    REAL_LANE(cells->corner[0], i) = upper[MASK_LANE(left, i)].w;
    REAL_LANE(cells->corner[1], i) = upper[MASK_LANE(cells->column, i)].w;
    REAL_LANE(cells->corner[2], i) = lower[MASK_LANE(left, i)].w;
    REAL_LANE(cells->corner[3], i) = lower[MASK_LANE(cells->column, i)].w;
  }
}
