// The rays that wait, with what each adds to its pixel. Arrays by member, so that a batch is pushed and taken
// in whole vectors.
#ifndef SUNDOG_LIB_RAY_STACK_CL
#define SUNDOG_LIB_RAY_STACK_CL
#include "lib/scene_ray.cl"

// What rays carry besides their way.
typedef struct PathStates {
  REAL3 throughput;
  MASK pixel;  // in the work-item's tile
  MASK depth;  // the camera's ray has 1
} PathStates;

#define STACK_MEMBERS 15u

typedef struct RayStack {
  float members[STACK_MEMBERS][RAY_STACK + BATCH];  // BATCH more: see write_packed()
  u32 count;
} RayStack;

// The lanes of `lanes`; there must be room.
static inline void push_rays(RayStack* stack, const SceneRays* rays, const PathStates* paths, MASK lanes) {
  const u32 at = stack->count;
  write_packed(stack->members[0] + at, rays->o.x, lanes);
  write_packed(stack->members[1] + at, rays->o.y, lanes);
  write_packed(stack->members[2] + at, rays->o.z, lanes);
  write_packed(stack->members[3] + at, rays->d.x, lanes);
  write_packed(stack->members[4] + at, rays->d.y, lanes);
  write_packed(stack->members[5] + at, rays->d.z, lanes);
  write_packed(stack->members[6] + at, paths->throughput.x, lanes);
  write_packed(stack->members[7] + at, paths->throughput.y, lanes);
  write_packed(stack->members[8] + at, paths->throughput.z, lanes);
  write_packed(stack->members[9] + at, AS_REAL(paths->pixel), lanes);
  write_packed(stack->members[10] + at, AS_REAL(paths->depth), lanes);
#if HAS_MEDIA
  write_packed(stack->members[11] + at, AS_REAL(rays->media_low), lanes);
  write_packed(stack->members[12] + at, AS_REAL(rays->media_high), lanes);
#endif
#if HAS_SDF
  write_packed(stack->members[13] + at, AS_REAL(rays->from), lanes);
  write_packed(stack->members[14] + at, rays->footprint, lanes);
#endif
  stack->count = at + lane_count(lanes);
}

// Takes the newest rays, at most a batch. Returns their lanes.
static inline MASK pop_rays(RayStack* stack, SceneRays* rays, PathStates* paths) {
  const u32 count = min(stack->count, (u32)BATCH), at = stack->count - count;
  stack->count = at;
  rays->o.x = read_lanes(stack->members[0] + at);
  rays->o.y = read_lanes(stack->members[1] + at);
  rays->o.z = read_lanes(stack->members[2] + at);
  rays->d.x = read_lanes(stack->members[3] + at);
  rays->d.y = read_lanes(stack->members[4] + at);
  rays->d.z = read_lanes(stack->members[5] + at);
  rays->t_min = (REAL)(0.0f);
  rays->t_max = (REAL)(INFINITY);
  paths->throughput.x = read_lanes(stack->members[6] + at);
  paths->throughput.y = read_lanes(stack->members[7] + at);
  paths->throughput.z = read_lanes(stack->members[8] + at);
  paths->pixel = AS_MASK(read_lanes(stack->members[9] + at));
  paths->depth = AS_MASK(read_lanes(stack->members[10] + at));
  rays->media_low = NO_LANES;
  rays->media_high = NO_LANES;
#if HAS_MEDIA
  rays->media_low = AS_MASK(read_lanes(stack->members[11] + at));
  rays->media_high = AS_MASK(read_lanes(stack->members[12] + at));
#endif
#if HAS_SDF
  rays->from = AS_MASK(read_lanes(stack->members[13] + at));
  rays->footprint = read_lanes(stack->members[14] + at);
#endif
#if HAS_GLOW
  rays->glow = all3((float3)(0.0f));
#endif
  return lanes_of((1u << count) - 1u);
}

#endif
