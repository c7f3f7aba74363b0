// One stage: hits for given rays, for tests and benchmarks of the tracer alone. A work-item takes BATCH rays
// in a row. `coherent` says that they run close together.
#include "lib/traverse.cl"

// The BATCH rays of work-item `item`, in the form that the tracer takes.
#define LOAD_BATCH                                      \
  const u32 first = item * BATCH;                       \
  if (first >= ray_count) return;                       \
  const u32 count = min((u32)BATCH, ray_count - first); \
  float3 o[BATCH], d[BATCH];                            \
  float t_min[BATCH], t_max[BATCH];                     \
  for (u32 i = 0; i < count; ++i) {                     \
    const Ray ray = rays[first + i];                    \
    o[i] = (float3)(ray.ox, ray.oy, ray.oz);            \
    d[i] = (float3)(ray.dx, ray.dy, ray.dz);            \
    t_min[i] = ray.t_min;                               \
    t_max[i] = ray.t_max;                               \
  }

NEVER_INLINE void trace_rays_item(TRACE_PARAMETERS, __global const Ray* restrict rays,
                                  __global Hit* restrict hits, u32 ray_count, u32 coherent, u32 item) {
  LOAD_BATCH
  Hit found[BATCH];
  trace_batch(TRACE_ARGUMENTS, o, d, t_min, t_max, count, coherent != 0u, found);
  for (u32 i = 0; i < count; ++i) hits[first + i] = found[i];
}
NEVER_INLINE void occluded_rays_item(TRACE_PARAMETERS, __global const Ray* restrict rays,
                                     __global u32* restrict occluded, u32 ray_count, u32 coherent, u32 item) {
  LOAD_BATCH
  u32 found[BATCH];
  occluded_batch(TRACE_ARGUMENTS, o, d, t_min, t_max, count, coherent != 0u, found);
  for (u32 i = 0; i < count; ++i) occluded[first + i] = found[i];
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
