// One stage: hits for given rays, for tests and benchmarks of the tracer alone. A work-item takes BATCH rays
// in a row. `coherent` says that they run close together.
#define TRACES_ALONE
#include "lib/trace/traverse.cl"

#if LANES == 16
// Eight members of sixteen rays or hits. In memory two lie in a vector one after the other; what gathers a
// member's lanes in a vector is three rounds of the same exchange, and its reverse scatters them again.
ALWAYS_INLINE void gather_members(float16* v) {
#pragma unroll
  for (u32 bit = 1; bit < 8u; bit <<= 1)
#pragma unroll
    for (u32 i = 0; i < 8u; ++i)
      if (!(i & bit)) {
        const float16 a = v[i], b = v[i | bit];
        v[i] = (float16)(a.even, b.even);
        v[i | bit] = (float16)(a.odd, b.odd);
      }
}
ALWAYS_INLINE void scatter_members(float16* v) {
#pragma unroll
  for (u32 bit = 4; bit > 0u; bit >>= 1)
#pragma unroll
    for (u32 i = 0; i < 8u; ++i)
      if (!(i & bit)) {
        const float16 a = v[i], b = v[i | bit];
        v[i].even = a.lo, v[i].odd = b.lo;
        v[i | bit].even = a.hi, v[i | bit].odd = b.hi;
      }
}
#endif

typedef struct Batch {
  REAL3 o, d;
  REAL t_min, t_max;
  MASK lanes;
} Batch;

// The BATCH rays from `first` on, in the form that the tracer takes; lanes without a ray have the last one.
// They are put together in registers: read back from memory, they would wait for sixteen writes.
// (Not a result: Oclgrind cannot run what is inlined and returns a structure, or takes a restrict pointer.)
ALWAYS_INLINE void load_batch(__global const Ray* rays, u32 ray_count, u32 first, Batch* batch) {
  const u32 count = min((u32)BATCH, ray_count - first);
  batch->lanes = lanes_of((1u << count) - 1u);
#if LANES == 16
  float16 v[8];
  if (count == BATCH)
#pragma unroll
    for (u32 i = 0; i < 8u; ++i) v[i] = vload16(i, &rays[first].ox);
  else
#pragma unroll
    for (u32 i = 0; i < 8u; ++i)
      v[i] = (float16)(vload8(first + min(2u * i, count - 1u), &rays->ox),
                       vload8(first + min(2u * i + 1u, count - 1u), &rays->ox));
  gather_members(v);
  batch->o = real3(v[0], v[1], v[2]);
  batch->d = real3(v[4], v[5], v[6]);
  batch->t_min = v[3];
  batch->t_max = v[7];
#else
#pragma unroll
  for (u32 i = 0; i < BATCH; ++i) {
    const float8 ray = vload8(first + min(i, count - 1u), &rays->ox);
    set3(&batch->o, i, ray.s012);
    set3(&batch->d, i, ray.s456);
    REAL_LANE(batch->t_min, i) = ray.s3;
    REAL_LANE(batch->t_max, i) = ray.s7;
  }
#endif
}

NEVER_INLINE void trace_rays_item(const Scene* scene, __global const Ray* restrict rays,
                                  __global Hit* restrict hits, u32 ray_count, u32 coherent, u32 item) {
  const u32 first = item * BATCH;
  if (first >= ray_count) return;
  Batch batch;
  load_batch(rays, ray_count, first, &batch);
  Hits found;
  const TraceRays traced = {&batch.o, &batch.d, &batch.t_min, &found, 0, 0};
  trace_batch(scene, &traced, batch.t_max, (REAL)(0.0f), batch.lanes, coherent != 0u);
#if LANES == 16
  if (first + BATCH <= ray_count) {
    float16 v[8] = {found.t,    found.u,    found.v,   as_float16(found.prim), as_float16(found.instance),
                    found.ng.x, found.ng.y, found.ng.z};
    scatter_members(v);
#pragma unroll
    for (u32 i = 0; i < 8u; ++i) vstore16(v[i], i, &hits[first].t);
    return;
  }
#endif
  for (u32 i = 0; i < BATCH && first + i < ray_count; ++i) hits[first + i] = get_hit(&found, i);
}
NEVER_INLINE void occluded_rays_item(const Scene* scene, __global const Ray* restrict rays,
                                     __global u32* restrict occluded, u32 ray_count, u32 coherent, u32 item) {
  const u32 first = item * BATCH;
  if (first >= ray_count) return;
  Batch batch;
  load_batch(rays, ray_count, first, &batch);
  const MASK found = occluded_batch(scene, &batch.o, &batch.d, &batch.t_min, batch.t_max, (REAL)(0.0f),
                                    batch.lanes, coherent != 0u);
#if LANES == 16
  if (first + BATCH <= ray_count) {
    vstore16(as_uint16(found) & 1u, 0, occluded + first);
    return;
  }
#endif
  for (u32 i = 0; i < BATCH && first + i < ray_count; ++i)
    occluded[first + i] = (u32)MASK_LANE(found, i) & 1u;
}
// Reads ray_count rays; writes the nearest hit of each in (t_min, t_max].
__kernel FOR_SUBGROUP void trace_rays(SCENE_PARAMETERS, __global const Ray* restrict rays,
                                      __global Hit* restrict hits, u32 ray_count, u32 coherent) {
  const Scene scene = SCENE_OF_PARAMETERS;
  trace_rays_item(&scene, rays, hits, ray_count, coherent, get_global_id(0));
}

// Reads ray_count rays; writes 1 where anything is hit in (t_min, t_max], else 0.
__kernel FOR_SUBGROUP void occluded_rays(SCENE_PARAMETERS, __global const Ray* restrict rays,
                                         __global u32* restrict occluded, u32 ray_count, u32 coherent) {
  const Scene scene = SCENE_OF_PARAMETERS;
  occluded_rays_item(&scene, rays, occluded, ray_count, coherent, get_global_id(0));
}
