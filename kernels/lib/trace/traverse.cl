// The tracer's interface for shading. In: a batch of rays, one per lane, and the tables. Out: the nearest
// hits, or occlusion. Results depend neither on the order of visits nor on whether a ray is traced singly.
#pragma once
#include "lib/core/config.h"
#include "lib/core/tables.h"
#include "lib/trace/hits.cl"
#include "lib/trace/listed_hits.cl"
#include "lib/trace/packet.cl"
#include "lib/trace/single.cl"
#include "lib/trace/walk.cl"

// Without meshes, up to this many solids are tested in turn for all rays of a batch, which is faster than
// taking each ray through the BVH. A packet always uses the BVH if there is one.
#ifndef FEW_SOLIDS
#define FEW_SOLIDS 24u
#endif

// Not by products with 0, which some compilers fold to 0.
static inline MASK finite3(const REAL3* a) {
  return MASK_OF(fabs(a->x) < INFINITY) & MASK_OF(fabs(a->y) < INFINITY) & MASK_OF(fabs(a->z) < INFINITY);
}
// Rays that can hit something: excludes rays with a non-finite component or without a direction.
static inline MASK traceable(const REAL3* o, const REAL3* d, REAL t_min, REAL t_max) {
  return finite3(o) & finite3(d) & MASK_OF(t_max > t_min) &
         (MASK_OF(d->x != 0.0f) | MASK_OF(d->y != 0.0f) | MASK_OF(d->z != 0.0f));
}

#if PACKETS
// Makes a packet of the rays; inactive lanes become copies of an active one, switched off. Returns false if
// the rays cannot form a packet.
NEVER_INLINE bool make_packet(const TraceRays* rays, MASK active, PacketRays* packet, PacketHits* hits) {
  const u32 stand_in = lowest_bit(lane_bits(active));
  const REAL3 o = select3(all3(get3(rays->o, stand_in)), *rays->o, active),
              d = select3(all3(get3(rays->d, stand_in)), *rays->d, active);
  packet->o[0] = o.x, packet->o[1] = o.y, packet->o[2] = o.z;
  packet->d[0] = d.x, packet->d[1] = d.y, packet->d[2] = d.z;
  if (!aim_packet(packet)) return false;
  hits->found = rays->hits;
  rays->hits->t = select((REAL)(-1.0f), rays->hits->t, active);
  hits->t_min = select((REAL)(REAL_LANE(*rays->t_min, stand_in)), *rays->t_min, active);
  hits->t_least = least_of(hits->t_min);
  renew_bounds(hits);
  return true;
}
#endif

// trace_packet(): traces the lanes of `active` as a packet; false: they cannot form one. trace_alone():
// traces each lane singly. A `lone_mesh` is the only bounded instance.
#if PACKETS
static inline bool trace_packet(const Scene* scene, const TraceRays* rays, MASK active, bool lone_mesh,
                                bool any) {
  PacketRays packet;
  PacketHits hits;
  const REAL t = rays->hits->t;
  if (lane_count(active) <= PACKET_LEAST || !make_packet(rays, active, &packet, &hits)) return false;
  if (lone_mesh)
    packet_in_mesh(scene, &packet, &hits, scene->instances->root, 0u, any);
  else
    packet_in_scene(scene, &packet, &hits, any);
  rays->hits->t = select(t, rays->hits->t, active);
  return true;
}
#else
static inline bool trace_packet(const Scene* scene, const TraceRays* rays, MASK active, bool lone_mesh,
                                bool any) {
  return false;
}
#endif

#if WALKS_IN_TURN
static inline void trace_alone(const Scene* scene, const TraceRays* rays, MASK active, bool lone_mesh,
                               bool any) {
  const u32 bits = lane_bits(active);
  if (lone_mesh)
    walk_rays(scene, rays, bits, scene->instances->root, 0u, any);
  else
    walk_rays(scene, rays, bits, scene->info->tlas_root, NO_INSTANCE, any);
}
#else
static inline void trace_alone(const Scene* scene, const TraceRays* rays, MASK active, bool lone_mesh,
                               bool any) {
  EACH_LANE(i, active) {
    Hit hit = get_hit(rays->hits, i);
    const REAL time = time_of_hits(rays->hits);
    trace_instances(scene, get3(rays->o, i), get3(rays->d, i), REAL_LANE(*rays->t_min, i), REAL_LANE(time, i),
                    any, &hit);
    set_hit(rays->hits, i, &hit);
  }
}
#endif

// Traces the bounded instances for the lanes of `active`. `way`: TRACE_* bits.
static inline void trace_bounded_batch(const Scene* scene, const TraceRays* world, MASK active, u32 way) {
  TraceRays rays = *world;
  REAL3 o, d;
  // A lone mesh needs no scene BVH, and all rays are transformed to its space at once.
  const bool lone_mesh =
      HAS_MESH && scene->info->tlas_root == BVH_LEAF && scene->instances->shape == SHAPE_MESH;
  if (WIDE_VECTORS && lone_mesh && !(scene->instances->flags & INSTANCE_IDENTITY)) {
    o = object_points(scene->instances, still_origins(rays.hits, 0u, *rays.o));
    d = object_vectors(scene->instances, still_directions(rays.hits, 0u, *rays.d));
    rays.o = &o;
    rays.d = &d;
  }
  const bool any = way & TRACE_ANY;
  if ((way & TRACE_COHERENT) && trace_packet(scene, &rays, active, lone_mesh, any)) return;
  trace_alone(scene, &rays, active, lone_mesh, any);
}

