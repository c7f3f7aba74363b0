// The narrow interface of the tracer that shading sees. In: a batch of rays, a ray a lane, and the tables.
// Out: the nearest hits, or whether there are any. What is found does not depend on the order of visits, nor
// on whether a ray goes alone.
#ifndef SUNDOG_LIB_TRAVERSE_CL
#define SUNDOG_LIB_TRAVERSE_CL
#include "lib/core/config.h"
#include "lib/core/tables.h"
#include "lib/trace/hits.cl"
#include "lib/trace/packet.cl"
#include "lib/trace/single.cl"
#include "lib/trace/walk.cl"

// Where there are no meshes, up to so many solids are tried one after another for all rays of a batch, which
// is quicker than taking each ray through the BVH. A packet goes through the BVH whenever there is one.
#ifndef FEW_SOLIDS
#define FEW_SOLIDS 24u
#endif

// Not by products with 0: some compilers take those for 0.
static inline MASK finite3(const REAL3* a) {
  return MASK_OF(fabs(a->x) < INFINITY) & MASK_OF(fabs(a->y) < INFINITY) & MASK_OF(fabs(a->z) < INFINITY);
}
// Rays that can hit something: a ray with a component that is not finite, or without a direction, hits
// nothing.
static inline MASK traceable(const REAL3* o, const REAL3* d, REAL t_min, REAL t_max) {
  return finite3(o) & finite3(d) & MASK_OF(t_max > t_min) &
         (MASK_OF(d->x != 0.0f) | MASK_OF(d->y != 0.0f) | MASK_OF(d->z != 0.0f));
}

#if PACKETS
// Rays become a packet; a lane that is not active stands in as a copy of another and is switched off. Returns
// false when the rays do not go as one.
NEVER_INLINE bool make_packet(const REAL3* o, const REAL3* d, const REAL* t_min, MASK active, Hits* hits,
                              PacketRays* rays, PacketHits* packet) {
  const u32 stand_in = lowest_bit(lane_bits(active));
  const REAL3 oo = select3(all3(get3(o, stand_in)), *o, active),
              dd = select3(all3(get3(d, stand_in)), *d, active);
  rays->o[0] = oo.x, rays->o[1] = oo.y, rays->o[2] = oo.z;
  rays->d[0] = dd.x, rays->d[1] = dd.y, rays->d[2] = dd.z;
  if (!aim_packet(rays)) return false;
  packet->found = hits;
  hits->t = select((REAL)(-1.0f), hits->t, active);
  packet->t_min = select((REAL)(REAL_LANE(*t_min, stand_in)), *t_min, active);
  packet->t_least = least_of(packet->t_min);
  renew_bounds(packet);
  return true;
}
#endif

#if HAS_BVH
// The bounded instances for the lanes of `active`.
static inline void trace_bounded_batch(const Scene* scene, const REAL3* world_o, const REAL3* world_d,
                                       const REAL* t_min, MASK active, bool coherent, bool any, Hits* hits) {
  REAL3 o = *world_o, d = *world_d;
  // A mesh alone needs no scene BVH, and takes all rays into its space at once.
  const bool lone_mesh =
      HAS_MESH && scene->info->bounded_count == 1u && scene->instances->shape == SHAPE_MESH;
  if (WIDE_VECTORS && lone_mesh && !(scene->instances->flags & INSTANCE_IDENTITY)) {
    o = object_points(scene->instances, o);
    d = object_vectors(scene->instances, d);
  }
#if PACKETS
  PacketRays rays;
  PacketHits packet;
  const REAL t = hits->t;
  if (coherent && lane_count(active) > PACKET_LEAST &&
      make_packet(&o, &d, t_min, active, hits, &rays, &packet)) {
#if HAS_MESH
    if (lone_mesh)
      packet_in_mesh(scene, &rays, &packet, scene->instances->root, 0u, any);
    else
#endif
      packet_in_scene(scene, &rays, &packet, any);
    hits->t = select(t, hits->t, active);
    return;
  }
#endif
#if WALKS_IN_TURN
  const WalkRays walkers = {&o, &d, t_min, hits};
  const u32 bits = lane_bits(active);
  if (lone_mesh)
    walk_rays(scene, &walkers, bits, scene->instances->root, 0u, any);
  else
    walk_rays(scene, &walkers, bits, scene->info->bounded_count == 1u ? BVH_LEAF : scene->info->tlas_root,
              NO_INSTANCE, any);
#else
  for (u32 bits = lane_bits(active); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    Hit hit = get_hit(hits, i);
    trace_instances(scene, get3(&o, i), get3(&d, i), REAL_LANE(*t_min, i), any, &hit);
    set_hit(hits, i, &hit);
  }
#endif
}
#endif

