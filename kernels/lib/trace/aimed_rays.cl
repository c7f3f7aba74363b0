// Rays of a batch prepared for tests of boxes and triangles: the members of SlabRay and ShearRay, to the bit,
// one ray per lane. A test reads its ray from the arrays, which costs no more than a structure of that ray
// would.
#pragma once
#include "lib/core/config.h"
#if WALKS_IN_TURN
#include "lib/core/lanes.h"
#include "lib/trace/nodes.cl"
#include "lib/trace/triangles.cl"

typedef struct PreparedRays {
  REAL3 rcp_near, rcp_far, shift_near, shift_far;
  MASK near_x, near_y, near_z, far_x, far_y, far_z;
  REAL ox, oy, oz, sx, sy, sz;
  MASK x, y, z;
} PreparedRays;

// Offsets of the near and far planes of an axis in Bvh8Node; `offset`: its lower planes.
static inline void aim_planes(REAL rcp, int offset, MASK* near, MASK* far) {
  *near = offset + (MASK_OF(rcp < 0.0f) & 24);
  *far = offset * 2 + 24 - *near;
}

// Prepares ray i; the others are unchanged.
static inline void aim_ray(PreparedRays* rays, u32 i, float3 o, float3 d) {
  const SlabRay slabs = make_slab_ray(o, d);
  set3(&rays->rcp_near, i, slabs.rcp_near);
  set3(&rays->rcp_far, i, slabs.rcp_far);
  set3(&rays->shift_near, i, slabs.shift_near);
  set3(&rays->shift_far, i, slabs.shift_far);
  MASK_LANE(rays->near_x, i) = (int)slabs.near_x;
  MASK_LANE(rays->far_x, i) = (int)slabs.far_x;
  MASK_LANE(rays->near_y, i) = (int)slabs.near_y;
  MASK_LANE(rays->far_y, i) = (int)slabs.far_y;
  MASK_LANE(rays->near_z, i) = (int)slabs.near_z;
  MASK_LANE(rays->far_z, i) = (int)slabs.far_z;
  const ShearRay shear = make_shear_ray(o, d);
  MASK_LANE(rays->x, i) = (int)shear.x;
  MASK_LANE(rays->y, i) = (int)shear.y;
  MASK_LANE(rays->z, i) = (int)shear.z;
  REAL_LANE(rays->ox, i) = shear.ox;
  REAL_LANE(rays->oy, i) = shear.oy;
  REAL_LANE(rays->oz, i) = shear.oz;
  REAL_LANE(rays->sx, i) = shear.sx;
  REAL_LANE(rays->sy, i) = shear.sy;
  REAL_LANE(rays->sz, i) = shear.sz;
}

// Prepares all lanes.
static inline PreparedRays aimed(const REAL3* o, const REAL3* d) {
  PreparedRays rays;
  aim_planes(aim_slabs(o->x, d->x, &rays.rcp_near.x, &rays.rcp_far.x, &rays.shift_near.x, &rays.shift_far.x),
             0, &rays.near_x, &rays.far_x);
  aim_planes(aim_slabs(o->y, d->y, &rays.rcp_near.y, &rays.rcp_far.y, &rays.shift_near.y, &rays.shift_far.y),
             8, &rays.near_y, &rays.far_y);
  aim_planes(aim_slabs(o->z, d->z, &rays.rcp_near.z, &rays.rcp_far.z, &rays.shift_near.z, &rays.shift_far.z),
             16, &rays.near_z, &rays.far_z);
  const REAL size_x = fabs(d->x), size_y = fabs(d->y), size_z = fabs(d->z);
  const MASK along_x = MASK_OF(size_x >= size_y) & MASK_OF(size_x >= size_z),
             along_y = MASK_OF(size_x < size_y) & MASK_OF(size_y >= size_z);
  rays.z = select(select((MASK)(16), (MASK)(8), along_y), (MASK)(0), along_x);
  rays.x = select(select((MASK)(0), (MASK)(16), along_y), (MASK)(8), along_x);
  rays.y = 24 - rays.x - rays.z;
  rays.ox = select(select(o->x, o->z, along_y), o->y, along_x);
  rays.oy = select(select(o->y, o->x, along_y), o->z, along_x);
  rays.oz = select(select(o->z, o->y, along_y), o->x, along_x);
  const REAL dx = select(select(d->x, d->z, along_y), d->y, along_x);
  const REAL dy = select(select(d->y, d->x, along_y), d->z, along_x);
  const REAL along = 1.0f / select(select(d->z, d->y, along_y), d->x, along_x);
  rays.sx = dx * along;
  rays.sy = dy * along;
  rays.sz = -along;
  return rays;
}

