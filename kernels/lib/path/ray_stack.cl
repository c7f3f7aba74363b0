// Waiting rays with their contributions to pixels. Arrays by member, so that a batch is pushed and popped in
// whole vectors.
#pragma once
#include "lib/path/scene_ray.cl"

#define HAS_ONE_RAY (BATCH == 1)
#include "plain/path/waiting_ray.cl"

// Where in the word of the depth the number of crossings begins.
#define CROSSINGS_SHIFT 16
// The members of a waiting ray, in order; this list generates their number, writing and reading. A single
// pixel has one time, and its rays start at surfaces (start_on_surfaces()).
#if BATCH > 1
#define STACKED_BATCH(REALS, MASKS) \
  MASKS(paths->pixel)               \
  REALS(rays->t_min) HAVING(HAS_MEDIA, REALS(rays->since)) HAVING(HAS_OBJECT_MOTION, REALS(rays->time))
#else
#define STACKED_BATCH(REALS, MASKS)
#endif
// A list:
// clang-format off
#define STACKED(REALS, MASKS)                                                                               \
  REALS(rays->o.x) REALS(rays->o.y) REALS(rays->o.z) REALS(rays->d.x) REALS(rays->d.y) REALS(rays->d.z)     \
  REALS(rays->t_max) STACKED_BATCH(REALS, MASKS)                                                            \
  REALS(paths->throughput.x) REALS(paths->throughput.y) REALS(paths->throughput.z) MASKS(depth)             \
  HAVING(HAS_MEDIA, MASKS(rays->media.low) MASKS(rays->media.high))                                         \
  HAVING(HAS_SDF, MASKS(rays->from) REALS(rays->footprint))                                                 \
  HAVING(HAS_SIDES, MASKS(rays->sides))                                                                     \
  HAVING(HAS_RANDOM, MASKS(paths->branch))                                                                   \
  HAVING(HAS_CONES, REALS(rays->cone_width) REALS(rays->cone_spread))
// clang-format on
#define COUNT_MEMBER(member) +1u
#define STACK_MEMBERS (0u STACKED(COUNT_MEMBER, COUNT_MEMBER))

// Arrays exceed the capacity by BATCH: see write_packed().
#if BATCH > 1
#define STACK_LENGTH (RAY_STACK + BATCH)
#define SHADOW_LENGTH (3u * BATCH)  // fewer than a batch wait when another comes
typedef struct ShadowStack {
  float members[STACK_MEMBERS * SHADOW_LENGTH];
  u32 count;
} ShadowStack;
#else
// Both kinds of rays wait together: children, one that meets a surface again if that may have more lights
// than there is room for, then shadow rays.
#define STACK_LENGTH (RAY_STACK + LIGHT_ROOM + (LIGHT_ROOM >= MOST_LIGHT_ROOM))
#define SHADOW_LENGTH STACK_LENGTH
#define ShadowStack RayStack
#endif
typedef struct RayStack {
  float members[STACK_MEMBERS * STACK_LENGTH];
  u32 count;
  u32 light;           // the next light of the ray that meets a surface again
  float t_min, since;  // of that ray
} RayStack;

// Writes the lanes of `lanes` contiguously; member k goes to to[k * stride].
NEVER_INLINE void write_rays(float* to, u32 stride, const SceneRays* rays, const WaitingRays* paths,
                             MASK lanes) {
  const MASK depth = paths->depth HAVING(HAS_CROSSINGS, | rays->crossings << CROSSINGS_SHIFT);
#define WRITE_REALS(member)        \
  write_packed(to, member, lanes); \
  to += stride;
#define WRITE_MASKS(member) WRITE_REALS(AS_REAL(member))
  STACKED(WRITE_REALS, WRITE_MASKS)
}

// Reads a ray for every lane.
NEVER_INLINE void read_rays(const float* from, u32 stride, SceneRays* rays, WaitingRays* paths) {
  MASK depth;
  paths->pixel = NO_LANES;
  rays->media.low = rays->media.high = NO_LANES;
  forget_glow(rays, ALL_LANES);
#define READ_REALS(member)   \
  member = read_lanes(from); \
  from += stride;
#define READ_MASKS(member)            \
  member = AS_MASK(read_lanes(from)); \
  from += stride;
  STACKED(READ_REALS, READ_MASKS)
  paths->depth = depth & ((1 << CROSSINGS_SHIFT) - 1);
  HAVING(HAS_CROSSINGS, rays->crossings = depth >> CROSSINGS_SHIFT;)
}

// Pushes the lanes of `lanes`; there must be room.
static inline void push_rays(RayStack* stack, const SceneRays* rays, const WaitingRays* paths, MASK lanes) {
  write_rays(stack->members + stack->count, STACK_LENGTH, rays, paths, lanes);
  stack->count += lane_count(lanes);
}
static inline void push_shadows(ShadowStack* stack, const SceneRays* rays, const WaitingRays* paths,
                                MASK lanes) {
  write_rays(stack->members + stack->count, SHADOW_LENGTH, rays, paths, lanes);
  stack->count += lane_count(lanes);
}

// Pops the newest rays, at most `most` and BATCH. Returns their lanes.
static inline MASK pop_rays(RayStack* stack, u32 most, SceneRays* rays, WaitingRays* paths) {
  const u32 count = min(stack->count, most);
  stack->count -= count;
  read_rays(stack->members + stack->count, STACK_LENGTH, rays, paths);
  return lanes_of((1u << count) - 1u);
}
static inline MASK pop_shadows(ShadowStack* stack, u32 most, SceneRays* rays, WaitingRays* paths) {
  const u32 count = min(stack->count, most);
  stack->count -= count;
  read_rays(stack->members + stack->count, SHADOW_LENGTH, rays, paths);
  return lanes_of((1u << count) - 1u);
}

// Adds light to the pixels of `lanes`, lane by lane, because several may share a pixel.
static inline void add_to_pixels(REAL3 light, MASK pixel, MASK lanes, float4* radiance) {
  EACH_LANE(i, lanes) { radiance[MASK_LANE(pixel, i)].xyz += get3(&light, i); }
}
