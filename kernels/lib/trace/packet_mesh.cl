// Packets of rays in a mesh. Tests and hits equal those of triangles.cl to the bit.
#pragma once
#include "lib/core/config.h"
#if PACKETS
#include "lib/core/tables.h"
#include "lib/trace/packet_alone.cl"
#include "lib/trace/packet_nodes.cl"

// This few rays in a leaf are tested singly, for nearest hits and for any hits.
#ifndef LEAF_LEAST
#define LEAF_LEAST 4
#endif
#ifndef ANY_LEAF_LEAST
#define ANY_LEAF_LEAST 8
#endif

// The triangles of a block that some ray may hit: excludes those with all corners on one side of all rays.
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

EDGE_FUNCTION(edge_function16, float16)

// Tests the triangle at `place` against all rays. Returns whether any hits it.
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
  const float16 e0 = edge_function16(x2, y2, x1, y1), e1 = edge_function16(x0, y0, x2, y2),
                e2 = edge_function16(x1, y1, x0, y0);
  const float16 a = select(e1, e0, e0 < e1), b = select(e1, e0, e0 > e1);
  int16 hit = (select(e2, a, a < e2) >= 0.0f) | (select(e2, b, b > e2) <= 0.0f);
  if (!lane_bits(hit)) return false;
  const float16 det = e0 + e1 + e2, size = fabs(det);
  const float16 scaled_t = fma(e0, z0, fma(e1, z1, e2 * z2)) * rays->sz;
  const float16 signed_t = as_float16(as_int16(scaled_t) ^ (as_int16(det) ^ as_int16(size)));
  hit &= (signed_t > (hits->t_min * (1.0f - RANGE_SLACK)) * size) &
         (signed_t <= (hits->found->t * (1.0f + RANGE_SLACK)) * size);
  if (!lane_bits(hit)) return false;
  const float16 scale = 1.0f / det;
  const float16 u = e1 * scale, v = e2 * scale, t = scaled_t * scale;
  hit &= (t > hits->t_min) & (t <= hits->found->t) & (t < INFINITY);
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

// Tests the rays of `active` singly against the blocks of a leaf. Returns whether any hits something nearer.
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

NEVER_INLINE void packet_in_mesh(const Scene* scene, const PacketRays* rays, PacketHits* hits, u32 root,
                                 u32 instance, bool any) {
  PacketWalk walk;
  walk.top = 0;
  walk.first = root;
  u32 word, active;
  while (next_place(scene->nodes, rays, hits, &walk, any, &word, &active)) {
    bool hit = false;
    const u32 first = word & BVH_FIRST_MASK, last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
    if (!(word & BVH_LEAF)) {
      hit = walk_lanes(scene, rays, hits, active, word, instance, any);
    } else if (popcount(active) <= (any ? ANY_LEAF_LEAST : LEAF_LEAST)) {
      hit = lanes_in_blocks(scene->blocks, rays, hits, active, first, last, instance, any);
    } else {
      for (u32 index = first; index <= last; ++index)
        for (u32 bits = triangles_in_packet(scene->blocks + index, rays); bits; bits &= bits - 1u)
          hit |= packet_triangle(scene->blocks, index * 8u + lowest_bit(bits), rays, hits, instance, any);
    }
    if (hit) renew_bounds(hits);
  }
}

#endif
