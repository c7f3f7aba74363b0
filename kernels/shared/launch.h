// One launch of an integrator: items [first_item, last_item) of a pixel rectangle, row by row, and samples
// [first_sample, first_sample + sample_count) of each pixel. A work-item processes `run` consecutive items.
#pragma once
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

// A listed pixel (x, y) of the image is x | y << 16, or NO_PIXEL.
#define NO_PIXEL 0xffffffffu

// Bit of a pixel's entry in ray_counts: a ray of it has lost count of the media that it is in.
#define LOST_PIXEL 0x80000000u

// Sums over the samples of a pixel, in float4, on request: the objects that cover it, then the materials, as
// pairs (id + 1, share), (0, 0) where there is none.
#define MATTE_RANKS 6u
#define MATTE_VECTORS 6u

// 52 bytes.
typedef struct Launch {
  u32 x0, y0, width, height;  // the rectangle, in image pixels
  u32 first_item, last_item;
  u32 row_items;  // work-items per row of the launch
  u32 blocks;     // 1: single-pixel items are ordered in blocks of 8x4; 0: row by row
  u32 first_sample, sample_count;
  u32 listed;       // 1: pixels of the rectangle stand for listed pixels of the image
  u32 counts_rays;  // 1: the pixels' rays are added to ray_counts
  u32 run;          // 1 for render_whitted
} Launch;
SUNDOG_SHARED_SIZE(Launch, 52)

SUNDOG_SHARED_END
