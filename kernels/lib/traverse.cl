// The narrow interface of the tracer that shading sees. In: a ray or a batch of rays, and the tables. Out:
// the nearest hit, or whether there is any. What is found does not depend on the order of visits, nor on
// whether a ray goes alone.
#ifndef SUNDOG_LIB_TRAVERSE_CL
#define SUNDOG_LIB_TRAVERSE_CL
#include "lib/config.h"
#include "lib/packet.cl"
#include "lib/single.cl"
#include "lib/tables.h"
#include "lib/walk.cl"

static inline bool finite3(float3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

// A ray with a component that is not finite, or with no direction, hits nothing.
static inline bool traceable(float3 o, float3 d, float t_min, float t_max) {
  const float3 zero = o * 0.0f + d * 0.0f;  // NaN where one is not finite
  return zero.x + zero.y + zero.z == 0.0f && t_max > t_min && (d.x != 0.0f || d.y != 0.0f || d.z != 0.0f);
}

static inline Hit no_hit(float t_max) {
  const Hit hit = {t_max, 0.0f, 0.0f, NO_PRIM, NO_INSTANCE, 0.0f, 0.0f, 0.0f};
  return hit;
}

#if HAS_PLANE
static inline void trace_planes(TRACE_PARAMETERS, float3 o, float3 d, float t_min, Hit* hit) {
  for (u32 i = info->bounded_count; i < info->instance_count; ++i)
    trace_solid(instances, i, object_point(instances + i, o), object_vector(instances + i, d), t_min, hit);
}
#endif

static inline void finish_hit(TRACE_PARAMETERS, Hit* hit) {
#if HAS_MESH
  if (hit->instance != NO_INSTANCE && instances[hit->instance].shape == SHAPE_MESH)
    finish_triangle(blocks, hit);
#endif
}

// The nearest hits of `count` rays, or with `any` whichever come first; each ray by itself. A triangle's prim
// is its place.
NEVER_INLINE void trace_alone(TRACE_PARAMETERS, const float3* o, const float3* d, const float* t_min,
                              const float* t_max, u32 count, bool any, Hit* found) {
#if HAS_TRACED
  u32 which[BATCH], live = 0;
  for (u32 i = 0; i < count; ++i) {
    found[i] = no_hit(t_max[i]);
    if (traceable(o[i], d[i], t_min[i], t_max[i])) which[live++] = i;
  }
#if WALKS_IN_TURN
  const WalkRays rays = {o, d, t_min, found};
  if (info->bounded_count == 1u && instances->shape == SHAPE_MESH && (instances->flags & INSTANCE_IDENTITY))
    walk_rays(TRACE_ARGUMENTS, &rays, which, live, instances->root, 0u, any);
  else if (info->bounded_count > 0u)
    walk_rays(TRACE_ARGUMENTS, &rays, which, live, info->bounded_count == 1u ? BVH_LEAF : info->tlas_root,
              NO_INSTANCE, any);
#else
  for (u32 k = 0; k < live; ++k) {
    const u32 i = which[k];
    trace_instances(TRACE_ARGUMENTS, o[i], d[i], t_min[i], any, &found[i]);
  }
#endif
#if HAS_PLANE
  for (u32 k = 0; k < live; ++k) {
    const u32 i = which[k];
    if (!any || found[i].instance == NO_INSTANCE)
      trace_planes(TRACE_ARGUMENTS, o[i], d[i], t_min[i], &found[i]);
  }
#endif
#else
  for (u32 i = 0; i < count; ++i) found[i] = no_hit(t_max[i]);
#endif
}

#if PACKETS
// Rays become a packet; a lane beyond `count` and a ray that hits nothing stand in as a copy of another and
// are switched off. Returns false when the rays do not go as one.
NEVER_INLINE bool make_packet(const float3* o, const float3* d, const float* t_min, const float* t_max,
                              u32 count, PacketRays* rays, PacketHits* hits) {
  for (u32 i = 0; i < count; ++i) {
    set_packet_ray(rays, i, o[i], d[i]);
    set_lane(&hits->t_min, i, t_min[i]);
    set_lane(&hits->t, i, t_max[i]);
  }
  const u32 live = live_rays(rays, hits) & (ALL_RAYS >> (PACKET - count));
  if (!live) return false;
  if (live != ALL_RAYS) {
    const u32 stand_in = lowest_bit(live);
    for (u32 i = 0; i < PACKET; ++i) {
      if (live >> i & 1u) continue;
      set_packet_ray(rays, i, packet_origin(rays, stand_in), packet_direction(rays, stand_in));
      set_lane(&hits->t_min, i, get_lane(&hits->t_min, stand_in));
      set_lane(&hits->t, i, -1.0f);
    }
  }
  hits->prim = (uint16)(NO_PRIM);
  hits->instance = (uint16)(NO_INSTANCE);
  hits->t_least = least_of(hits->t_min);
  hits->t_most = most_of(hits->t);
  return aim_packet(rays);
}
#endif

// The first `count` (at most BATCH) of rays (o, d) in (t_min, t_max]. `coherent`: they run close together.
static inline void trace_batch(TRACE_PARAMETERS, const float3* o, const float3* d, const float* t_min,
                               const float* t_max, u32 count, bool coherent, Hit* found) {
#if PACKETS
  PacketRays rays;
  PacketHits hits;
  if (coherent && count > PACKET_LEAST && make_packet(o, d, t_min, t_max, count, &rays, &hits)) {
    packet_in_scene(TRACE_ARGUMENTS, &rays, &hits, false);
    for (u32 i = 0; i < count; ++i) {
      found[i] = get_index(&hits.instance, i) == NO_INSTANCE ? no_hit(t_max[i]) : packet_hit(&hits, i);
      finish_hit(TRACE_ARGUMENTS, &found[i]);
    }
    return;
  }
#endif
  trace_alone(TRACE_ARGUMENTS, o, d, t_min, t_max, count, false, found);
  for (u32 i = 0; i < count; ++i) finish_hit(TRACE_ARGUMENTS, &found[i]);
}

// The same for whether anything is hit: occluded[i] becomes 1 or 0.
static inline void occluded_batch(TRACE_PARAMETERS, const float3* o, const float3* d, const float* t_min,
                                  const float* t_max, u32 count, bool coherent, u32* occluded) {
#if PACKETS
  PacketRays rays;
  PacketHits hits;
  if (coherent && count > PACKET_LEAST && make_packet(o, d, t_min, t_max, count, &rays, &hits)) {
    packet_in_scene(TRACE_ARGUMENTS, &rays, &hits, true);
    for (u32 i = 0; i < count; ++i) occluded[i] = get_index(&hits.instance, i) != NO_INSTANCE;
    return;
  }
#endif
  Hit found[BATCH];
  trace_alone(TRACE_ARGUMENTS, o, d, t_min, t_max, count, true, found);
  for (u32 i = 0; i < count; ++i) occluded[i] = found[i].instance != NO_INSTANCE ? 1u : 0u;
}

#endif
