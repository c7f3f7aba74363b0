// Tests eight triangles against one ray, watertight (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle
// Intersection"): corners are transformed to a space where the ray is the z axis, and edge functions have
// exact signs there, so neighbours agree on each edge: a ray cannot pass between them, nor hit a triangle
// seen edge-on from beside it. The result does not depend on the order of blocks: at equal t, the lower index
// wins.
#pragma once
#include "lib/core/config.h"
#include "lib/core/masks.cl"
#include "shared/bvh.h"

// A ray prepared for the test: axes permuted so that the direction is largest along z.
typedef struct ShearRay {
  u32 x, y, z;       // float offsets of the permuted axes in a corner of a TriangleBlock
  float ox, oy, oz;  // origin, permuted
  float sx, sy;      // slopes of the direction: x/z, y/z
  float sz;          // -1 / direction z
} ShearRay;

static inline ShearRay make_shear_ray(float3 o, float3 d) {
  const float3 size = fabs(d);
  const int3 along_x = (int3)(-(size.x >= size.y && size.x >= size.z)),
             along_y = (int3)(-(size.x < size.y && size.y >= size.z));
  const float3 dd = select(select(d, d.zxy, along_y), d.yzx, along_x),
               oo = select(select(o, o.zxy, along_y), o.yzx, along_x);
  ShearRay ray;
  ray.z = along_x.x ? 0u : along_y.x ? 8u : 16u;
  ray.x = along_x.x ? 8u : along_y.x ? 16u : 0u;
  ray.y = 24u - ray.x - ray.z;
  ray.ox = oo.x;
  ray.oy = oo.y;
  ray.oz = oo.z;
  const float along = 1.0f / dd.z;
  ray.sx = dd.x * along;
  ray.sy = dd.y * along;
  ray.sz = -along;
  return ray;
}

// The instance that owns the triangle `prim` among those sharing a BVH, of which `first` is the first.
static inline u32 instance_of_triangle(__global const Instance* restrict instances, u32 first, u32 prim) {
  while ((instances[first].flags & INSTANCE_SHARES) && instances[first + 1u].first_prim <= prim) ++first;
  return first;
}

// Sets the geometric normal, triangle index and instance of a hit whose prim is still `block * 8 + lane`, and
// whose instance is the first of those that share the BVH.
static inline void finish_triangle(__global const Instance* restrict instances,
                                   __global const TriangleBlock* restrict blocks, Hit* hit) {
  __global const TriangleBlock* block = blocks + (hit->prim >> 3);
  const u32 i = hit->prim & 7u;
  const float3 v0 = (float3)(block->v0_x[i], block->v0_y[i], block->v0_z[i]);
  const float3 e1 = (float3)(block->v1_x[i], block->v1_y[i], block->v1_z[i]) - v0;
  const float3 e2 = (float3)(block->v2_x[i], block->v2_y[i], block->v2_z[i]) - v0;
  const float3 ng = cross(e1, e2);
  hit->prim = block->prim[i];
  hit->instance = instance_of_triangle(instances, hit->instance, hit->prim);
  hit->ng_x = ng.x;
  hit->ng_y = ng.y;
  hit->ng_z = ng.z;
}

// Whether a triangle at the same t as *hit takes precedence.
static inline bool wins_tie(__global const TriangleBlock* restrict blocks, u32 instance, u32 place,
                            const Hit* hit) {
  if (instance != hit->instance) return instance < hit->instance;  // NO_INSTANCE is the greatest
  return blocks[place >> 3].prim[place & 7u] < blocks[hit->prim >> 3].prim[hit->prim & 7u];
}

// Accepts the triangle at `place` if it is nearer than *hit, or as near and earlier in the tables.
ALWAYS_INLINE void offer_triangle(__global const TriangleBlock* blocks, u32 place, float t, float u, float v,
                                  u32 instance, Hit* hit) {
  if (t > hit->t || (t == hit->t && !wins_tie(blocks, instance, place, hit))) return;
  hit->t = t;
  hit->u = u;
  hit->v = v;
  hit->prim = place;
  hit->instance = instance;
}

