// Surface coordinates: u and v, and the point's derivatives (dpdu and dpdv, world space), which define
// tangent frames. Longitudes start at +x and turn towards -z; latitudes and heights increase with y, so a
// picture on any solid reads from left to right from outside:
//   sphere          u longitude, v latitude, both over [0, 1]
//   cylinder, cone  u longitude, v height; caps as disks
//   disk            u along x, v along -z (bottom caps: +z), [0, 1] over the square round it
//   rectangle       u along x, v along -z, both over [0, 1]
//   plane           u = x, v = -z
//   torus           u longitude, v the angle round the tube from its outer equator, both over [0, 1]
//   lathe           u longitude, v the share of the profile's length, both over [0, 1]
//   box, round box  each face from outside: u to the right, v upwards, [0, 1]
//   mesh            the vertices' u and v; without them as a field
//   field           u = v = 0, dpdu and dpdv any directions in the surface
#pragma once
#include "lib/core/motion.cl"
#include "lib/core/tables.h"
#include "lib/core/transform.cl"
#include "lib/solids/solids.cl"
#include "lib/trace/hits.cl"

// The corner `corner` of the triangle `lane` of a block.
static inline float3 corner_of(__global const TriangleBlock* block, u32 corner, u32 lane) {
  __global const float* at = block->v0_x + corner * 24u + lane;
  return (float3)(at[0], at[8], at[16]);
}

#if HAS_UV
typedef struct Coordinates {
  REAL u, v;
  REAL3 dpdu, dpdv;
  REAL length;  // world length of a unit of u and v (geometric mean); 0: unknown
} Coordinates;

// Arbitrary directions perpendicular to n.
static inline REAL3 any_tangents(REAL3 n) {
  const REAL zero = (REAL)(0.0f);
  return select3(real3(zero, n.z, -n.y), real3(-n.z, zero, n.x), MASK_OF(fabs(n.x) > fabs(n.y)));
}

// For surfaces without coordinates, with normals n.
static inline SurfacePoints points_without_place(REAL3 n) {
  const REAL3 tangent = any_tangents(n);
  const SurfacePoints points = {(REAL)(0.0f), (REAL)(0.0f), tangent, cross3(n, tangent)};
  return points;
}

// For hits of `lanes` on mesh triangles.
static inline void on_triangles(const Scene* scene, const Hits* hits, MASK lanes, SurfacePoints* at) {
  EACH_LANE(i, lanes) {
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

// Transforms vectors from object to world space by the inverse of object_from_world's linear part.
static inline REAL3 world_vectors(__global const Instance* instance, REAL3 a) {
  const float3 r0 = instance->object_from_world[0].xyz, r1 = instance->object_from_world[1].xyz,
               r2 = instance->object_from_world[2].xyz;
  const float3 c0 = cross(r1, r2);
  const float inverse = 1.0f / dot(r0, c0);
  return scale3(along3(along3(scale3(all3(c0), a.x), a.y, all3(cross(r2, r0))), a.z, all3(cross(r0, r1))),
                (REAL)(inverse));
}

// The coordinates of the hits of `lanes`, at the world points p.
NEVER_INLINE void find_coordinates(const Scene* scene, const Hits* hits, const REAL3* p, MASK lanes,
                                   Coordinates* at) {
  const REAL3 zero = all3((float3)(0.0f));
  at->u = at->v = at->length = (REAL)(0.0f);
  at->dpdu = at->dpdv = zero;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(hits->instance, &left, &index);
    __global const Instance* instance = scene->instances + index;
    SurfacePoints points = points_without_place(hits->ng);
    points_on_solid(scene, instance->shape, instance->parameters,
                    object_points(instance, still_origins(hits, index, *p)), hits->prim, &points);
    if (HAS_MESH && instance->shape == SHAPE_MESH) on_triangles(scene, hits, mine, &points);
    const REAL time = time_of_hits(hits);
    const REAL3 dpdu = moved_vectors(scene, index, world_vectors(instance, points.dpdu), time),
                dpdv = moved_vectors(scene, index, world_vectors(instance, points.dpdv), time);
    at->u = select(at->u, points.u, mine);
    at->v = select(at->v, points.v, mine);
    at->dpdu = select3(at->dpdu, dpdu, mine);
    at->dpdv = select3(at->dpdv, dpdv, mine);
    at->length = select(at->length, real_sqrt(length3(cross3(dpdu, dpdv))), mine);
  }
}
#endif
