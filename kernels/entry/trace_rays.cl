// One stage: hits for given rays, for tests and benchmarks of the tracer alone. A work-item takes BATCH rays
// in a row. `coherent` says that they run close together.
#include "lib/traverse.cl"

// The BATCH rays of work-item `item`, in the form that the tracer takes; lanes without a ray have the last
// one. Lanes are put together in registers: read back from memory, they would wait for sixteen writes.
#define LOAD_BATCH                                                              \
  const u32 first = item * BATCH;                                               \
  if (first >= ray_count) return;                                               \
  const MASK lanes = lanes_of((1u << min((u32)BATCH, ray_count - first)) - 1u); \
  REAL ox, oy, oz, dx, dy, dz, starts, ends;                                    \
  _Pragma("unroll") for (u32 i = 0; i < BATCH; ++i) {                           \
    const float8 ray = vload8(min(first + i, ray_count - 1u), &rays->ox);       \
    REAL_LANE(ox, i) = ray.s0;                                                  \
    REAL_LANE(oy, i) = ray.s1;                                                  \
    REAL_LANE(oz, i) = ray.s2;                                                  \
    REAL_LANE(starts, i) = ray.s3;                                              \
    REAL_LANE(dx, i) = ray.s4;                                                  \
    REAL_LANE(dy, i) = ray.s5;                                                  \
    REAL_LANE(dz, i) = ray.s6;                                                  \
    REAL_LANE(ends, i) = ray.s7;                                                \
  }                                                                             \
  const REAL3 o = real3(ox, oy, oz), d = real3(dx, dy, dz);                     \
  const REAL t_min = starts, t_max = ends;

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
