// Sixteen coherent rays as a value: one per lane, and their common interval. packet.cl traces them.
#pragma once
#include "lib/core/config.h"
#include "lib/core/transform.cl"
#include "lib/trace/hits.cl"
#include "lib/trace/nodes.cl"
#include "lib/trace/triangles.cl"

#if PACKETS
#define ALL_RAYS 0xFFFFu

// The plane at b across an axis is at fma(b, rcp, shift).
typedef struct Crossing {
  float rcp[4], shift[4];
} Crossing;

// The rays in world or object space; arrays are indexed by axis.
typedef struct PacketRays {
  float16 o[3], d[3];
  // SlabRay and ShearRay, one ray per lane.
  float16 rcp_near[3], rcp_far[3], shift_near[3], shift_far[3], sx, sy, sz;
  // Interval: first entry and last exit of any ray, last entry and first exit.
  Crossing first_in, last_out, last_in, first_out;
  // A beam around all rays, in ShearRay axes: its centre at beam_z, its slopes, and its half widths. See
  // triangles_in_packet.
  float beam_x, beam_y, beam_z, beam_sx, beam_sy, spread_x, spread_y, spread_sx, spread_sy;
  // Shared by all rays: float offsets into Bvh8Node, and the axes that a ShearRay permutes to x, y, z.
  u32 near[4], far[4], axis[3];
} PacketRays;

// The rays' hits. A lane without a ray, or with a hit if any hit will do, has a negative t: it crosses
// nothing.
typedef struct PacketHits {
  Hits* found;  // prim of a triangle is its place (finish_triangle)
  float16 t_min;
  float t_least, t_most;  // minimum of t_min and maximum of t
  u32 live;               // rays whose t is not negative
} PacketHits;

static inline float get_lane(const float16* v, u32 i) { return ((const float*)v)[i]; }

static inline float least_of(float16 v) {
  const float8 a = least8(v.lo, v.hi);
  const float4 b = select(a.hi, a.lo, a.lo < a.hi);
  const float2 c = select(b.hi, b.lo, b.lo < b.hi);
  return c.x < c.y ? c.x : c.y;
}
static inline float most_of(float16 v) { return -least_of(-v); }

// Updates the common bounds after hits.
static inline void renew_bounds(PacketHits* hits) {
  hits->t_most = most_of(hits->found->t);
  hits->live = ~lane_bits(as_int16(hits->found->t)) & ALL_RAYS;
}

static inline float16 least16(float16 a, float16 b) { return select(b, a, a < b); }

// Lower half: minima of neighbours in a; upper half: those in b.
ALWAYS_INLINE float16 least_of_pairs(float16 a, float16 b) {
  return least16((float16)(a.even, b.even), (float16)(a.odd, b.odd));
}

// Lane i of the result is the minimum of v[i]. Overwrites v.
ALWAYS_INLINE float16 least_of_each(float16* v) {
#pragma unroll
  for (u32 count = 8; count > 0u; count >>= 1)
#pragma unroll
    for (u32 i = 0; i < count; ++i) v[i] = least_of_pairs(v[2u * i], v[2u * i + 1u]);
  return v[0];
}
ALWAYS_INLINE float4 least_of_four(float16 a, float16 b, float16 c, float16 d) {
  const float16 all = least_of_pairs(least_of_pairs(a, b), least_of_pairs(c, d));
  const float8 pairs = least8(all.even, all.odd);
  return select(pairs.odd, pairs.even, pairs.even < pairs.odd);
}

ALWAYS_INLINE void set_crossing(Crossing* crossing, float4 rcp, float4 shift) {
  vstore4(rcp, 0, crossing->rcp);
  vstore4(shift, 0, crossing->shift);
}

// The rays' common interval, from minimum and maximum origins and reciprocals of directions. The earliest
// entry is by the farthest origin and the smallest reciprocal; this is wrong for planes behind the origin,
// but no ray starts before 0.
ALWAYS_INLINE void span_packet(PacketRays* rays, float4 least_o, float4 most_o, float4 least_rcp,
                               float4 most_rcp, int4 negative) {
  const int4 lower = (int4)(0, 8, 16, 0), upper = lower + 24;
  vstore4(as_uint4(select(lower, upper, negative)), 0, rays->near);
  vstore4(as_uint4(select(upper, lower, negative)), 0, rays->far);
  const float4 ahead = select(most_o, least_o, negative), behind = select(least_o, most_o, negative);
  const float4 small = select(least_rcp, most_rcp, negative), large = select(most_rcp, least_rcp, negative);
  const float4 first = small * 0.9999994f, last = large * 1.0000006f;
  const float4 in = ahead * first, out = behind * last, slack = along_face(large);
  set_crossing(&rays->first_in, first, -(in + fma(fabs(in), (float4)(4.8e-7f), slack)));
  set_crossing(&rays->last_out, last, -(out - fma(fabs(out), (float4)(4.8e-7f), slack)));
  set_crossing(&rays->last_in, large, -behind * large);
  set_crossing(&rays->first_out, small, -ahead * small);
}

