// What one launch of an integrator makes: work-items [first_item, last_item) of a rectangle of pixels, row by
// row, and samples [first_sample, first_sample + sample_count) of each of their pixels.
#ifndef SUNDOG_SHARED_LAUNCH_H
#define SUNDOG_SHARED_LAUNCH_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// 48 bytes.
typedef struct Launch {
  u32 x0, y0, width, height;  // the rectangle, in pixels of the image
  u32 first_item, last_item;
  u32 row_items;  // work-items in a row of the launch
  u32 blocks;     // 1: items of one pixel go through blocks of 8x4; 0: row by row
  u32 first_sample, sample_count;
  u32 pad0, pad1;
} Launch;
SUNDOG_SHARED_SIZE(Launch, 48)

SUNDOG_SHARED_END
#endif
