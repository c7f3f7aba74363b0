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
#include "plain/shade/interface.h"

// Rounded once an operation, unlike dot(), which has a fma().

// The corner `corner` of the triangle at `place` (TriangleShading).
static inline float3 corner_of(UNIFORM const Scene* scene, u32 place, UNIFORM u32 corner) {
  __global const TriangleBlock* block = scene->blocks + (place >> 3);
  const u32 at = corner * 24u + (place & 7u);
  return (float3)(block->v0_x[at], block->v0_y[at], block->v0_z[at]);
}

// Transforms vectors from object to world space by the inverse of object_from_world's linear part.
static inline float3 world_vector(UNIFORM __global const Instance* instance, float3 a) {
  const float3 r0 = instance->object_from_world[0].xyz, r1 = instance->object_from_world[1].xyz,
               r2 = instance->object_from_world[2].xyz, c0 = cross(r1, r2);
  return along(along(c0 * a.x, a.y, cross(r2, r0)), a.z, cross(r0, r1)) * (1.0f / plain_dot(r0, c0));
}

// World points p, and vectors, in the space of instance `index`, as it was at this time; its normals in the
// world.
static inline float3 points_at(UNIFORM const Scene* scene, UNIFORM u32 index, float3 p, float time) {
  return object_points(scene->instances + index, still_points(scene, index, p, time));
}
static inline float3 vectors_at(UNIFORM const Scene* scene, UNIFORM u32 index, float3 a, float time) {
  return object_vectors(scene->instances + index, still_vectors(scene, index, a, time));
}
static inline float3 normals_at(UNIFORM const Scene* scene, UNIFORM u32 index, float3 n, float time) {
  return moved_normals(scene, index, world_normals(scene->instances + index, n), time);
}
static inline float time_of(const SurfaceInteraction* s) {
  if (HAS_OBJECT_MOTION) return s->time;
  return 0.0f;
}

HAVING(HAS_UV);

// For hits on mesh triangles; without an area in u and v, dpdu and dpdv stay as they are.
static inline void on_triangle(UNIFORM const Scene* scene, const SurfaceHit* hit, SolidPoint* at) {
  __global const TriangleShading* triangle = scene->triangles + hit->prim;
  __global const Vertex* v0 = scene->vertices + triangle->vertex[0];
  __global const Vertex* v1 = scene->vertices + triangle->vertex[1];
  __global const Vertex* v2 = scene->vertices + triangle->vertex[2];
  const float3 p0 = corner_of(scene, triangle->place, 0u), e1 = corner_of(scene, triangle->place, 1u) - p0,
               e2 = corner_of(scene, triangle->place, 2u) - p0;
  const float d1_u = v1->u - v0->u, d1_v = v1->v - v0->v, d2_u = v2->u - v0->u, d2_v = v2->v - v0->v;
  const float area = d1_u * d2_v - d2_u * d1_v;
  at->u = v0->u + hit->u * d1_u + hit->v * d2_u;
  at->v = v0->v + hit->u * d1_v + hit->v * d2_v;
  if (area == 0.0f) return;
  at->dpdu = (e1 * d2_v - e2 * d1_v) / (float3)(area, area, area);
  at->dpdv = (e2 * d1_u - e1 * d2_u) / (float3)(area, area, area);
}

// The coordinates of a hit at the world point p.
static Parametrization find_coordinates(UNIFORM const Scene* scene, const SurfaceHit* hit, float3 p) {
  Parametrization at;
  const float3 n = hit->ng;
  EACH_ALIKE(u32, index, (u32)hit->instance) {
    __global const Instance* instance = scene->instances + index;
    SolidPoint point;
    point.u = 0.0f;
    point.v = 0.0f;
    point.dpdu = fabs(n.x) > fabs(n.y) ? (float3)(-n.z, 0.0f, n.x) : (float3)(0.0f, n.z, -n.y);
    point.dpdv = cross(n, point.dpdu);
    points_on_solid(scene, instance->shape, instance->parameters,
                    object_points(instance, still_origins(hit, index, p)), hit->prim, &point);
    if (HAS_MESH && instance->shape == SHAPE_MESH) on_triangle(scene, hit, &point);
    const float time = time_of_hits(hit);
    at.u = point.u;
    at.v = point.v;
    at.dpdu = moved_vectors(scene, index, world_vector(instance, point.dpdu), time);
    at.dpdv = moved_vectors(scene, index, world_vector(instance, point.dpdv), time);
    at.length = real_sqrt(length(cross(at.dpdu, at.dpdv)));
  }
  return at;
}