// Whether a batch traverses the BVH; otherwise all solids are tested.
static inline bool goes_in_tree(const Scene* scene, bool coherent) {
  if (HAS_MESH) return scene->info->bounded_count > 0u;
  return HAS_BVH && ((PACKETS && coherent) || scene->info->bounded_count > FEW_SOLIDS);
}

// Sets the hits of the lanes of `active` in (t_min, t_max]. `time`: of the rays, if objects move. `way`:
// TRACE_* bits.
static inline void find_hits(const Scene* scene, const TraceRays* rays, REAL t_max, REAL time, MASK active,
                             u32 way) {
  Hits* hits = rays->hits;
  *hits = no_hits(t_max);
  prepare_hits(scene, time, hits);
  if (!HAS_TRACED) return;
  active &= traceable(rays->o, rays->d, *rays->t_min, t_max);
  const bool in_tree = goes_in_tree(scene, way & TRACE_COHERENT);
  const u32 first = in_tree ? scene->info->bounded_count : 0u;
  if (HAS_SOLID && first < scene->info->instance_count)
    hit_solids(scene->instances, (uint2)(first, scene->info->instance_count), rays->o, rays->d, rays->t_min,
               active, (way & TRACE_ANY) | (HAS_MESH ? TRACE_APART : 0u), hits);
  if (!HAS_BVH) return;
  if (way & TRACE_ANY) active &= ~hit_anything(hits);
  if (LISTS_HITS && rays->lists && !rays->priorities) active &= ~opaque_hits(scene->instances, hits, active);
  if (in_tree && any_lane(active)) trace_bounded_batch(scene, rays, active, way);
}

// Sets indices and geometric normals of hit triangles. `coherent`: several rays hit the same one.
static inline void finish_triangles(const Scene* scene, bool coherent, Hits* hits) {
  if (!HAS_MESH) return;
  const MASK places = hits->prim;
  u32 bits = lane_bits(hit_anything(hits));
  while (bits) {
    const u32 i = lowest_bit(bits);
    bits &= bits - 1u;
    const int instance = MASK_LANE(hits->instance, i), place = MASK_LANE(places, i);
    if (HAS_SOLID && scene->instances[instance].shape != SHAPE_MESH) continue;
    Hit hit;
    hit.prim = (u32)place;
    hit.instance = (u32)instance;
    finish_triangle(scene->instances, scene->blocks, &hit);
    const float3 ng = (float3)(hit.ng_x, hit.ng_y, hit.ng_z);
    if (coherent) {
      const MASK alike = MASK_OF(places == place) & MASK_OF(hits->instance == instance);
      bits &= ~lane_bits(alike);
      hits->prim = select(hits->prim, (MASK)((int)hit.prim), alike);
      hits->instance = select(hits->instance, (MASK)((int)hit.instance), alike);
      hits->ng = select3(hits->ng, all3(ng), alike);
    } else {
      FETCH_ROW(scene->triangles + hit.prim);  // for its normals
      MASK_LANE(hits->prim, i) = (int)hit.prim;
      MASK_LANE(hits->instance, i) = (int)hit.instance;
      set3(&hits->ng, i, ng);
    }
  }
}

// The nearest hits of the lanes of `active` in (t_min, t_max].
static inline void trace_batch(const Scene* scene, const TraceRays* rays, REAL t_max, REAL time, MASK active,
                               bool coherent) {
  find_hits(scene, rays, t_max, time, active, coherent ? TRACE_COHERENT : TRACE_NEAREST);
  finish_triangles(scene, coherent, rays->hits);
}

#if LISTS_HITS
// Sets the hits of the lanes of `active` in (t_min, t_max]: triangles that do not end a ray in its list;
// behind these, or instead: for rays to lights (without priorities) something opaque, or else the nearest
// solid; for others what they see, or a solid.
static inline void list_batch(const Scene* scene, const TraceRays* rays, REAL t_max, REAL time, MASK active) {
  for (u32 i = 0; i < BATCH; ++i) clear_list(rays->lists + i);
  find_hits(scene, rays, t_max, time, active, TRACE_NEAREST);
}

// The nearest hits behind t_min of the lanes of `lanes`; `listed` receives lanes whose hit comes from a list.
// Returns lanes that must be traced on from t_min: their lists end, or the solid behind these has been passed
// together with a face that it touches.
NEVER_INLINE MASK next_listed(const Scene* scene, const HitList* lists, const REAL* t_min, MASK lanes,
                              const Hits* last, Hits* hits, MASK* listed) {
  *hits = *last;
  MASK taken = NO_LANES, ended = lanes & hit_anything(last) & MASK_OF(last->t <= *t_min);
  EACH_LANE(i, lanes) {
    if (!lists[i].count) continue;
    Hit hit = get_hit(last, i);
    if (take_nearest(scene->blocks, lists + i, REAL_LANE(*t_min, i), &hit)) {
      MASK_LANE(taken, i) = -1;
      set_hit(hits, i, &hit);
    } else if (lists[i].full) {
      MASK_LANE(ended, i) = -1;
    }
  }
  ended &= ~taken;
  hits->instance |= ended | ~lanes;
  finish_triangles(scene, false, hits);
  *listed = taken;
  return ended;
}
#endif

// The lanes of `active` that hit anything in (t_min, t_max].
static inline MASK occluded_batch(const Scene* scene, const REAL3* o, const REAL3* d, const REAL* t_min,
                                  REAL t_max, REAL time, MASK active, bool coherent) {
  Hits hits;
  const TraceRays rays = {o, d, t_min, &hits, 0, 0};
  find_hits(scene, &rays, t_max, time, active, TRACE_ANY | (coherent ? TRACE_COHERENT : 0u));
  return active & hit_anything(&hits);
}
