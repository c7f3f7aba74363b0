// One stage: hits for given rays, for tests and benchmarks of the tracer alone.
#include "lib/traverse.cl"

// Reads ray_count rays; writes the nearest hit of each in (t_min, t_max].
__kernel void trace_rays(TRACE_PARAMETERS, __global const Ray* restrict rays, __global Hit* restrict hits,
                         u32 ray_count) {
  const u32 i = get_global_id(0);
  if (i >= ray_count) return;
  const Ray ray = rays[i];
  hits[i] = trace_ray(TRACE_ARGUMENTS, (float3)(ray.ox, ray.oy, ray.oz), (float3)(ray.dx, ray.dy, ray.dz),
                      ray.t_min, ray.t_max, false);
}

// Reads ray_count rays; writes 1 where anything is hit in (t_min, t_max], else 0.
__kernel void occluded_rays(TRACE_PARAMETERS, __global const Ray* restrict rays,
                            __global u32* restrict occluded, u32 ray_count) {
  const u32 i = get_global_id(0);
  if (i >= ray_count) return;
  const Ray ray = rays[i];
  const Hit hit = trace_ray(TRACE_ARGUMENTS, (float3)(ray.ox, ray.oy, ray.oz),
                            (float3)(ray.dx, ray.dy, ray.dz), ray.t_min, ray.t_max, true);
  occluded[i] = hit.instance != NO_INSTANCE;
}
