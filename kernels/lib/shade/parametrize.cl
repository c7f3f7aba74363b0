// Coordinates on surfaces: u and v, and how the point moves with them (dpdu and dpdv, world space), from
// which tangent frames are made. Longitudes start at +x and turn towards +z, latitudes and heights go up with
// y:
//   sphere          u longitude, v latitude, both over [0, 1]
//   cylinder, cone  u longitude, v height; caps as disks
//   disk            u along x, v along z, [0, 1] over the square round it
//   plane           u = x, v = z
//   torus           u longitude, v the angle round the tube from its outer equator, both over [0, 1]
//   box, round box  each face from outside: u to the right, v upwards, [0, 1]
//   mesh            the vertices' u and v; without them as a field
//   field           u = v = 0, dpdu and dpdv any directions in the surface
#ifndef SUNDOG_LIB_PARAMETRIZE_CL
#define SUNDOG_LIB_PARAMETRIZE_CL
#include "lib/core/tables.h"
#include "lib/core/transform.cl"
#include "lib/trace/hits.cl"

#if HAS_UV
typedef struct Coordinates {
  REAL u, v;
  REAL3 dpdu, dpdv;
  REAL length;  // how long a unit of u and v is, in the world: their geometric mean; 0 where it is not known
} Coordinates;

// The same in object space, without the length.
typedef struct SurfacePoints {
  REAL u, v;
  REAL3 dpdu, dpdv;
} SurfacePoints;

// Directions at right angles to n.
static inline REAL3 any_tangents(REAL3 n) {
  const REAL zero = (REAL)(0.0f);
  return select3(real3(zero, n.z, -n.y), real3(-n.z, zero, n.x), MASK_OF(fabs(n.x) > fabs(n.y)));
}

// The angle of (x, y) in turns, [0, 1): an odd polynomial on Chebyshev's nodes (error 1e-8 turns) of the
// lesser coordinate over the greater one, which has the same bits on every device.
static inline REAL turns(REAL x, REAL y) {
  const REAL ax = fabs(x), ay = fabs(y), most = real_max(ax, ay);
  const REAL t = real_min(ax, ay) / select(most, (REAL)(1.0f), MASK_OF(most == 0.0f)), z = t * t;
  REAL p = fma(z, (REAL)(0.0027662835f), (REAL)(-0.0157312491f));
  p = fma(z, p, (REAL)(0.0421376236f));
  p = fma(z, p, (REAL)(-0.0745685483f));
  p = fma(z, p, (REAL)(0.106183706f));
  p = fma(z, p, (REAL)(-0.141977978f));
  p = fma(z, p, (REAL)(0.19991872f));
  p = fma(z, p, (REAL)(-0.333330367f));
  p = fma(z, p, (REAL)(0.999999982f));
  REAL turn = p * t * (0.5f / M_PI_F);
  turn = select(turn, 0.25f - turn, MASK_OF(ay > ax));
  turn = select(turn, 0.5f - turn, MASK_OF(x < 0.0f));
  return select(turn, real_min(1.0f - turn, (REAL)(0x1.fffffep-1f)), MASK_OF(y < 0.0f));
}
static inline REAL3 round_tangents(REAL3 p) {
  return scale3(real3(-p.z, (REAL)(0.0f), p.x), (REAL)(2.0f * M_PI_F));
}
static inline REAL radius_about_y(REAL3 p) { return real_sqrt(fma(p.x, p.x, p.z * p.z)); }

// The directions away from the y axis, unit; at the axis any.
static inline REAL3 away_from_axis(REAL3 p, REAL r) {
  const MASK off = MASK_OF(r > 0.0f);
  const REAL inverse = 1.0f / select((REAL)(1.0f), r, off);
  return real3(select((REAL)(1.0f), p.x * inverse, off), (REAL)(0.0f),
               select((REAL)(0.0f), p.z * inverse, off));
}

static inline SurfacePoints on_sphere(REAL3 p) {
  const REAL r = radius_about_y(p), zero = (REAL)(0.0f);
  SurfacePoints at;
  at.u = turns(p.x, p.z);
  at.v = 0.5f + 2.0f * copysign(turns(r, fabs(p.y)), p.y);
  at.dpdu = round_tangents(p);
  at.dpdv = scale3(along3(real3(zero, r, zero), -p.y, away_from_axis(p, r)), (REAL)(M_PI_F));
  return at;
}

