// One stage: hits for given rays, for tests and benchmarks of the tracer alone. A work-item takes BATCH rays
// in a row. `coherent` says that they run close together.
#include "lib/traverse.cl"

// Lane i is ray first + i, or the last one. Lanes are put together in registers: read back from memory, they
// would wait for sixteen writes.
#define LOAD_MEMBER(to, member)                                                  \
  {                                                                              \
    REAL lanes_read;                                                             \
    _Pragma("unroll") for (u32 i = 0; i < BATCH; ++i) REAL_LANE(lanes_read, i) = \
        rays[min(first + i, ray_count - 1u)].member;                             \
    to = lanes_read;                                                             \
  }

// The BATCH rays of work-item `item`, in the form that the tracer takes.
#define LOAD_BATCH                                                              \
  const u32 first = item * BATCH;                                               \
  if (first >= ray_count) return;                                               \
  const MASK lanes = lanes_of((1u << min((u32)BATCH, ray_count - first)) - 1u); \
  REAL3 o, d;                                                                   \
  REAL t_min, t_max;                                                            \
  LOAD_MEMBER(o.x, ox)                                                          \
  LOAD_MEMBER(o.y, oy)                                                          \
  LOAD_MEMBER(o.z, oz)                                                          \
  LOAD_MEMBER(d.x, dx)                                                          \
  LOAD_MEMBER(d.y, dy)                                                          \
  LOAD_MEMBER(d.z, dz)                                                          \
  LOAD_MEMBER(t_min, t_min)                                                     \
  LOAD_MEMBER(t_max, t_max)

NEVER_INLINE void trace_rays_item(TRACE_PARAMETERS, __global const Ray* restrict rays,
                                  __global Hit* restrict hits, u32 ray_count, u32 coherent, u32 item) {
  LOAD_BATCH
  Hits found;
  trace_batch(TRACE_ARGUMENTS, &o, &d, &t_min, t_max, lanes, coherent != 0u, &found);
  for (u32 i = 0; i < BATCH && first + i < ray_count; ++i) hits[first + i] = get_hit(&found, i);
}
NEVER_INLINE void occluded_rays_item(TRACE_PARAMETERS, __global const Ray* restrict rays,
                                     __global u32* restrict occluded, u32 ray_count, u32 coherent, u32 item) {
  LOAD_BATCH
  const MASK found = occluded_batch(TRACE_ARGUMENTS, &o, &d, &t_min, t_max, lanes, coherent != 0u);
  for (u32 i = 0; i < BATCH && first + i < ray_count; ++i)
    occluded[first + i] = (u32)MASK_LANE(found, i) & 1u;
}
// Reads ray_count rays; writes the nearest hit of each in (t_min, t_max].
__kernel void trace_rays(TRACE_PARAMETERS, __global const Ray* restrict rays, __global Hit* restrict hits,
                         u32 ray_count, u32 coherent) {
  trace_rays_item(TRACE_ARGUMENTS, rays, hits, ray_count, coherent, get_global_id(0));
}

// Reads ray_count rays; writes 1 where anything is hit in (t_min, t_max], else 0.
__kernel void occluded_rays(TRACE_PARAMETERS, __global const Ray* restrict rays,
                            __global u32* restrict occluded, u32 ray_count, u32 coherent) {
  occluded_rays_item(TRACE_ARGUMENTS, rays, occluded, ray_count, coherent, get_global_id(0));
}