// No division before a hit: t is `scaled_t` over the determinant, and products test whether it lies in
// (t_min, t_max], where 0 <= t_min. Their bounds are wider by this fraction, which exceeds the rounding of
// division in OpenCL (2.5 ulp) and of the products; candidates are then divided and tested exactly.
#define RANGE_SLACK 2e-6f

// a x b, 0 only if a and b are parallel: adds the rounding error of one product (Kahan) or, without fma,
// those of both products if they are equal (Dekker 1971).
#if HAS_FMA
#define EDGE_FUNCTION(name, real)                               \
  static inline real name(real ax, real ay, real bx, real by) { \
    const real product = ay * bx;                               \
    return fma(ax, by, -product) + fma(-ay, bx, product);       \
  }
#else
#define EDGE_FUNCTION(name, real)                                                       \
  static inline real name##_error(real a, real b, real product) {                       \
    const real wide_a = a * 4097.0f, wide_b = b * 4097.0f;                              \
    const real high_a = wide_a - (wide_a - a), high_b = wide_b - (wide_b - b);          \
    const real low_a = a - high_a, low_b = b - high_b;                                  \
    return high_a * high_b - product + high_a * low_b + low_a * high_b + low_a * low_b; \
  }                                                                                     \
  static inline real name(real ax, real ay, real bx, real by) {                         \
    const real p = ax * by, q = ay * bx;                                                \
    return p == q ? name##_error(ax, by, p) - name##_error(ay, bx, q) : p - q;          \
  }
#endif

#if WIDE_VECTORS
EDGE_FUNCTION(edge_function8, float8)

// The result for eight lanes; t, u, v are set if `lanes` is not 0.
typedef struct BlockTest {
  float8 t, u, v;
  u32 lanes;
} BlockTest;

// Lanes hit in (t_min, t_max].
ALWAYS_INLINE BlockTest test_block(__global const TriangleBlock* block, const ShearRay* ray, float t_min,
                                   float t_max) {
  __global const float *vx = block->v0_x + ray->x, *vy = block->v0_x + ray->y, *vz = block->v0_x + ray->z;
  const float8 z0 = ray->oz - vload8(0, vz), z1 = ray->oz - vload8(3, vz), z2 = ray->oz - vload8(6, vz);
  const float8 x0 = fma(-(float8)(ray->sx), z0, ray->ox - vload8(0, vx)),
               x1 = fma(-(float8)(ray->sx), z1, ray->ox - vload8(3, vx)),
               x2 = fma(-(float8)(ray->sx), z2, ray->ox - vload8(6, vx));
  const float8 y0 = fma(-(float8)(ray->sy), z0, ray->oy - vload8(0, vy)),
               y1 = fma(-(float8)(ray->sy), z1, ray->oy - vload8(3, vy)),
               y2 = fma(-(float8)(ray->sy), z2, ray->oy - vload8(6, vy));
  const float8 e0 = edge_function8(x2, y2, x1, y1), e1 = edge_function8(x0, y0, x2, y2),
               e2 = edge_function8(x1, y1, x0, y0);
  const int8 inside = (least8(least8(e0, e1), e2) >= 0.0f) | (greatest8(greatest8(e0, e1), e2) <= 0.0f);
  const float8 det = e0 + e1 + e2, size = fabs(det);
  const float8 scaled_t = fma(e0, z0, fma(e1, z1, e2 * z2)) * ray->sz;
  const float8 signed_t = as_float8(as_int8(scaled_t) ^ (as_int8(det) ^ as_int8(size)));
  BlockTest test;
  // The only branch; for a single ray it is predicted once per block.
  test.lanes = lane_mask(inside & (signed_t > (t_min * (1.0f - RANGE_SLACK)) * size) &
                         (signed_t <= (t_max * (1.0f + RANGE_SLACK)) * size));
  if (!test.lanes) return test;
  const float8 scale = 1.0f / det;
  test.u = e1 * scale;
  test.v = e2 * scale;
  test.t = scaled_t * scale;
  test.lanes &= lane_mask((test.t > t_min) & (test.t <= t_max) & (test.t < INFINITY));
  return test;
}

