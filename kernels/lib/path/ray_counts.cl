// Counts pixels with rays that have lost count of the media they are in, and, on request, camera, reflected,
// refracted and shadow rays of pixels. With RAYS_BY_LANE they are counted per pixel of a work-item, after the
// launch's counters; else for all its pixels together, as the first one's.
#pragma once
#include "lib/core/counters.cl"
#include "lib/core/lanes.h"
#include "lib/path/tile.cl"

// An integrator with one pixel per lane may define it for all its kernels.
#ifndef RAYS_BY_LANE
#define RAYS_BY_LANE HAS_RAY_COUNTS
#endif

// Counts a ray for each lane of `lanes`.
static inline void count_lanes(u32* counts, u32 which, MASK lanes) { counts[which] += lane_count(lanes); }

#define ALL_COUNTS (OWN_COUNTERS + (RAYS_BY_LANE ? BATCH : 0))

// Counts a ray for each lane of `lanes`, in the work-item's pixels `pixels`.
static inline void note_rays(MASK pixels, MASK lanes, u32* counts) {
  if (!RAYS_BY_LANE) return;
  EACH_LANE(i, lanes) counts[OWN_COUNTERS + MASK_LANE(pixels, i)] += 1u;
}
// note_rays() if lane i is of pixel i.
static inline void note_own_rays(MASK lanes, u32* counts) {
  if (!RAYS_BY_LANE) return;
  float* own = (float*)(counts + OWN_COUNTERS);
  write_lanes(own, AS_REAL(AS_MASK(read_lanes(own)) - lanes));
}
// Bits of lanes whose rays have lost count of media become those of their pixels in a work-item, from this
// one on.
#define LOST_PIXELS 16u
static inline void note_lost_pixels(MASK pixels, u32* counts) {
  const u32 lost = BATCH > 1 ? counts[COUNT_LOST_PIXEL] : 0u;
  if (!(lost & 0xffffu)) return;
  u32 noted = lost & 0xffff0000u;
  for (u32 left = lost & 0xffffu; left; left &= left - 1u)
    noted |= 1u << LOST_PIXELS << MASK_LANE(pixels, lowest_bit(left));
  counts[COUNT_LOST_PIXEL] = noted;
}
// Adds what a lane has counted to the rectangle's pixel `place`.
static inline void add_lane_rays(const Launch* launch, u32 place, u32 lane, u32* counts,
                                 __global u32* restrict rays) {
  if (RAYS_BY_LANE) {
    if (launch->counts_rays) rays[place] += counts[OWN_COUNTERS + lane];
    counts[OWN_COUNTERS + lane] = 0u;
  }
  if (!(counts[LOST_LANES] & LOST_LANE(lane))) return;
  counts[LOST_LANES] -= LOST_LANE(lane);
  rays[place] |= LOST_PIXEL;
}
// Adds what the work-item's pixels, a lane each, have counted.
static inline void add_ray_counts(const Launch* launch, __global const u32* restrict pixels, u32 item,
                                  u32* counts, __global u32* restrict rays) {
  const u32 all =
      counts[COUNT_PRIMARY] + counts[COUNT_REFLECTION] + counts[COUNT_REFRACTION] + counts[COUNT_SHADOW];
  if (BATCH > 1) counts[COUNT_LOST_PIXEL] >>= LOST_PIXELS;
  const bool lost = BATCH > 1 && counts[COUNT_LOST_PIXEL] != 0u;
  for (u32 lane = 0; lane < (RAYS_BY_LANE || lost ? BATCH : 1u); ++lane) {
    const uint2 at = lane_pixel(launch, item, lane);
    uint2 pixel;
    if (!image_pixel(launch, pixels, at, &pixel)) continue;
    const u32 place = at.y * launch->width + at.x;
    add_lane_rays(launch, place, lane, counts, rays);
    if (!RAYS_BY_LANE && lane == 0u && launch->counts_rays) rays[place] += all;
  }
}