// The nearest hits of the lanes of `active` in (t_min, t_max], or with `any` some hits. `coherent`: the rays
// run close together.
static inline void find_hits(const Scene* scene, const REAL3* o, const REAL3* d, const REAL* t_min,
                             REAL t_max, MASK active, bool coherent, bool any, Hits* hits) {
  *hits = no_hits(t_max);
#if HAS_TRACED
  active &= traceable(o, d, *t_min, t_max);
#if !HAS_BVH
  const bool in_tree = false;
#elif HAS_MESH
  const bool in_tree = scene->info->bounded_count > 0u;
#elif PACKETS
  const bool in_tree = coherent || scene->info->bounded_count > FEW_SOLIDS;
#else
  const bool in_tree = scene->info->bounded_count > FEW_SOLIDS;
#endif
#if HAS_SOLID
  const u32 first = in_tree ? scene->info->bounded_count : 0u;
  if (first < scene->info->instance_count)
    hit_solids(scene->instances, first, scene->info->instance_count, o, d, t_min, active, any, hits);
#endif
#if HAS_BVH
  if (any) active &= ~hit_anything(hits);
  if (in_tree && any_lane(active)) trace_bounded_batch(scene, o, d, t_min, active, coherent, any, hits);
#endif
#endif
}

// Indices and geometric normals of the triangles among the hits. `coherent`: several rays meet the same one.
static inline void finish_triangles(const Scene* scene, bool coherent, Hits* hits) {
#if HAS_MESH
  const MASK places = hits->prim;
  u32 bits = lane_bits(hit_anything(hits));
  while (bits) {
    const u32 i = lowest_bit(bits);
    bits &= bits - 1u;
    const int instance = MASK_LANE(hits->instance, i), place = MASK_LANE(places, i);
#if HAS_SOLID
    if (scene->instances[instance].shape != SHAPE_MESH) continue;
#endif
    Hit hit;
    hit.prim = (u32)place;
    finish_triangle(scene->blocks, &hit);
    const float3 ng = (float3)(hit.ng_x, hit.ng_y, hit.ng_z);
    if (coherent) {
      const MASK alike = MASK_OF(places == place) & MASK_OF(hits->instance == instance);
      bits &= ~lane_bits(alike);
      hits->prim = select(hits->prim, (MASK)((int)hit.prim), alike);
      hits->ng = select3(hits->ng, all3(ng), alike);
    } else {
      MASK_LANE(hits->prim, i) = (int)hit.prim;
      set3(&hits->ng, i, ng);
    }
  }
#endif
}

// The nearest hits of the lanes of `active` in (t_min, t_max].
static inline void trace_batch(const Scene* scene, const REAL3* o, const REAL3* d, const REAL* t_min,
                               REAL t_max, MASK active, bool coherent, Hits* hits) {
  find_hits(scene, o, d, t_min, t_max, active, coherent, false, hits);
  finish_triangles(scene, coherent, hits);
}

// The lanes of `active` that hit anything in (t_min, t_max].
static inline MASK occluded_batch(const Scene* scene, const REAL3* o, const REAL3* d, const REAL* t_min,
                                  REAL t_max, MASK active, bool coherent) {
  Hits hits;
  find_hits(scene, o, d, t_min, t_max, active, coherent, true, &hits);
  return active & hit_anything(&hits);
}

#endif
