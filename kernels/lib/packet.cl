// Sixteen rays that run close together go through the two-level BVH as one: a node's eight children are
// tested at once against the interval that the rays span, and a child that survives against each ray. Where
// few rays are left, they go on alone. A ray's own tests are those of walk.cl to the bit, and so are the
// hits.
#ifndef SUNDOG_LIB_PACKET_CL
#define SUNDOG_LIB_PACKET_CL
#include "lib/config.h"
#if PACKETS
#include "lib/packet_rays.cl"
#include "lib/single.cl"
#include "lib/tables.h"
#include "lib/walk.cl"

// This many rays or fewer are faster alone: in a scene or a mesh; in a node of it; in a leaf when the nearest
// hit is wanted, or any.
#ifndef PACKET_LEAST
#define PACKET_LEAST 2
#endif
#ifndef NODE_LEAST
#define NODE_LEAST 1
#endif
#ifndef LEAF_LEAST
#define LEAF_LEAST 4
#endif
#ifndef ANY_LEAF_LEAST
#define ANY_LEAF_LEAST 8
#endif

// A child's box: node * 8 + slot, perhaps with ALL_CROSS: every ray crosses it.
#define ALL_CROSS 0x80000000u
#define NO_BOX 0xFFFFFFFFu
#define NO_NODE 0xFFFFFFFFu

// Boxes that wait, each below the bits of its entry distance; nearest last.
typedef struct PacketWalk {
  ulong waiting[BVH_STACK + 1];
  u32 top;
  u32 first;  // a node to begin with
} PacketWalk;

ALWAYS_INLINE int8 crossing_at(float8 planes, const Crossing* crossing, u32 axis) {
  return as_int8(fma(planes, (float8)(crossing->rcp[axis]), (float8)(crossing->shift[axis])));
}

// Returns the nearest child that the interval crosses, or NO_BOX, and puts the others onto the stack. With
// `any` the order is that of the slots: sorting would cost more than it saves.
ALWAYS_INLINE u32 open_node(__global const u32* restrict nodes, u32 index, const PacketRays* rays,
                            const PacketHits* hits, PacketWalk* walk, bool any) {
  __global const BvhNode* node = node_at(nodes, index);
  __global const float* bounds = node->lower_x;
  int8 near = (int8)(as_int(hits->t_least)), far = (int8)(as_int(hits->t_most));
  int8 last_in = near, first_out = far;
#pragma unroll
  for (u32 axis = 0; axis < 3u; ++axis) {
    const float8 b = vload8(0, bounds + rays->near[axis]), c = vload8(0, bounds + rays->far[axis]);
    near = max(near, crossing_at(b, &rays->first_in, axis));
    far = min(far, crossing_at(c, &rays->last_out, axis));
    last_in = max(last_in, crossing_at(b, &rays->last_in, axis));
    first_out = min(first_out, crossing_at(c, &rays->first_out, axis));
  }
  const u32 by_all = lane_mask(last_in <= first_out);
  u32 crossed = lane_mask(near <= far) & node->valid;
  if (!crossed) return NO_BOX;
  u32 slot = lowest_bit(crossed);
  crossed &= crossed - 1u;
  u32 nearest = (index * 8u + slot) | (by_all >> slot) << 31;
  if (!crossed) return nearest;
  float entry[8];
  vstore8(as_float8(near), 0, entry);
  ulong least = (ulong)as_uint(entry[slot]) << 32 | nearest;
  const u32 base = walk->top;
  while (crossed) {
    slot = lowest_bit(crossed);
    crossed &= crossed - 1u;
    ulong box = (ulong)as_uint(entry[slot]) << 32 | (index * 8u + slot) | (by_all >> slot) << 31;
    u32 to = walk->top++;
    const ulong nearer = any ? box : min(box, least);
    box = any ? least : max(box, least);
    least = nearer;
    if (!any) {
      while (to > base && walk->waiting[to - 1u] < box) {
        walk->waiting[to] = walk->waiting[to - 1u];
        --to;
      }
    }
    walk->waiting[to] = box;
  }
  return (u32)least;
}

// The entry or the exit distances of the slabs of one axis for each ray.
ALWAYS_INLINE int16 slab_distance(float bound, float16 rcp, float16 shift) {
  return as_int16(fma((float16)(bound), rcp, shift));
}

