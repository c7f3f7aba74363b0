// Converts raw hits to shading data: position, surface, side, and surface coordinates.
#include "plain/path/segment.cl"
#include "plain/shade/bsdf.h"
#include "plain/shade/parametrize.cl"

// The distance from the surface at which new rays must start: a few float spacings at the magnitudes that
// produced the position (the idea of Waechter and Binder 2019, without their absolute threshold, so that
// scenes work in any unit); `turned`: that of the point about which it was rotated.
static inline float offset_distance(float3 o, float3 p, float turned) {
  return real_max(real_max(greatest_size(o), greatest_size(p)), turned) * 0x1p-19f;
}

// Likewise for the space in which the hit was found, along the normal `ng` there: its distance from the
// world's origin and, on a curved solid, its size. Triangles have their own extent, since distant corners
// also affect rounding. rounding_offset() converts lengths along `ng` to the world.
static inline float space_rounding(UNIFORM __global const Instance* instance, float3 ng) {
  const u32 shape = instance->shape;
  const bool flat =
      shape == SHAPE_MESH || shape == SHAPE_PLANE || shape == SHAPE_DISK || shape == SHAPE_RECTANGLE;
  const float size = flat ? 0.0f : 1.0f;
  return greatest_size(ng * (float3)(fabs(instance->object_from_world[0].w) + size,
                                     fabs(instance->object_from_world[1].w) + size,
                                     fabs(instance->object_from_world[2].w) + size));
}
static inline float rounding_offset(float rounding, float3 outward) {
  return rounding * 0x1p-21f / nonzero(greatest_size(outward));
}

// Moves a position on a sphere onto its surface by one Newton step; rounding of t is largest for far origins.
static inline float3 settle_on_sphere(UNIFORM const Scene* scene, UNIFORM u32 index, float3 p, float time) {
  const float3 q = points_at(scene, index, p, time), gradient = normals_at(scene, index, q, time);
  return along(p, -0.5f * (dot(q, q) - 1.0f) / dot(gradient, gradient), gradient);
}

// A corner's normal that turns further than this cosine from its triangle's means no smooth surface.
#define SMOOTH_COSINE 0.5f

// A mesh's corners at a hit: the interpolated normal, unit, and color, both in the world; the
// triangle's extent; how far the surface that is smooth by the corners' normals is before the triangle, seen
// from the ray's side: the mean height of the planes through the corners, where they are before it (Hanika
// 2021, "Hacking the Shadow Terminator"). Negative if the normals mean no such surface.
typedef struct MeshPoint {
  float3 ns, color;
  float extent, lift;
} MeshPoint;

static MeshPoint point_on_mesh(UNIFORM const Scene* scene, UNIFORM u32 index, const SurfaceHit* hit,
                               bool entering) {
  MeshPoint point;
  __global const TriangleShading* triangle = scene->triangles + hit->prim;
  __global const Vertex* a = scene->vertices + triangle->vertex[0];
  __global const Vertex* b = scene->vertices + triangle->vertex[1];
  __global const Vertex* c = scene->vertices + triangle->vertex[2];
  const float u = hit->u, v = hit->v, w = 1.0f - u - v, side = entering ? -1.0f : 1.0f;
  point.extent = triangle->extent;
  point.color =
      (float3)(a->r, a->g, a->b) * w + (float3)(b->r, b->g, b->b) * u + (float3)(c->r, c->g, c->b) * v;
  const float3 na = (float3)(a->nx, a->ny, a->nz), nb = (float3)(b->nx, b->ny, b->nz),
               nc = (float3)(c->nx, c->ny, c->nz), n = na * w + nb * u + nc * v;
  const float3 p0 = corner_of(scene, triangle->place, 0u), e1 = corner_of(scene, triangle->place, 1u) - p0,
               e2 = corner_of(scene, triangle->place, 2u) - p0, face = cross(e1, e2), at = e1 * u + e2 * v;
  const float least = SMOOTH_COSINE * sqrt(plain_dot(face, face));
  const float height = w * fmax(side * plain_dot(at, na), 0.0f) +
                       u * fmax(side * plain_dot(at - e1, nb), 0.0f) +
                       v * fmax(side * plain_dot(at - e2, nc), 0.0f);
  const bool smooth = fmin(plain_dot(face, na), fmin(plain_dot(face, nb), plain_dot(face, nc))) > least;
  const float3 normal = normals_at(scene, index, n, time_of_hits(hit));
  point.lift = sqrt(plain_dot(n, n)) * (smooth ? height : -1.0f) / nonzero(length(normal));
  point.ns = safe_unit3(normal);
  return point;
}