static inline void blend3(REAL3* a, const REAL3* b, MASK lanes) { *a = select3(*a, *b, lanes); }

// Prepares the lanes of `bits`, like make_slab_ray and make_shear_ray; the others are unchanged.
NEVER_INLINE void aim_rays(PreparedRays* rays, const REAL3* o, const REAL3* d, u32 bits) {
  if (!(bits & (bits - 1u))) {
    aim_ray(rays, lowest_bit(bits), get3(o, lowest_bit(bits)), get3(d, lowest_bit(bits)));
    return;
  }
  const PreparedRays all = aimed(o, d);
  const MASK lanes = lanes_of(bits);
  blend3(&rays->rcp_near, &all.rcp_near, lanes);
  blend3(&rays->rcp_far, &all.rcp_far, lanes);
  blend3(&rays->shift_near, &all.shift_near, lanes);
  blend3(&rays->shift_far, &all.shift_far, lanes);
  rays->near_x = select(rays->near_x, all.near_x, lanes);
  rays->near_y = select(rays->near_y, all.near_y, lanes);
  rays->near_z = select(rays->near_z, all.near_z, lanes);
  rays->far_x = select(rays->far_x, all.far_x, lanes);
  rays->far_y = select(rays->far_y, all.far_y, lanes);
  rays->far_z = select(rays->far_z, all.far_z, lanes);
  rays->ox = select(rays->ox, all.ox, lanes);
  rays->oy = select(rays->oy, all.oy, lanes);
  rays->oz = select(rays->oz, all.oz, lanes);
  rays->sx = select(rays->sx, all.sx, lanes);
  rays->sy = select(rays->sy, all.sy, lanes);
  rays->sz = select(rays->sz, all.sz, lanes);
  rays->x = select(rays->x, all.x, lanes);
  rays->y = select(rays->y, all.y, lanes);
  rays->z = select(rays->z, all.z, lanes);
}

ALWAYS_INLINE SlabRay get_slabs(const PreparedRays* rays, u32 i) {
  SlabRay ray;
  ray.rcp_near = get3(&rays->rcp_near, i);
  ray.rcp_far = get3(&rays->rcp_far, i);
  ray.shift_near = get3(&rays->shift_near, i);
  ray.shift_far = get3(&rays->shift_far, i);
  ray.near_x = (u32)MASK_LANE(rays->near_x, i);
  ray.near_y = (u32)MASK_LANE(rays->near_y, i);
  ray.near_z = (u32)MASK_LANE(rays->near_z, i);
  ray.far_x = (u32)MASK_LANE(rays->far_x, i);
  ray.far_y = (u32)MASK_LANE(rays->far_y, i);
  ray.far_z = (u32)MASK_LANE(rays->far_z, i);
  return ray;
}

ALWAYS_INLINE ShearRay get_shear(const PreparedRays* rays, u32 i) {
  ShearRay ray;
  ray.x = (u32)MASK_LANE(rays->x, i);
  ray.y = (u32)MASK_LANE(rays->y, i);
  ray.z = (u32)MASK_LANE(rays->z, i);
  ray.ox = REAL_LANE(rays->ox, i);
  ray.oy = REAL_LANE(rays->oy, i);
  ray.oz = REAL_LANE(rays->oz, i);
  ray.sx = REAL_LANE(rays->sx, i);
  ray.sy = REAL_LANE(rays->sy, i);
  ray.sz = REAL_LANE(rays->sz, i);
  return ray;
}

#endif