// The rays that cross the box of one child.
ALWAYS_INLINE u32 rays_in_child(__global const Bvh8Node* node, u32 slot, const PacketRays* rays,
                                const PacketHits* hits) {
  __global const float* bounds = node->lower_x + slot;
  int16 near = as_int16(hits->t_min), far = as_int16(hits->found->t);
#pragma unroll
  for (u32 axis = 0; axis < 3u; ++axis) {
    near = max(near, slab_distance(bounds[rays->near[axis]], rays->rcp_near[axis], rays->shift_near[axis]));
    far = min(far, slab_distance(bounds[rays->far[axis]], rays->rcp_far[axis], rays->shift_far[axis]));
  }
  return lane_bits(near <= far);
}

// Goes on to the next place where something is to be done: a leaf, or a node that few rays cross. Writes its
// word and the rays that cross it; returns false at the end.
NEVER_INLINE bool next_place(__global const u32* restrict nodes, const PacketRays* rays,
                             const PacketHits* hits, PacketWalk* walk, bool any, u32* word, u32* active) {
  u32 index = walk->first;
  walk->first = NO_NODE;
  while (true) {
    u32 box;
    if (index != NO_NODE) {
      box = open_node(nodes, index, rays, hits, walk, any);
      index = NO_NODE;
      if (box == NO_BOX) continue;
    } else {
      if (!walk->top) return false;
      const ulong next = walk->waiting[--walk->top];
      if (as_float((u32)(next >> 32)) > hits->t_most) continue;
      box = (u32)next;
    }
    __global const BvhNode* node = node_at(nodes, (box & ~ALL_CROSS) >> 3);
    const u32 crossing = box & ALL_CROSS ? hits->live : rays_in_child(node, box & 7u, rays, hits);
    if (!crossing) continue;
    *word = node->child[box & 7u];
    *active = crossing;
    if ((*word & BVH_LEAF) || popcount(crossing) <= NODE_LEAST) return true;
    index = *word;
  }
}

#if HAS_MESH
// The triangles of a block that some ray may hit: not those with all corners on one side of all rays.
ALWAYS_INLINE u32 triangles_in_packet(__global const TriangleBlock* block, const PacketRays* rays) {
  const u32 ax = rays->axis[0], ay = rays->axis[1], az = rays->axis[2];
  float8 least_x = (float8)(INFINITY), least_y = least_x, most_x = -least_x, most_y = -least_x;
#pragma unroll
  for (u32 corner = 0; corner < 3u; ++corner) {
    __global const float* v = block->v0_x + corner * 24u;
    const float8 dz = rays->beam_z - vload8(az, v), far = fabs(dz);
    const float8 x = fma(-(float8)(rays->beam_sx), dz, rays->beam_x - vload8(ax, v)),
                 y = fma(-(float8)(rays->beam_sy), dz, rays->beam_y - vload8(ay, v));
    const float8 wide_x = fma((float8)(rays->spread_sx), far, (float8)(rays->spread_x)),
                 wide_y = fma((float8)(rays->spread_sy), far, (float8)(rays->spread_y));
    least_x = least8(least_x, x - wide_x);
    most_x = greatest8(most_x, x + wide_x);
    least_y = least8(least_y, y - wide_y);
    most_y = greatest8(most_y, y + wide_y);
  }
  return lane_mask((least_x <= 0.0f) & (most_x >= 0.0f) & (least_y <= 0.0f) & (most_y >= 0.0f));
}

// The triangle at `place` against all rays. Returns whether it is a hit of any.
ALWAYS_INLINE bool packet_triangle(__global const TriangleBlock* blocks, u32 place, const PacketRays* rays,
                                   PacketHits* hits, u32 instance, bool any) {
  __global const float* corners = blocks[place >> 3].v0_x + (place & 7u);
  __global const float *vx = corners + rays->axis[0] * 8u, *vy = corners + rays->axis[1] * 8u,
                       *vz = corners + rays->axis[2] * 8u;
  const float16 ox = rays->o[rays->axis[0]], oy = rays->o[rays->axis[1]], oz = rays->o[rays->axis[2]];
  const float16 z0 = oz - vz[0], z1 = oz - vz[24], z2 = oz - vz[48];
  const float16 x0 = fma(-rays->sx, z0, ox - vx[0]), x1 = fma(-rays->sx, z1, ox - vx[24]),
                x2 = fma(-rays->sx, z2, ox - vx[48]);
  const float16 y0 = fma(-rays->sy, z0, oy - vy[0]), y1 = fma(-rays->sy, z1, oy - vy[24]),
                y2 = fma(-rays->sy, z2, oy - vy[48]);
  const float16 e0 = x2 * y1 - y2 * x1, e1 = x0 * y2 - y0 * x2, e2 = x1 * y0 - y1 * x0;
  const float16 a = select(e1, e0, e0 < e1), b = select(e1, e0, e0 > e1);
  int16 hit = (select(e2, a, a < e2) >= 0.0f) | (select(e2, b, b > e2) <= 0.0f);
  if (!lane_bits(hit)) return false;
  const float16 scale = 1.0f / (e0 + e1 + e2);
  const float16 w0 = e0 * scale, u = e1 * scale, v = e2 * scale;
  const float16 t = fma(w0, z0, fma(u, z1, v * z2)) * rays->sz;
  hit &= (t > hits->t_min) & (t <= hits->found->t);
  if (!lane_bits(hit)) return false;
  u32 ties = lane_bits(hit & (t == hits->found->t));
  while (ties) {
    const u32 i = lowest_bit(ties);
    ties &= ties - 1u;
    const Hit other = get_hit(hits->found, i);
    if (!wins_tie(blocks, instance, place, &other)) hit &= ~lanes_of(1u << i);
  }
  hits->found->t = select(hits->found->t, any ? (float16)(-1.0f) : t, hit);
  hits->found->u = select(hits->found->u, u, hit);
  hits->found->v = select(hits->found->v, v, hit);
  hits->found->prim = select(hits->found->prim, (int16)((int)place), hit);
  hits->found->instance = select(hits->found->instance, (int16)((int)instance), hit);
  return true;
}

