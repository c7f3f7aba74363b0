// Rays that wait, with what each adds to its pixel. Arrays by member, so that a batch is pushed and taken in
// whole vectors.
#ifndef SUNDOG_LIB_RAY_STACK_CL
#define SUNDOG_LIB_RAY_STACK_CL
#include "lib/scene_ray.cl"

// What rays carry besides their way.
typedef struct PathStates {
  REAL3 throughput;  // of a shadow ray: the light that it would bring
  MASK pixel;        // in the work-item's tile
  MASK depth;        // the camera's ray has 1, a shadow ray 0
} PathStates;

#define CROSSING_MEMBERS (12u + (BATCH > 1))
#define MEDIA_MEMBERS (CROSSING_MEMBERS + RAYS_CROSS)
#define SDF_MEMBERS (MEDIA_MEMBERS + 3u * HAS_MEDIA)
#define STACK_MEMBERS (SDF_MEMBERS + 2u * HAS_SDF)

// Arrays are BATCH longer than what may wait: see write_packed().
#if BATCH > 1
#define STACK_LENGTH (RAY_STACK + BATCH)
#define SHADOW_LENGTH (3u * BATCH)  // fewer than a batch wait when another comes
typedef struct ShadowStack {
  float members[STACK_MEMBERS * SHADOW_LENGTH];
  u32 count;
} ShadowStack;
#else
// Rays of both kinds wait together: children, then at most one ray that goes on later, then shadow rays.
#define STACK_LENGTH (RAY_STACK + LIGHT_ROOM + 1)
#define SHADOW_LENGTH STACK_LENGTH
#define ShadowStack RayStack
#endif
typedef struct RayStack {
  float members[STACK_MEMBERS * STACK_LENGTH];
  u32 count;
} RayStack;

#define PUSH(member, lanes_value) write_packed(to + (member)*stride, lanes_value, lanes)
// Writes the lanes of `lanes` one behind the other; member k goes to to[k * stride].
NEVER_INLINE void write_rays(float* to, u32 stride, const SceneRays* rays, const PathStates* paths,
                             MASK lanes) {
  PUSH(0u, rays->o.x);
  PUSH(1u, rays->o.y);
  PUSH(2u, rays->o.z);
  PUSH(3u, rays->d.x);
  PUSH(4u, rays->d.y);
  PUSH(5u, rays->d.z);
  PUSH(6u, rays->t_min);
  PUSH(7u, rays->t_max);
  PUSH(8u, paths->throughput.x);
  PUSH(9u, paths->throughput.y);
  PUSH(10u, paths->throughput.z);
  PUSH(11u, AS_REAL(paths->depth));
#if BATCH > 1
  PUSH(12u, AS_REAL(paths->pixel));
#endif
#if RAYS_CROSS
  PUSH(CROSSING_MEMBERS, AS_REAL(rays->crossings));
#endif
#if HAS_MEDIA
  PUSH(MEDIA_MEMBERS, AS_REAL(rays->media_low));
  PUSH(MEDIA_MEMBERS + 1u, AS_REAL(rays->media_high));
  PUSH(MEDIA_MEMBERS + 2u, rays->since);
#endif
#if HAS_SDF
  PUSH(SDF_MEMBERS, AS_REAL(rays->from));
  PUSH(SDF_MEMBERS + 1u, rays->footprint);
#endif
}
#undef PUSH

#define PULL(member) read_lanes(from + (member)*stride)
// Reads a ray for every lane.
NEVER_INLINE void read_rays(const float* from, u32 stride, SceneRays* rays, PathStates* paths) {
  rays->o = real3(PULL(0u), PULL(1u), PULL(2u));
  rays->d = real3(PULL(3u), PULL(4u), PULL(5u));
  rays->t_min = PULL(6u);
  rays->t_max = PULL(7u);
  paths->throughput = real3(PULL(8u), PULL(9u), PULL(10u));
  paths->depth = AS_MASK(PULL(11u));
  paths->pixel = NO_LANES;
#if BATCH > 1
  paths->pixel = AS_MASK(PULL(12u));
#endif
  rays->media_low = NO_LANES;
  rays->media_high = NO_LANES;
#if RAYS_CROSS
  rays->crossings = AS_MASK(PULL(CROSSING_MEMBERS));
#endif
#if HAS_MEDIA
  rays->media_low = AS_MASK(PULL(MEDIA_MEMBERS));
  rays->media_high = AS_MASK(PULL(MEDIA_MEMBERS + 1u));
  rays->since = PULL(MEDIA_MEMBERS + 2u);
#endif
#if HAS_SDF
  rays->from = AS_MASK(PULL(SDF_MEMBERS));
  rays->footprint = PULL(SDF_MEMBERS + 1u);
#endif
#if HAS_GLOW
  rays->glow = all3((float3)(0.0f));
#endif
}
#undef PULL

// The lanes of `lanes`; there must be room.
static inline void push_rays(RayStack* stack, const SceneRays* rays, const PathStates* paths, MASK lanes) {
  write_rays(stack->members + stack->count, STACK_LENGTH, rays, paths, lanes);
  stack->count += lane_count(lanes);
}
static inline void push_shadows(ShadowStack* stack, const SceneRays* rays, const PathStates* paths,
                                MASK lanes) {
  write_rays(stack->members + stack->count, SHADOW_LENGTH, rays, paths, lanes);
  stack->count += lane_count(lanes);
}

// Takes the newest rays, at most `most`, which is at most BATCH. Returns their lanes.
static inline MASK pop_rays(RayStack* stack, u32 most, SceneRays* rays, PathStates* paths) {
  const u32 count = min(stack->count, most);
  stack->count -= count;
  read_rays(stack->members + stack->count, STACK_LENGTH, rays, paths);
  return lanes_of((1u << count) - 1u);
}
static inline MASK pop_shadows(ShadowStack* stack, u32 most, SceneRays* rays, PathStates* paths) {
  const u32 count = min(stack->count, most);
  stack->count -= count;
  read_rays(stack->members + stack->count, SHADOW_LENGTH, rays, paths);
  return lanes_of((1u << count) - 1u);
}

// Adds light to the pixels of `lanes`, one lane after another: several may have the same pixel.
static inline void add_to_pixels(REAL3 light, MASK pixel, MASK lanes, float4* radiance) {
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    radiance[MASK_LANE(pixel, i)].xyz += get3(&light, i);
  }
}

#endif
