// Random numbers along rays: by each ray's pixel, sample and position in the ray tree.
#pragma once
#include "lib/core/sampler_lanes.cl"
#include "lib/path/ray_stack.cl"

// The pixels of a work-item's tile: their current sample, the rays that wait, and the light that they
// receive.
typedef struct TileSamples {
  RayStack* stack;
  ShadowStack* shadows;
  float4* radiance;  // in xyz; w is the coverage: 1 less the background that is seen straight on
  HAVING(HAS_RANDOM, MASK x; MASK y; u32 seed;)
  u32 sample;
  // Sums of the launch's pixels, see sample_sums(); the tile's place among them; the sign of its samples.
  HAVING(HAS_MATTES, __global float4* sums; MASK place; REAL sign;)
} TileSamples;

static inline void set_tile_pixels(TileSamples* tile, const LaneSamples* at) {
  HAVING(HAS_RANDOM, tile->x = at->x; tile->y = at->y; tile->seed = at->seed;)
}

// Position in the ray tree of a child of `branch` (0: the camera ray) by its kind: an offset of dimensions
// that distinguishes surfaces of equal depth.
static inline MASK child_branch(MASK branch, u32 kind) {
  return AS_MASK(hash_lanes(AS_UINTS(branch) + (kind + 1u)) & ~0xFFFu);
}

#if HAS_RANDOM

// The numbers of the surfaces hit by the rays of `lanes`: pixels, and dimensions from `dimension` on, which
// counts from a bounce's first.
typedef struct BounceNumbers {
  LaneSamples at;
  MASK first;
  bool later;
} BounceNumbers;

static inline void begin_numbers(const TileSamples* tile, const WaitingRays* paths, u32 dimension, MASK lanes,
                                 BounceNumbers* numbers) {
  numbers->at.x = numbers->at.y = NO_LANES;
  numbers->at.seed = tile->seed;
  EACH_LANE(i, lanes) {
    const u32 pixel = BATCH > 1 ? (u32)MASK_LANE(paths->pixel, i) : 0u;
    MASK_LANE(numbers->at.x, i) = MASK_LANE(tile->x, pixel);
    MASK_LANE(numbers->at.y, i) = MASK_LANE(tile->y, pixel);
  }
  numbers->first = (depth_of(paths, lanes) - 1) * (int)DIMENSIONS_A_BOUNCE + paths->branch +
                   (int)(DIMENSION_BOUNCE + (dimension & ~3u));
  numbers->later = dimension & 2u;
}

// Two of these numbers for part `part` of the `parts` into which the pixel's sample is divided.
static inline void next_numbers(const TileSamples* tile, u32 part, u32 parts, BounceNumbers* numbers,
                                REAL* u_x, REAL* u_y) {
  numbers->at.sample = (MASK)((int)(tile->sample * parts + part));
  pair_lanes(&numbers->at, numbers->first, numbers->later, u_x, u_y);
}

#endif

NEVER_INLINE void bounce_numbers(const TileSamples* tile, const WaitingRays* paths, u32 dimension, u32 part,
                                 u32 parts, MASK lanes, REAL* u_x, REAL* u_y) {
  *u_x = *u_y = (REAL)(0.5f);
  HAVING(HAS_RANDOM, BounceNumbers numbers; begin_numbers(tile, paths, dimension, lanes, &numbers);
         next_numbers(tile, part, parts, &numbers, u_x, u_y);)
}
