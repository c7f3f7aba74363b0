// Light from all around the scene: an equirectangular picture and how its directions are chosen.
#ifndef SUNDOG_SHARED_ENVIRONMENT_H
#define SUNDOG_SHARED_ENVIRONMENT_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// 64 bytes. The picture's rows go from the top (`up`) to the bottom, its columns about the axis: the middle
// is seen along `ahead`, what is right of it along `right`. The table `environment` holds its pixels (rgb),
// row by row. A cell covers whole pixels, or a quarter of one. `environment_shares` has first the cosines to
// `up` of the borders of the rows of cells, then the running sums of the rows' light, from 0 to 1, then for
// each row those of its cells. `environment_cutpoints` has first for the rows, then for the cells of each
// row, n words for n sums' steps: word k has the first and, above CUTPOINT_SHIFT, the last step that a number
// in [k, k + 1) / n may lie in.
typedef struct Environment {
  float4 right, up, ahead;  // unit, at right angles
  u32 width, height;        // in pixels
  u32 columns, rows;        // in cells
} Environment;
SUNDOG_SHARED_SIZE(Environment, 64)

#define CUTPOINT_SHIFT 16u

SUNDOG_SHARED_END
#endif
