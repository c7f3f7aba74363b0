// Eight triangles against one ray (Moeller and Trumbore 1997): no division before a hit, and tests against
// zero that are free of scale. The result does not depend on the order in which blocks are visited: equal t
// goes to the lower index.
#ifndef SUNDOG_LIB_TRIANGLES_CL
#define SUNDOG_LIB_TRIANGLES_CL
#include "lib/config.h"
#include "shared/bvh.h"

// Bit i of the result is lane i's sign bit.
static inline u32 lane_mask(int8 lanes) {
#if defined(__AVX__) && !defined(SUNDOG_PORTABLE)
  return (u32)__builtin_ia32_movmskps256(as_float8(lanes));
#else
  // One byte a lane keeps one bit; the product gathers the eight of them in its top byte.
  const ulong bits = as_ulong(convert_char8(lanes)) & 0x8040201008040201UL;
  return (u32)((bits * 0x0101010101010101UL) >> 56);
#endif
}

static inline u32 lowest_bit(u32 mask) { return 31u - clz(mask & (0u - mask)); }

// Takes triangle i of the block at t as the hit when it is nearer than *hit, or as near and earlier in the
// tables.
static inline void offer_triangle(__global const TriangleBlock* block, u32 i, float t, float u, float v,
                                  float t_min, u32 instance, Hit* hit) {
  const u32 prim = block->prim[i];
  const bool nearer =
      t < hit->t || (t == hit->t && (hit->instance == NO_INSTANCE || instance < hit->instance ||
                                     (instance == hit->instance && prim < hit->prim)));
  if (!(nearer && t > t_min)) return;
  hit->t = t;
  hit->u = u;
  hit->v = v;
  hit->prim = prim;
  hit->instance = instance;
  const float3 ng = cross((float3)(block->e1_x[i], block->e1_y[i], block->e1_z[i]),
                          (float3)(block->e2_x[i], block->e2_y[i], block->e2_z[i]));
  hit->ng_x = ng.x;
  hit->ng_y = ng.y;
  hit->ng_z = ng.z;
}

#if WIDE_VECTORS
// What the eight lanes have in common with the hit test: sign-corrected, not divided by |det|.
typedef struct BlockTest {
  float8 u, v, t, det;
  int8 hit;
} BlockTest;

static inline BlockTest test_block(__global const TriangleBlock* block, float3 o, float3 d, float t_min,
                                   float t_max) {
  const float8 e1_x = vload8(0, block->e1_x), e1_y = vload8(0, block->e1_y), e1_z = vload8(0, block->e1_z);
  const float8 e2_x = vload8(0, block->e2_x), e2_y = vload8(0, block->e2_y), e2_z = vload8(0, block->e2_z);
  const float8 s_x = o.x - vload8(0, block->v0_x), s_y = o.y - vload8(0, block->v0_y),
               s_z = o.z - vload8(0, block->v0_z);
  const float8 p_x = fma((float8)(d.y), e2_z, -(d.z * e2_y)), p_y = fma((float8)(d.z), e2_x, -(d.x * e2_z)),
               p_z = fma((float8)(d.x), e2_y, -(d.y * e2_x));
  const float8 det = fma(e1_x, p_x, fma(e1_y, p_y, e1_z * p_z));
  const int8 sign = as_int8(det) & (int)0x80000000;
  const float8 q_x = fma(s_y, e1_z, -(s_z * e1_y)), q_y = fma(s_z, e1_x, -(s_x * e1_z)),
               q_z = fma(s_x, e1_y, -(s_y * e1_x));
  BlockTest test;
  test.det = as_float8(as_int8(det) ^ sign);
  test.u = as_float8(as_int8(fma(s_x, p_x, fma(s_y, p_y, s_z * p_z))) ^ sign);
  test.v = as_float8(as_int8(fma((float8)(d.x), q_x, fma((float8)(d.y), q_y, d.z * q_z))) ^ sign);
  test.t = as_float8(as_int8(fma(e2_x, q_x, fma(e2_y, q_y, e2_z * q_z))) ^ sign);
  // The margin on t_max keeps every candidate that the exact comparison after the division would take.
  test.hit = (test.u >= 0.0f) & (test.v >= 0.0f) & (test.u + test.v <= test.det) & (test.det > 0.0f) &
             (test.t > t_min * test.det) & (test.t <= (t_max * 1.000001f) * test.det);
  return test;
}

// Nearest hit of the block in (t_min, hit->t]; updates *hit, whose instance is NO_INSTANCE before the first
// hit.
static inline void closest_in_block(__global const TriangleBlock* block, float3 o, float3 d, float t_min,
                                    u32 instance, Hit* hit) {
  const BlockTest test = test_block(block, o, d, t_min, hit->t);
  u32 lanes = lane_mask(test.hit);
  if (!lanes) return;
  float t[8], det[8], u[8], v[8];
  vstore8(test.t / test.det, 0, t);
  vstore8(test.det, 0, det);
  vstore8(test.u, 0, u);
  vstore8(test.v, 0, v);
  while (lanes) {
    const u32 i = lowest_bit(lanes);
    lanes &= lanes - 1u;
    offer_triangle(block, i, t[i], u[i] / det[i], v[i] / det[i], t_min, instance, hit);
  }
}
#else
static inline void closest_in_block(__global const TriangleBlock* block, float3 o, float3 d, float t_min,
                                    u32 instance, Hit* hit) {
#pragma unroll 1
  for (u32 i = 0; i < 8u && block->prim[i] != NO_PRIM; ++i) {
    const float3 e1 = (float3)(block->e1_x[i], block->e1_y[i], block->e1_z[i]);
    const float3 e2 = (float3)(block->e2_x[i], block->e2_y[i], block->e2_z[i]);
    const float3 s = o - (float3)(block->v0_x[i], block->v0_y[i], block->v0_z[i]);
    const float3 p =
        (float3)(fma(d.y, e2.z, -(d.z * e2.y)), fma(d.z, e2.x, -(d.x * e2.z)), fma(d.x, e2.y, -(d.y * e2.x)));
    const float3 q =
        (float3)(fma(s.y, e1.z, -(s.z * e1.y)), fma(s.z, e1.x, -(s.x * e1.z)), fma(s.x, e1.y, -(s.y * e1.x)));
    const float signed_det = fma(e1.x, p.x, fma(e1.y, p.y, e1.z * p.z));
    const float det = fabs(signed_det), sign = copysign(1.0f, signed_det);
    const float u = sign * fma(s.x, p.x, fma(s.y, p.y, s.z * p.z)),
                v = sign * fma(d.x, q.x, fma(d.y, q.y, d.z * q.z));
    const float t = sign * fma(e2.x, q.x, fma(e2.y, q.y, e2.z * q.z));
    if (u >= 0.0f && v >= 0.0f && u + v <= det && det > 0.0f)
      offer_triangle(block, i, t / det, u / det, v / det, t_min, instance, hit);
  }
}
#endif

#endif