// A cylinder or cone; `growth`: of the radius with the height.
static inline SurfacePoints on_tube(REAL3 p, float growth) {
  const REAL3 up = all3((float3)(0.0f, 1.0f, 0.0f));
  SurfacePoints at;
  at.u = turns(p.x, p.z);
  at.v = 0.5f + 0.5f * p.y;
  at.dpdu = round_tangents(p);
  at.dpdv = scale3(along3(up, (REAL)(growth), away_from_axis(p, radius_about_y(p))), (REAL)(2.0f));
  return at;
}

static inline SurfacePoints on_disk(REAL3 p) {
  const SurfacePoints at = {0.5f + 0.5f * p.x, 0.5f + 0.5f * p.z, all3((float3)(2.0f, 0.0f, 0.0f)),
                            all3((float3)(0.0f, 0.0f, 2.0f))};
  return at;
}

static inline SurfacePoints on_plane(REAL3 p) {
  const SurfacePoints at = {p.x, p.z, all3((float3)(1.0f, 0.0f, 0.0f)), all3((float3)(0.0f, 0.0f, 1.0f))};
  return at;
}

static inline SurfacePoints on_torus(REAL3 p) {
  const REAL r = radius_about_y(p), zero = (REAL)(0.0f);
  SurfacePoints at;
  at.u = turns(p.x, p.z);
  at.v = turns(r - 1.0f, p.y);
  at.dpdu = round_tangents(p);
  at.dpdv = scale3(along3(real3(zero, r - 1.0f, zero), -p.y, away_from_axis(p, r)), (REAL)(2.0f * M_PI_F));
  return at;
}

// A box with these half sizes; the face is the one that p is nearest to.
static inline SurfacePoints on_box(REAL3 p, float3 half_size) {
  const REAL3 q = real3(p.x / half_size.x, p.y / half_size.y, p.z / half_size.z);
  const REAL3 size = real3(fabs(q.x), fabs(q.y), fabs(q.z));
  const REAL zero = (REAL)(0.0f), a = (REAL)(2.0f * half_size.x), b = (REAL)(2.0f * half_size.y),
             c = (REAL)(2.0f * half_size.z);
  const MASK top = MASK_OF(size.y >= size.x) & MASK_OF(size.y >= size.z);
  const MASK side = ~top & MASK_OF(size.x >= size.z);
  SurfacePoints at;
  at.u = 0.5f + 0.5f * select(select(copysign(q.x, q.x * q.z), -copysign(q.z, q.z * q.x), side), q.x, top);
  at.v = 0.5f + 0.5f * select(q.y, -copysign(q.z, q.z * q.y), top);
  at.dpdu = select3(select3(real3(copysign(a, q.z), zero, zero), real3(zero, zero, copysign(c, -q.x)), side),
                    real3(a, zero, zero), top);
  at.dpdv = select3(real3(zero, b, zero), real3(zero, zero, copysign(c, -q.y)), top);
  return at;
}

static inline SurfacePoints select_points(SurfacePoints a, SurfacePoints b, MASK m) {
  const SurfacePoints at = {select(a.u, b.u, m), select(a.v, b.v, m), select3(a.dpdu, b.dpdu, m),
                            select3(a.dpdv, b.dpdv, m)};
  return at;
}

// Points p of a solid, in object space, on its `part`s, where the normal is n.
static inline SurfacePoints on_solid(u32 shape, float4 parameters, REAL3 p, REAL3 n, MASK part) {
  const MASK cap = MASK_OF(part != 0);
  if (HAS_SPHERE && shape == SHAPE_SPHERE) return on_sphere(p);
  if (HAS_PLANE && shape == SHAPE_PLANE) return on_plane(p);
  if (HAS_BOX && shape == SHAPE_BOX) return on_box(p, (float3)(1.0f));
  if (HAS_CYLINDER && shape == SHAPE_CYLINDER) return select_points(on_tube(p, 0.0f), on_disk(p), cap);
  if (HAS_CONE && shape == SHAPE_CONE)
    return select_points(on_tube(p, 0.5f * (parameters.y - parameters.x)), on_disk(p), cap);
  if (HAS_DISK && shape == SHAPE_DISK) return on_disk(p);
  if (HAS_TORUS && shape == SHAPE_TORUS) return on_torus(p);
  if (HAS_ROUNDBOX && shape == SHAPE_ROUNDBOX) return on_box(p, parameters.xyz);
  const REAL3 tangent = any_tangents(n);
  const SurfacePoints nowhere = {(REAL)(0.0f), (REAL)(0.0f), tangent,
                                 real3(n.y * tangent.z - n.z * tangent.y, n.z * tangent.x - n.x * tangent.z,
                                       n.x * tangent.y - n.y * tangent.x)};
  return nowhere;
}