// Takes the nearest of the lanes hit (at least one) if it comes before *hit, whose prim becomes the
// triangle's place (see finish_triangle).
ALWAYS_INLINE void nearest_of_block(__global const TriangleBlock* blocks, u32 index, const BlockTest* test,
                                    u32 instance, Hit* hit) {
  float t[8], u[8], v[8];
  vstore8(test->t, 0, t);
  vstore8(test->u, 0, u);
  vstore8(test->v, 0, v);
  for (u32 lanes = test->lanes; lanes; lanes &= lanes - 1u) {
    const u32 i = lowest_bit(lanes);
    offer_triangle(blocks, index * 8u + i, t[i], u[i], v[i], instance, hit);
  }
}

// Nearest hit of the block in (t_min, hit->t].
ALWAYS_INLINE void closest_in_block(__global const TriangleBlock* blocks, u32 index, const ShearRay* ray,
                                    float t_min, u32 instance, Hit* hit) {
  const BlockTest test = test_block(blocks + index, ray, t_min, hit->t);
  if (test.lanes) nearest_of_block(blocks, index, &test, instance, hit);
}
#else
EDGE_FUNCTION(edge_function, float)

// Offers the triangle at `place`, if the ray hits it in (t_min, hit->t].
ALWAYS_INLINE void meet_triangle(__global const TriangleBlock* blocks, u32 place, const ShearRay* ray,
                                 float t_min, u32 instance, Hit* hit) {
  __global const float* corner = blocks[place >> 3].v0_x + (place & 7u);
  __global const float *vx = corner + ray->x, *vy = corner + ray->y, *vz = corner + ray->z;
  const float z0 = ray->oz - vz[0], z1 = ray->oz - vz[24], z2 = ray->oz - vz[48];
  const float x0 = fma(-ray->sx, z0, ray->ox - vx[0]), x1 = fma(-ray->sx, z1, ray->ox - vx[24]),
              x2 = fma(-ray->sx, z2, ray->ox - vx[48]);
  const float y0 = fma(-ray->sy, z0, ray->oy - vy[0]), y1 = fma(-ray->sy, z1, ray->oy - vy[24]),
              y2 = fma(-ray->sy, z2, ray->oy - vy[48]);
  const float e0 = edge_function(x2, y2, x1, y1), e1 = edge_function(x0, y0, x2, y2),
              e2 = edge_function(x1, y1, x0, y0);
  if (!((e0 >= 0.0f && e1 >= 0.0f && e2 >= 0.0f) || (e0 <= 0.0f && e1 <= 0.0f && e2 <= 0.0f))) return;
  const float det = e0 + e1 + e2, size = fabs(det);
  const float scaled_t = fma(e0, z0, fma(e1, z1, e2 * z2)) * ray->sz;
  const float signed_t = det < 0.0f ? -scaled_t : scaled_t;
  if (!(signed_t > (t_min * (1.0f - RANGE_SLACK)) * size &&
        signed_t <= (hit->t * (1.0f + RANGE_SLACK)) * size))
    return;
  const float scale = 1.0f / det, t = scaled_t * scale;
  if (t > t_min && t <= hit->t && t < INFINITY)
    offer_triangle(blocks, place, t, e1 * scale, e2 * scale, instance, hit);
}

ALWAYS_INLINE void closest_in_block(__global const TriangleBlock* blocks, u32 index, const ShearRay* ray,
                                    float t_min, u32 instance, Hit* hit) {
#pragma unroll 1
  for (u32 i = 0; i < 8u && blocks[index].prim[i] != NO_PRIM; ++i)
    meet_triangle(blocks, index * 8u + i, ray, t_min, instance, hit);
}
#endif