// Turns a mesh's shading normal `ns` against the ray; the geometric normal if unusable. A normal facing
// away from the viewer would light the back of objects, so it is bent to the silhouette.
static inline float3 facing_normal(float3 ns, float3 ng, bool entering, float3 d) {
  const float3 facing = entering ? ns : -ns;
  const float towards = dot(facing, d);
  const float3 bent = safe_unit3(along(facing, -(towards + 1e-4f), d));
  const float3 normal = towards < 0.0f ? facing : bent;
  return dot(facing, facing) > 0.0f ? normal : ng;
}

// Field colour of instance `index` where the ray hit it.
HAVING(HAS_SDF)
static float3 field_color(UNIFORM const Scene* scene, UNIFORM u32 index, float3 o, float3 d,
                          const SurfaceHit* hit) {
  __global const Instance* instance = scene->instances + index;
  const float3 from = field_points(instance, still_origins(hit, index, o));
  return sdf_color(scene, instance->root,
                   along(from, hit->t, object_vectors(instance, still_directions(hit, index, d))));
}

// Sets the point of a hit, its time and its texture data.
ENTRY static inline void locate(UNIFORM const Scene* scene, const SurfaceHit* hit, float3 p,
                                OUT SurfaceInteraction* s) {
  s->p = p;
  if (HAS_OBJECT_MOTION) s->time = time_of_hits(hit);
  if (HAS_UV) s->at = find_coordinates(scene, hit, p);
  if (HAS_MAPS) {
    s->prim = hit->prim;
    s->b = hit->u;
    s->c = hit->v;
  }
  if (HAS_PARALLAX) {
    s->shift = (float3)(0.0f);
    s->top = (float3)(0.0f);
    s->sunk = 0.0f;
    s->below = 0.0f;
  }
}

// The interaction of the ray (o, d) with what it has hit.
ENTRY static inline void interact(UNIFORM const Scene* scene, float3 o, float3 d, const SurfaceHit* hit,
                                  const Face* face, OUT SurfaceInteraction* s) {
  const float3 outward = safe_unit3(face->outward), ng = face->entering ? outward : -outward;
  float3 p = along(o, hit->t, d), ns = ng, side = ng, color = (float3)(1.0f);
  float extent = 0.0f, turned = 0.0f, rounding = 0.0f, lift = 0.0f;
  bool colored = (face->flags & (int)MATERIAL_VERTEX_COLOR) != 0;  // by vertices; fields always are
  EACH_ALIKE(u32, index, (u32)hit->instance) {
    __global const Instance* instance = scene->instances + index;
    turned = moved_extent(scene, index);
    if (instance->shape != SHAPE_SDF) rounding = space_rounding(instance, hit->ng);
    if (HAS_SPHERE && instance->shape == SHAPE_SPHERE)
      p = settle_on_sphere(scene, index, p, time_of_hits(hit));
    if (HAS_MESH && instance->shape == SHAPE_MESH) {
      const MeshPoint mesh = point_on_mesh(scene, index, hit, face->entering);
      extent = mesh.extent;
      color = mesh.color;
      ns = facing_normal(mesh.ns, ng, face->entering, d);
      if (mesh.lift >= 0.0f && (face->flags & (int)MATERIAL_TRANSMITS) == 0) {
        side = ns;
        lift = mesh.lift;
      }
    }
    if (HAS_SDF && instance->shape == SHAPE_SDF) {
      color = field_color(scene, index, o, d, hit);
      colored = true;
    }
  }
  rounding = real_max(rounding, extent * greatest_size(hit->ng));
  s->ng = ng;
  s->ns = ns;
  s->side = side;
  s->lift = lift;
  s->instance = hit->instance;
  s->material = face->material;
  s->flags = face->flags;
  s->medium = face->medium;
  s->entering = face->entering;
  s->color = colored ? color : (float3)(1.0f);
  s->offset = real_max(rounding_offset(rounding, face->outward), offset_distance(o, p, turned));
  locate(scene, hit, p, s);
}

static inline float steepness(const SurfaceInteraction* s, float3 d) {
  return real_max(fabs(dot(s->ng, d)), 0.01f);
}

// Sets the surface's footprints: the longer axis of the ellipse in which the pixel's cone meets the surface
// (Akenine-Moeller and others 2019, "Texture Level of Detail Strategies for Real-Time Ray Tracing").
ENTRY static inline void set_footprints(UNIFORM const Scene* scene, const SceneRay* ray, float t,
                                        OUT SurfaceInteraction* s) {
  if (HAS_MAPS) s->footprint = 0.0f;
  if (HAS_CONES) s->footprint = fabs(fma(t, ray->cone_spread, ray->cone_width)) / steepness(s, ray->d);
  if (HAS_CHECKER) s->camera_footprint = t * sample_spread(scene->info) / steepness(s, ray->d);
}
