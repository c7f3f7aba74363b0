// What one launch of an integrator makes: items [first_item, last_item) of a rectangle of pixels, row by row,
// and samples [first_sample, first_sample + sample_count) of each of their pixels. A work-item takes `run`
// items that follow each other.
#ifndef SUNDOG_SHARED_LAUNCH_H
#define SUNDOG_SHARED_LAUNCH_H
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// A list's pixel of the image (x, y) is x | y << 16; NO_PIXEL is none.
#define NO_PIXEL 0xffffffffu

// 52 bytes.
typedef struct Launch {
  u32 x0, y0, width, height;  // the rectangle, in pixels of the image
  u32 first_item, last_item;
  u32 row_items;  // work-items in a row of the launch
  u32 blocks;     // 1: items of one pixel go through blocks of 8x4; 0: row by row
  u32 first_sample, sample_count;
  u32 listed;       // 1: each pixel of the rectangle stands for one of the image, by a list
  u32 counts_rays;  // 1: ray_counts has room for the pixels of the rectangle
  u32 run;          // of render_whitted 1
} Launch;
SUNDOG_SHARED_SIZE(Launch, 52)

SUNDOG_SHARED_END
#endif
