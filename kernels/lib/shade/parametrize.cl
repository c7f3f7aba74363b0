// Coordinates on surfaces: u and v, and how the point moves with u (dpdu, world space), from which tangent
// frames are made. Longitudes start at +x and turn towards +z, latitudes and heights go up with y:
//   sphere          u longitude, v latitude, both over [0, 1]
//   cylinder, cone  u longitude, v height; caps as disks
//   disk            u along x, v along z, [0, 1] over the square round it
//   plane           u = x, v = z
//   torus           u longitude, v the angle round the tube from its outer equator, both over [0, 1]
//   box, round box  each face from outside: u to the right, v upwards, [0, 1]
//   mesh            the vertices' u and v; without them as a field
//   field           u = v = 0, dpdu any direction in the surface
#ifndef SUNDOG_LIB_PARAMETRIZE_CL
#define SUNDOG_LIB_PARAMETRIZE_CL
#include "lib/core/tables.h"
#include "lib/core/transform.cl"
#include "lib/trace/hits.cl"

#if HAS_UV
typedef struct Coordinates {
  REAL u, v;
  REAL3 dpdu;
} Coordinates;

// The same of one point, in object space.
typedef struct SurfacePoint {
  float u, v;
  float3 dpdu;
} SurfacePoint;

// A direction at right angles to n.
static inline float3 any_tangent(float3 n) {
  return fabs(n.x) > fabs(n.y) ? (float3)(-n.z, 0.0f, n.x) : (float3)(0.0f, n.z, -n.y);
}

// [0, 1) for a turn about the y axis, or about another one by its two coordinates.
static inline float turns(float along, float across) {
  const float turn = atan2(across, along) * (0.5f / M_PI_F);
  return turn < 0.0f ? fmin(turn + 1.0f, 0x1.fffffep-1f) : turn;
}
static inline float3 round_tangent(float3 p) { return 2.0f * M_PI_F * (float3)(-p.z, 0.0f, p.x); }

static inline SurfacePoint on_sphere(float3 p) {
  const float latitude = atan2(p.y, sqrt(p.x * p.x + p.z * p.z));
  const SurfacePoint at = {turns(p.x, p.z), 0.5f + latitude / M_PI_F, round_tangent(p)};
  return at;
}

static inline SurfacePoint on_tube(float3 p) {
  const SurfacePoint at = {turns(p.x, p.z), 0.5f + 0.5f * p.y, round_tangent(p)};
  return at;
}

static inline SurfacePoint on_disk(float3 p) {
  const SurfacePoint at = {0.5f + 0.5f * p.x, 0.5f + 0.5f * p.z, (float3)(2.0f, 0.0f, 0.0f)};
  return at;
}

static inline SurfacePoint on_plane(float3 p) {
  const SurfacePoint at = {p.x, p.z, (float3)(1.0f, 0.0f, 0.0f)};
  return at;
}

static inline SurfacePoint on_torus(float3 p) {
  const SurfacePoint at = {turns(p.x, p.z), turns(sqrt(p.x * p.x + p.z * p.z) - 1.0f, p.y), round_tangent(p)};
  return at;
}

// A box with these half sizes; the face is the one that p is nearest to.
static inline SurfacePoint on_box(float3 p, float3 half_size) {
  const float3 q = p / half_size, size = fabs(q);
  SurfacePoint at;
  if (size.y >= size.x && size.y >= size.z) {
    at.u = 0.5f + 0.5f * q.x;
    at.v = 0.5f - 0.5f * copysign(q.z, q.z * q.y);
    at.dpdu = (float3)(2.0f * half_size.x, 0.0f, 0.0f);
  } else if (size.x >= size.z) {
    at.u = 0.5f - 0.5f * copysign(q.z, q.z * q.x);
    at.v = 0.5f + 0.5f * q.y;
    at.dpdu = (float3)(0.0f, 0.0f, copysign(2.0f * half_size.z, -q.x));
  } else {
    at.u = 0.5f + 0.5f * copysign(q.x, q.x * q.z);
    at.v = 0.5f + 0.5f * q.y;
    at.dpdu = (float3)(copysign(2.0f * half_size.x, q.z), 0.0f, 0.0f);
  }
  return at;
}