// The rays of `active` by themselves, from `word` of the scene BVH or of `instance`'s mesh BVH on. Returns
// whether any hits something nearer.
NEVER_INLINE bool walk_lanes(TRACE_PARAMETERS, const PacketRays* rays, PacketHits* hits, u32 active, u32 word,
                             u32 instance, bool any) {
  const REAL3 o = real3(rays->o[0], rays->o[1], rays->o[2]), d = real3(rays->d[0], rays->d[1], rays->d[2]);
  const REAL before = hits->found->t;
  const WalkRays walkers = {&o, &d, &hits->t_min, hits->found};
  walk_rays(TRACE_ARGUMENTS, &walkers, active, word, instance, any);
  const MASK nearer = MASK_OF(hits->found->t < before);
  if (any) end_lanes(hits, lanes_of(active));
  return any_lane(nearer);
}

// The rays of `active` one after another through the blocks of a leaf. Returns whether any hits something
// nearer.
NEVER_INLINE bool lanes_in_blocks(__global const TriangleBlock* blocks, const PacketRays* rays,
                                  PacketHits* hits, u32 active, u32 first, u32 last, u32 instance, bool any) {
  const u32 ax = rays->axis[0], ay = rays->axis[1], az = rays->axis[2];
  bool nearer = false;
  for (; active; active &= active - 1u) {
    const u32 i = lowest_bit(active);
    const ShearRay ray = {ax * 8u,
                          ay * 8u,
                          az * 8u,
                          get_lane(rays->o + ax, i),
                          get_lane(rays->o + ay, i),
                          get_lane(rays->o + az, i),
                          get_lane(&rays->sx, i),
                          get_lane(&rays->sy, i),
                          get_lane(&rays->sz, i)};
    Hit hit;
    hit.t = get_lane(&hits->found->t, i);
    hit.instance = (u32)MASK_LANE(hits->found->instance, i);
    hit.prim = (u32)MASK_LANE(hits->found->prim, i);
    const u32 before = hit.prim, was = hit.instance;
    for (u32 index = first; index <= last; ++index)
      closest_in_block(blocks, index, &ray, get_lane(&hits->t_min, i), instance, &hit);
    if (hit.prim == before && hit.instance == was) continue;
    nearer = true;
    REAL_LANE(hits->found->t, i) = any ? -1.0f : hit.t;
    REAL_LANE(hits->found->u, i) = hit.u;
    REAL_LANE(hits->found->v, i) = hit.v;
    MASK_LANE(hits->found->prim, i) = (int)hit.prim;
    MASK_LANE(hits->found->instance, i) = (int)hit.instance;
  }
  return nearer;
}

NEVER_INLINE void packet_in_mesh(TRACE_PARAMETERS, const PacketRays* rays, PacketHits* hits, u32 root,
                                 u32 instance, bool any) {
  PacketWalk walk;
  walk.top = 0;
  walk.first = root;
  u32 word, active;
  while (next_place(nodes, rays, hits, &walk, any, &word, &active)) {
    bool hit = false;
    const u32 first = word & BVH_FIRST_MASK, last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
    if (!(word & BVH_LEAF)) {
      hit = walk_lanes(TRACE_ARGUMENTS, rays, hits, active, word, instance, any);
    } else if (popcount(active) <= (any ? ANY_LEAF_LEAST : LEAF_LEAST)) {
      hit = lanes_in_blocks(blocks, rays, hits, active, first, last, instance, any);
    } else {
      for (u32 index = first; index <= last; ++index)
        for (u32 bits = triangles_in_packet(blocks + index, rays); bits; bits &= bits - 1u)
          hit |= packet_triangle(blocks, index * 8u + lowest_bit(bits), rays, hits, instance, any);
    }
    if (hit) renew_bounds(hits);
  }
}

