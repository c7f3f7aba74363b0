// Counts camera, reflected, refracted and shadow rays of pixels, on request. With RAYS_BY_LANE they are
// counted per pixel of a work-item, after the launch's counters; else for all its pixels together, as the
// first one's.
#pragma once
#include "lib/core/lanes.h"
#include "lib/path/tile.cl"

// An integrator with one pixel per lane may define it for all its kernels.
#ifndef RAYS_BY_LANE
#define RAYS_BY_LANE HAS_RAY_COUNTS
#endif

// Counts a ray for each lane of `lanes`.
static inline void count_lanes(u32* counts, u32 which, MASK lanes) { counts[which] += lane_count(lanes); }

#define ALL_COUNTS (COUNTERS + (RAYS_BY_LANE ? BATCH : 0))

// Counts a ray for each lane of `lanes`, in the work-item's pixels `pixels`.
static inline void note_rays(MASK pixels, MASK lanes, u32* counts) {
  if (!RAYS_BY_LANE) return;
  EACH_LANE(i, lanes) counts[COUNTERS + MASK_LANE(pixels, i)] += 1u;
}
// note_rays() if lane i is of pixel i.
static inline void note_own_rays(MASK lanes, u32* counts) {
  if (!RAYS_BY_LANE) return;
  float* own = (float*)(counts + COUNTERS);
  write_lanes(own, AS_REAL(AS_MASK(read_lanes(own)) - lanes));
}
// Adds a lane's rays to those of the rectangle's pixel `place`.
static inline void add_lane_rays(const Launch* launch, u32 place, u32 lane, u32* counts,
                                 __global u32* restrict rays) {
  if (launch->counts_rays) rays[place] += counts[COUNTERS + lane];
  counts[COUNTERS + lane] = 0u;
}
static inline void add_ray_counts(const Launch* launch, __global const u32* restrict pixels, u32 item,
                                  u32* counts, __global u32* restrict rays) {
  for (u32 lane = 0; lane < (RAYS_BY_LANE ? BATCH : 1u); ++lane) {
    const uint2 at = lane_pixel(launch, item, lane);
    uint2 pixel;
    if (!image_pixel(launch, pixels, at, &pixel)) continue;
    const u32 place = at.y * launch->width + at.x;
    if (RAYS_BY_LANE)
      add_lane_rays(launch, place, lane, counts, rays);
    else if (launch->counts_rays)
      rays[place] +=
          counts[COUNT_PRIMARY] + counts[COUNT_REFLECTION] + counts[COUNT_REFRACTION] + counts[COUNT_SHADOW];
  }
}
