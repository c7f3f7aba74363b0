// Light from all around the scene: an equirectangular picture and how its directions are chosen.
#ifndef SUNDOG_SHARED_ENVIRONMENT_H
#define SUNDOG_SHARED_ENVIRONMENT_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// 64 bytes. The picture's rows go from the top (`up`) to the bottom, its columns about the axis: the middle
// is seen along `ahead`, what is right of it along `right`. The table `environment` holds its pixels (rgb),
// row by row; `environment_shares` first the running sums of the light of the rows of cells, from 0 to 1,
// then for each row those of its cells. A cell covers whole pixels.
typedef struct Environment {
  float4 right, up, ahead;  // unit, at right angles
  u32 width, height;        // in pixels
  u32 columns, rows;        // in cells
} Environment;
SUNDOG_SHARED_SIZE(Environment, 64)

SUNDOG_SHARED_END
#endif
