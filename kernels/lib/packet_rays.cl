// Sixteen rays that run close together as a value: each by itself, a lane a ray, and the interval that they
// span. Nothing is found here; packet.cl takes them through the BVH.
#ifndef SUNDOG_LIB_PACKET_RAYS_CL
#define SUNDOG_LIB_PACKET_RAYS_CL
#include "lib/config.h"
#include "lib/hits.cl"
#include "lib/nodes.cl"
#include "lib/transform.cl"
#include "lib/triangles.cl"

#if PACKETS
#define ALL_RAYS 0xFFFFu

// The rays in world or object space; arrays are by axis.
typedef struct PacketRays {
  float16 o[3], d[3];
  // SlabRay and ShearRay, a lane a ray.
  float16 rcp_near[3], rcp_far[3], shift_near[3], shift_far[3], sx, sy, sz;
  // The interval: the least and the greatest reciprocal of an axis, each with the origin on the safe side.
  float near_rcp[3][2], near_shift[3][2], far_rcp[3][2], far_shift[3][2];
  // The least and the greatest of: the origins, by axis; the slopes sx and sy.
  float origin[3][2], slope_x[2], slope_y[2];
  u32 one_origin;  // all rays start at the same point
  // What all rays share: float offsets into Bvh8Node, and the axes that a ShearRay permutes to x, y, z.
  u32 near[3], far[3], axis[3];
} PacketRays;

// What the rays found so far. A lane without a ray, and with `any` one that has found something, has a t
// below 0: it crosses nothing.
typedef struct PacketHits {
  Hits found;  // prim of a triangle is its place (see finish_triangle)
  float16 t_min;
  float t_least, t_most;  // of t_min and t over the rays
} PacketHits;

static inline float get_lane(const float16* v, u32 i) { return ((const float*)v)[i]; }

static inline float least_of(float16 v) {
  const float8 a = least8(v.lo, v.hi);
  const float4 b = select(a.hi, a.lo, a.lo < a.hi);
  const float2 c = select(b.hi, b.lo, b.lo < b.hi);
  return c.x < c.y ? c.x : c.y;
}
static inline float most_of(float16 v) { return -least_of(-v); }

static inline float16 safe_reciprocal16(float16 d) {
  const float16 tiny = as_float16((as_int16(d) & (int)0x80000000) | as_int(1e-18f));
  return 1.0f / select(d, tiny, fabs(d) < 1e-18f);
}

// One axis of aim_packet.
static inline bool aim_axis(PacketRays* rays, u32 axis) {
  const float16 o = rays->o[axis], rcp = safe_reciprocal16(rays->d[axis]);
  const u32 signs = lane_bits(as_int16(rcp));
  if (signs != 0u && signs != ALL_RAYS) return false;
  rays->near[axis] = axis * 8u + (signs ? 24u : 0u);
  rays->far[axis] = axis * 8u + (signs ? 0u : 24u);
  const float16 rcp_near = rcp * 0.9999997f, rcp_far = rcp * 1.0000003f;
  const float16 near = o * rcp_near, far = o * rcp_far;
  rays->rcp_near[axis] = rcp_near;
  rays->rcp_far[axis] = rcp_far;
  rays->shift_near[axis] = -(near + fabs(near) * 2.4e-7f);
  rays->shift_far[axis] = -(far - fabs(far) * 2.4e-7f);
  // (b - o) / d is least where b - o is least, for d > 0 that is the greatest o, and with either end of 1 /
  // d.
  const float low = least_of(o), high = most_of(o);
  rays->origin[axis][0] = low;
  rays->origin[axis][1] = high;
  const float ends[2] = {least_of(rcp), most_of(rcp)};
  for (u32 end = 0; end < 2u; ++end) {
    const float r_near = ends[end] * 0.9999994f, r_far = ends[end] * 1.0000006f;
    const float o_near = (signs ? low : high) * r_near, o_far = (signs ? high : low) * r_far;
    rays->near_rcp[axis][end] = r_near;
    rays->near_shift[axis][end] = -(o_near + fabs(o_near) * 4.8e-7f);
    rays->far_rcp[axis][end] = r_far;
    rays->far_shift[axis][end] = -(o_far - fabs(o_far) * 4.8e-7f);
  }
  return true;
}

// Prepares the rays for the tests, given o and d. Returns false when they cannot go as one: directions of
// different signs or of different largest components.
NEVER_INLINE bool aim_packet(PacketRays* rays) {
  const float16 x = fabs(rays->d[0]), y = fabs(rays->d[1]), z = fabs(rays->d[2]);
  const int16 along_x = (x >= y) & (x >= z);
  const u32 xs = lane_bits(along_x), ys = lane_bits(~along_x & (y >= z));
  if ((xs != 0u && xs != ALL_RAYS) || (ys != 0u && ys != ALL_RAYS)) return false;
  for (u32 axis = 0; axis < 3u; ++axis)
    if (!aim_axis(rays, axis)) return false;
  rays->axis[2] = xs ? 0u : ys ? 1u : 2u;
  rays->axis[0] = xs ? 1u : ys ? 2u : 0u;
  rays->axis[1] = xs ? 2u : ys ? 0u : 1u;
  const float16 along = 1.0f / rays->d[rays->axis[2]];
  rays->sx = rays->d[rays->axis[0]] * along;
  rays->sy = rays->d[rays->axis[1]] * along;
  rays->sz = -along;
  rays->slope_x[0] = least_of(rays->sx);
  rays->slope_x[1] = most_of(rays->sx);
  rays->slope_y[0] = least_of(rays->sy);
  rays->slope_y[1] = most_of(rays->sy);
  rays->one_origin = rays->origin[0][0] == rays->origin[0][1] && rays->origin[1][0] == rays->origin[1][1] &&
                     rays->origin[2][0] == rays->origin[2][1];
  return true;
}

// The rays as an instance sees them. A ray that is not in `active` becomes one that is.
NEVER_INLINE void packet_in_object(__global const Instance* instance, const PacketRays* world, u32 active,
                                   PacketRays* object) {
  const u32 stand_in = lowest_bit(active);
  const int16 lanes = lanes_of(active);
  float16 o[3], d[3];
  for (u32 axis = 0; axis < 3u; ++axis) {
    o[axis] = select((float16)(get_lane(&world->o[axis], stand_in)), world->o[axis], lanes);
    d[axis] = select((float16)(get_lane(&world->d[axis], stand_in)), world->d[axis], lanes);
  }
  for (u32 axis = 0; axis < 3u; ++axis) {
    const float4 row = instance->object_from_world[axis];
    object->o[axis] = fma((float16)(row.x), o[0],
                          fma((float16)(row.y), o[1], fma((float16)(row.z), o[2], (float16)(row.w))));
    object->d[axis] = fma((float16)(row.x), d[0], fma((float16)(row.y), d[1], (float16)(row.z) * d[2]));
  }
}

static inline float3 packet_origin(const PacketRays* rays, u32 i) {
  return (float3)(get_lane(rays->o, i), get_lane(rays->o + 1, i), get_lane(rays->o + 2, i));
}
static inline float3 packet_direction(const PacketRays* rays, u32 i) {
  return (float3)(get_lane(rays->d, i), get_lane(rays->d + 1, i), get_lane(rays->d + 2, i));
}

// Lanes that have found something are switched off.
static inline void end_lanes(PacketHits* hits, MASK lanes) {
  hits->found.t = select(hits->found.t, (REAL)(-1.0f), lanes & hit_anything(&hits->found));
}

#endif

#endif
