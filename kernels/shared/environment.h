// Light from all around the scene: an equirectangular picture and how its directions are chosen.
#ifndef SUNDOG_SHARED_ENVIRONMENT_H
#define SUNDOG_SHARED_ENVIRONMENT_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// 64 bytes. The picture's rows go from the top (`up`) to the bottom, its columns about the axis: the middle
// is seen along `ahead`, what is right of it along `right`. The table `environment` holds its pixels (rgb),
// row by row. A cell covers whole pixels, and directions are chosen evenly in its solid angle; or, with
// CELLS_BETWEEN_PIXELS, it lies between the middles of four pixels, whose luminances stand in w, and
// directions are chosen in it as these are blended. Then there is a row of cells more than of pixels, the
// first and the last row are half as high, and cells of column 0 lie across the seam. `environment_shares`
// has first, for each row and one more, the cosine to `up` of its border, or the density of its directions,
// per steradian, over luminance and times the sine to `up`; then the running sums of the rows' light, from 0
// to 1, then for each row those of its cells. `environment_cutpoints` has first for the rows, then for the
// cells of each row, a word for every four steps: of n words word k has the first and, above CUTPOINT_SHIFT,
// the last step that a number in [k, k + 1) / n may lie in.
typedef struct Environment {
  float4 right, up, ahead;  // unit, at right angles; up.w: CELLS_*
  u32 width, height;        // in pixels
  u32 columns, rows;        // in cells
} Environment;
SUNDOG_SHARED_SIZE(Environment, 64)

#define CUTPOINT_SHIFT 16u
#define CUTPOINTS_OF(steps) (((steps) + 3u) / 4u)  // words
#define CELLS_ARE_PIXELS 0.0f
#define CELLS_BETWEEN_PIXELS 1.0f

SUNDOG_SHARED_END
#endif
