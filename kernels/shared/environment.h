// The environment light: an equirectangular picture and the tables to sample its directions.
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// 64 bytes. The picture's rows go from the top (`up`) to the bottom; its centre column lies along `ahead`,
// and columns right of it towards `right`. The table `environment` holds its pixels (rgb), row by row. A cell
// covers whole pixels and is sampled uniformly in solid angle; or, with CELLS_BETWEEN_PIXELS, it lies between
// four pixel centres, whose luminances (w) are interpolated to a density. Then there is one more row of cells
// than of pixels, the first and last rows are half as high, and cells of column 0 straddle the seam.
// `environment_shares` starts with the cosine to `up` of each row's border, one more than rows, or with the
// density of directions, per steradian, divided by luminance and multiplied by the sine to `up`; then the
// cumulative light of rows, from 0 to 1, then for each row that of its cells. `environment_cutpoints` has,
// for rows and then for the cells of each row, a word per four steps: of n words, word k holds the first and,
// above CUTPOINT_SHIFT, the last step that may contain a number in [k, k + 1) / n.
typedef struct Environment {
  float4 right, up, ahead;  // unit, orthogonal; up.w: CELLS_*; ahead.w: its group of lights
  u32 width, height;        // in pixels
  u32 columns, rows;        // in cells
} Environment;
SUNDOG_SHARED_SIZE(Environment, 64)

#define CUTPOINT_SHIFT 16u
#define CUTPOINTS_OF(steps) (((steps) + 3u) / 4u)  // words
#define CELLS_ARE_PIXELS 0.0f
#define CELLS_BETWEEN_PIXELS 1.0f

SUNDOG_SHARED_END