static inline float3 corner_of(__global const TriangleBlock* block, u32 corner, u32 lane) {
  __global const float* at = block->v0_x + corner * 24u + lane;
  return (float3)(at[0], at[8], at[16]);
}

// The hits of `lanes` on triangles of a mesh.
static inline void on_triangles(const Scene* scene, const Hits* hits, MASK lanes, SurfacePoints* at) {
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    __global const TriangleShading* triangle = scene->triangles + MASK_LANE(hits->prim, i);
    __global const TriangleBlock* block = scene->blocks + (triangle->place >> 3);
    const u32 lane = triangle->place & 7u;
    __global const Vertex* v0 = scene->vertices + triangle->vertex[0];
    __global const Vertex* v1 = scene->vertices + triangle->vertex[1];
    __global const Vertex* v2 = scene->vertices + triangle->vertex[2];
    const float3 p0 = corner_of(block, 0u, lane);
    const float3 e1 = corner_of(block, 1u, lane) - p0, e2 = corner_of(block, 2u, lane) - p0;
    const float2 d1 = (float2)(v1->u - v0->u, v1->v - v0->v), d2 = (float2)(v2->u - v0->u, v2->v - v0->v);
    const float area = d1.x * d2.y - d2.x * d1.y, b = REAL_LANE(hits->u, i), c = REAL_LANE(hits->v, i);
    REAL_LANE(at->u, i) = v0->u + b * d1.x + c * d2.x;
    REAL_LANE(at->v, i) = v0->v + b * d1.y + c * d2.y;
    if (area == 0.0f) continue;  // any direction
    set3(&at->dpdu, i, (e1 * d2.y - e2 * d1.y) / area);
    set3(&at->dpdv, i, (e2 * d1.x - e1 * d2.x) / area);
  }
}

static inline REAL3 cross3(REAL3 a, REAL3 b) {
  return real3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

// Vectors of object space in world space: by the inverse of object_from_world's linear part.
static inline REAL3 world_vectors(__global const Instance* instance, REAL3 a) {
  const float3 r0 = instance->object_from_world[0].xyz, r1 = instance->object_from_world[1].xyz,
               r2 = instance->object_from_world[2].xyz;
  const float3 c0 = cross(r1, r2);
  const float inverse = 1.0f / dot(r0, c0);
  return scale3(along3(along3(scale3(all3(c0), a.x), a.y, all3(cross(r2, r0))), a.z, all3(cross(r0, r1))),
                (REAL)(inverse));
}

// The coordinates of the hits of `lanes`, at the points p of the world.
NEVER_INLINE void find_coordinates(const Scene* scene, const Hits* hits, const REAL3* p, MASK lanes,
                                   Coordinates* at) {
  const REAL3 zero = all3((float3)(0.0f));
  at->u = at->v = at->length = (REAL)(0.0f);
  at->dpdu = at->dpdv = zero;
  u32 index;
  while (any_lane(lanes)) {
    const MASK mine = take_alike(hits->instance, &lanes, &index);
    __global const Instance* instance = scene->instances + index;
    SurfacePoints points =
        on_solid(instance->shape, instance->parameters, object_points(instance, *p), hits->ng, hits->prim);
#if HAS_MESH
    if (instance->shape == SHAPE_MESH) on_triangles(scene, hits, mine, &points);
#endif
    const REAL3 dpdu = world_vectors(instance, points.dpdu), dpdv = world_vectors(instance, points.dpdv);
    at->u = select(at->u, points.u, mine);
    at->v = select(at->v, points.v, mine);
    at->dpdu = select3(at->dpdu, dpdu, mine);
    at->dpdv = select3(at->dpdv, dpdv, mine);
    at->length = select(at->length, real_sqrt(length3(cross3(dpdu, dpdv))), mine);
  }
}
#endif

#endif