// A point p of a solid, in object space, on its `part`, where the normal is n.
static inline SurfacePoint on_solid(u32 shape, float4 parameters, float3 p, float3 n, u32 part) {
  const SurfacePoint nowhere = {0.0f, 0.0f, any_tangent(n)};
  switch (shape) {
    case SHAPE_SPHERE:
      return on_sphere(p);
    case SHAPE_PLANE:
      return on_plane(p);
    case SHAPE_BOX:
      return on_box(p, (float3)(1.0f));
    case SHAPE_CYLINDER:
    case SHAPE_CONE:
      return part == 0u ? on_tube(p) : on_disk(p);
    case SHAPE_DISK:
      return on_disk(p);
    case SHAPE_TORUS:
      return on_torus(p);
    case SHAPE_ROUNDBOX:
      return on_box(p, parameters.xyz);
  }
  return nowhere;
}

static inline float3 corner_of(__global const TriangleBlock* block, u32 corner, u32 lane) {
  __global const float* at = block->v0_x + corner * 24u + lane;
  return (float3)(at[0], at[8], at[16]);
}

// On the triangle `index` with the geometric normal n, at the barycentric coordinates b and c.
static inline SurfacePoint on_triangle(const Scene* scene, u32 index, float b, float c, float3 n) {
  __global const TriangleShading* triangle = scene->triangles + index;
  __global const TriangleBlock* block = scene->blocks + (triangle->place >> 3);
  const u32 lane = triangle->place & 7u;
  const Vertex v0 = scene->vertices[triangle->vertex[0]], v1 = scene->vertices[triangle->vertex[1]],
               v2 = scene->vertices[triangle->vertex[2]];
  const float3 p0 = corner_of(block, 0u, lane);
  const float3 e1 = corner_of(block, 1u, lane) - p0, e2 = corner_of(block, 2u, lane) - p0;
  const float2 d1 = (float2)(v1.u - v0.u, v1.v - v0.v), d2 = (float2)(v2.u - v0.u, v2.v - v0.v);
  const float area = d1.x * d2.y - d2.x * d1.y;
  SurfacePoint at = {v0.u + b * d1.x + c * d2.x, v0.v + b * d1.y + c * d2.y, any_tangent(n)};
  if (area != 0.0f) at.dpdu = (e1 * d2.y - e2 * d1.y) / area;
  return at;
}

// A vector of object space in world space: by the inverse of object_from_world's linear part.
static inline float3 world_vector(__global const Instance* instance, float3 a) {
  const float3 r0 = instance->object_from_world[0].xyz, r1 = instance->object_from_world[1].xyz,
               r2 = instance->object_from_world[2].xyz;
  const float3 c0 = cross(r1, r2);
  return (c0 * a.x + cross(r2, r0) * a.y + cross(r0, r1) * a.z) / dot(r0, c0);
}

// The coordinates of the hits of `lanes`, at the points p of the world.
NEVER_INLINE void find_coordinates(const Scene* scene, const Hits* hits, const REAL3* p, MASK lanes,
                                   Coordinates* at) {
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits), prim = (u32)MASK_LANE(hits->prim, i);
    __global const Instance* instance = scene->instances + MASK_LANE(hits->instance, i);
    const float3 n = get3(&hits->ng, i);
    SurfacePoint point;
    if (instance->shape == SHAPE_MESH)
      point = on_triangle(scene, prim, REAL_LANE(hits->u, i), REAL_LANE(hits->v, i), n);
    else
      point = on_solid(instance->shape, instance->parameters, object_point(instance, get3(p, i)), n, prim);
    REAL_LANE(at->u, i) = point.u;
    REAL_LANE(at->v, i) = point.v;
    set3(&at->dpdu, i, world_vector(instance, point.dpdu));
  }
}
#endif

#endif