#endif

static inline void packet_in_solid(TRACE_PARAMETERS, const PacketRays* rays, PacketHits* hits, u32 active,
                                   u32 index, bool any) {
  const REAL3 o = real3(rays->o[0], rays->o[1], rays->o[2]), d = real3(rays->d[0], rays->d[1], rays->d[2]);
  hit_solid(instances, index, &o, &d, &hits->t_min, lanes_of(active), hits->found);
  if (any) end_lanes(hits, lanes_of(active));
}

// The rays of `active` against an instance; world space.
NEVER_INLINE void packet_in_instance(TRACE_PARAMETERS, const PacketRays* rays, PacketHits* hits, u32 active,
                                     u32 index, bool any) {
#if HAS_MESH
  __global const Instance* instance = instances + index;
  if (instance->shape == SHAPE_MESH) {
    if (popcount(active) <= PACKET_LEAST) {
      walk_lanes(TRACE_ARGUMENTS, rays, hits, active, BVH_LEAF | index, NO_INSTANCE, any);
      return;
    }
    if (instance->flags & INSTANCE_IDENTITY) {
      packet_in_mesh(TRACE_ARGUMENTS, rays, hits, instance->root, index, any);
      return;
    }
    PacketRays object;
    packet_in_object(instance, rays, active, &object);
    if (aim_packet(&object)) {
      const int16 lanes = lanes_of(active);
      const float16 t = hits->found->t;  // of the others, for afterwards
      hits->found->t = select((float16)(-1.0f), t, lanes);
      renew_bounds(hits);
      packet_in_mesh(TRACE_ARGUMENTS, &object, hits, instance->root, index, any);
      hits->found->t = select(t, hits->found->t, lanes);
    } else
      walk_lanes(TRACE_ARGUMENTS, rays, hits, active, BVH_LEAF | index, NO_INSTANCE, any);
    return;
  }
#endif
  packet_in_solid(TRACE_ARGUMENTS, rays, hits, active, index, any);
}

// The rays of `active` by themselves, from `word` of the scene BVH on.
static inline void bounded_alone(TRACE_PARAMETERS, const PacketRays* rays, PacketHits* hits, u32 active,
                                 u32 word, bool any) {
#if HAS_MESH
  walk_lanes(TRACE_ARGUMENTS, rays, hits, active, word, NO_INSTANCE, any);
#else
  for (u32 bits = active; bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    Hit hit = get_hit(hits->found, i);
    trace_bounded(TRACE_ARGUMENTS, word, packet_origin(rays, i), packet_direction(rays, i),
                  get_lane(&hits->t_min, i), any, &hit);
    set_hit(hits->found, i, &hit);
  }
  if (any) end_lanes(hits, lanes_of(active));
#endif
}

NEVER_INLINE void packet_in_leaf(TRACE_PARAMETERS, const PacketRays* rays, PacketHits* hits, u32 active,
                                 u32 word, bool any) {
  const u32 first = word & BVH_FIRST_MASK, last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
  for (u32 i = first; i <= last; ++i) {
    if (any) active &= ~lane_bits(as_int16(hits->found->t));  // these have found something
    if (active) packet_in_instance(TRACE_ARGUMENTS, rays, hits, active, i, any);
  }
  renew_bounds(hits);
}

// The bounded instances; `rays` in world space and aimed.
NEVER_INLINE void packet_in_scene(TRACE_PARAMETERS, const PacketRays* rays, PacketHits* hits, bool any) {
  const u32 live = ALL_RAYS & ~lane_bits(as_int16(hits->found->t)), root = info->tlas_root;
  if (info->bounded_count == 1u) {
    packet_in_instance(TRACE_ARGUMENTS, rays, hits, live, 0u, any);
  } else if (root & BVH_LEAF) {
    packet_in_leaf(TRACE_ARGUMENTS, rays, hits, live, root, any);
  } else {
    PacketWalk walk;
    walk.top = 0;
    walk.first = root;
    u32 word, active;
    while (next_place(nodes, rays, hits, &walk, any, &word, &active)) {
      if (word & BVH_LEAF)
        packet_in_leaf(TRACE_ARGUMENTS, rays, hits, active, word, any);
      else
        bounded_alone(TRACE_ARGUMENTS, rays, hits, active, word, any);
      renew_bounds(hits);
    }
  }
}

#endif

#endif