// Computes the beam; `slopes` are minima of sx and sy and of their negatives. Widened by more than rounding
// moves a corner in packet_triangle, relative to its distance from the rays' origin.
ALWAYS_INLINE void make_beam(PacketRays* rays, float4 slopes, float4 o_spread) {
  const u32 ax = rays->axis[0], ay = rays->axis[1], az = rays->axis[2];
  const float z = get_lane(rays->o + az, 0);
  float2 least = (float2)(get_lane(rays->o + ax, 0), get_lane(rays->o + ay, 0)), most = least;
  const float apart = max(max(o_spread.x, o_spread.y), o_spread.z);
  if (apart > 0.0f) {
    const float16 dz = z - rays->o[az];
    const float16 x = fma(rays->sx, dz, rays->o[ax]), y = fma(rays->sy, dz, rays->o[ay]);
    const float4 ends = least_of_four(x, y, -x, -y);
    least = ends.xy;
    most = -ends.zw;
  }
  const float2 middle = 0.5f * (least + most), wide = 0.5f * (most - least) + 1e-6f * (fabs(middle) + apart);
  const float2 slope = 0.5f * (slopes.xy - slopes.zw), turn = -0.5f * (slopes.xy + slopes.zw) + 1e-6f;
  rays->beam_x = middle.x;
  rays->beam_y = middle.y;
  rays->beam_z = z;
  rays->beam_sx = slope.x;
  rays->beam_sy = slope.y;
  rays->spread_x = wide.x;
  rays->spread_y = wide.y;
  rays->spread_sx = turn.x;
  rays->spread_sy = turn.y;
}

// Prepares the rays for triangle tests, except the beam, whose slopes go to `ends`. Returns false if the
// largest components of their directions differ.
ALWAYS_INLINE bool shear_packet(PacketRays* rays, float16* ends) {
  const float16 x = fabs(rays->d[0]), y = fabs(rays->d[1]), z = fabs(rays->d[2]);
  const int16 along_x = (x >= y) & (x >= z);
  const u32 xs = lane_bits(along_x), ys = lane_bits(~along_x & (y >= z));
  if ((xs != 0u && xs != ALL_RAYS) || (ys != 0u && ys != ALL_RAYS)) return false;
  rays->axis[2] = xs ? 0u : ys ? 1u : 2u;
  rays->axis[0] = xs ? 1u : ys ? 2u : 0u;
  rays->axis[1] = xs ? 2u : ys ? 0u : 1u;
  const float16 along = 1.0f / rays->d[rays->axis[2]];
  rays->sx = rays->d[rays->axis[0]] * along;
  rays->sy = rays->d[rays->axis[1]] * along;
  rays->sz = -along;
  ends[3] = rays->sx;
  ends[7] = -rays->sx;
  ends[11] = rays->sy;
  ends[15] = -rays->sy;
  return true;
}

// Prepares the rays, given o and d. Returns false if they cannot form a packet: directions of different signs
// or, with triangles, of different largest components.
NEVER_INLINE bool aim_packet(PacketRays* rays) {
  float16 ends[16];
  ends[3] = ends[7] = ends[11] = ends[15] = (float16)(0.0f);
  if (HAS_MESH && !shear_packet(rays, ends)) return false;
#pragma unroll
  for (u32 axis = 0; axis < 3u; ++axis) {
    const float16 o = rays->o[axis];
    const float16 rcp = aim_slabs(o, rays->d[axis], &rays->rcp_near[axis], &rays->rcp_far[axis],
                                  &rays->shift_near[axis], &rays->shift_far[axis]);
    ends[axis] = o;
    ends[4u + axis] = -o;
    ends[8u + axis] = rcp;
    ends[12u + axis] = -rcp;
  }
  const float16 least = least_of_each(ends);
  const float4 least_rcp = least.s89ab, most_rcp = -least.scdef;
  const int4 negative = most_rcp < 0.0f, apart = ~negative & (least_rcp <= 0.0f);
  if (apart.x | apart.y | apart.z) return false;
  span_packet(rays, least.s0123, -least.s4567, least_rcp, most_rcp, negative);
  if (HAS_MESH) make_beam(rays, least.s3b7f, -least.s4567 - least.s0123);
  return true;
}

// Transforms the rays to an instance's space. Rays not in `active` become copies of one that is.
NEVER_INLINE void packet_in_object(const Scene* scene, u32 index, const PacketRays* world, const Hits* hits,
                                   u32 active, PacketRays* object) {
  __global const Instance* instance = scene->instances + index;
  const u32 stand_in = lowest_bit(active);
  const int16 lanes = lanes_of(active);
  float16 o[3], d[3];
  const REAL3 still = still_origins(hits, index, real3(world->o[0], world->o[1], world->o[2]));
  const REAL3 way = still_directions(hits, index, real3(world->d[0], world->d[1], world->d[2]));
  const REAL origins[3] = {still.x, still.y, still.z}, directions[3] = {way.x, way.y, way.z};
  for (u32 axis = 0; axis < 3u; ++axis) {
    o[axis] = select((float16)(get_lane(&origins[axis], stand_in)), origins[axis], lanes);
    d[axis] = select((float16)(get_lane(&directions[axis], stand_in)), directions[axis], lanes);
  }
  for (u32 axis = 0; axis < 3u; ++axis) {
    const float4 row = instance->object_from_world[axis];
    object->o[axis] = fma((float16)(row.x), o[0],
                          fma((float16)(row.y), o[1], fma((float16)(row.z), o[2], (float16)(row.w))));
    object->d[axis] = fma((float16)(row.x), d[0], fma((float16)(row.y), d[1], (float16)(row.z) * d[2]));
  }
}

// Switches off lanes with a hit.
static inline void end_lanes(PacketHits* hits, MASK lanes) {
  hits->found->t = select(hits->found->t, (REAL)(-1.0f), lanes & hit_anything(hits->found));
}

#endif
