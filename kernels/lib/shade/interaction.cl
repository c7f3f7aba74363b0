// Converts raw hits to shading data: position, surface, side, and surface coordinates. One ray per lane.
#pragma once
#include "lib/path/segment.cl"
#include "lib/shade/parametrize.cl"
#if HAS_SDF
#include "lib/path/fields.cl"
#endif

typedef struct SurfaceInteractions {
  REAL3 p;                                      // world
  REAL3 ng, ns;                                 // unit, both against the ray
  REAL3 side;                                   // likewise: what is above, by it, is before the surface
  REAL offset;                                  // distance off the surface at which secondary rays start
  REAL lift;                                    // how far the surface that smooth normals mean is before it
  REAL3 color;                                  // vertex or field colour, a factor on ambient and diffuse
  MASK instance;                                // index
  MASK material, flags;                         // index; of the material
  MASK medium, entering;                        // inside the surface; the ray comes from outside
  HAVING(HAS_OBJECT_MOTION, REAL time;)         // of the ray
  HAVING(HAS_UV, Coordinates at;)               // u, v and the point's derivatives
  HAVING(HAS_MAPS, MASK prim; REAL b; REAL c;)  // the hit's prim, u and v
  HAVING(HAS_MAPS, REAL footprint;)             // width of the ray's footprint on the surface, in the world
  HAVING(HAS_CHECKER, REAL camera_footprint;)   // footprint of a camera ray of this length
  HAVING(HAS_RELIEF, MASK bent;)                // ns differs from the geometry's normal
  HAVING(HAS_RELIEF, REAL even;)      // length of the normal map's mean normal in the footprint, 1 if uniform
  HAVING(HAS_PARALLAX, REAL3 shift;)  // along the surface to where the ray hits the relief below it, whose
                                      // are u and v
  HAVING(HAS_PARALLAX, REAL sunk;)    // depth of that point relative to the relief's
  HAVING(HAS_PARALLAX, REAL below;)   // depth below another surface in whose relief this one lies, or 0
  HAVING(HAS_PARALLAX, REAL3 top;)    // that surface's normal
} SurfaceInteractions;

static inline REAL time_of(const SurfaceInteractions* s) {
  return EITHER(HAS_OBJECT_MOTION, s->time, (REAL)(0.0f));
}

// World points p on such surfaces of instance `index`, in its own space.
static inline REAL3 points_of(const Scene* scene, u32 index, const SurfaceInteractions* s, REAL3 p) {
  return object_points(scene->instances + index, still_points(scene, index, p, time_of(s)));
}
// World directions along such surfaces in the space of instance `index`, and its normals in the world.
static inline REAL3 vectors_of(const Scene* scene, u32 index, const SurfaceInteractions* s, REAL3 a) {
  return object_vectors(scene->instances + index, still_vectors(scene, index, a, time_of(s)));
}
static inline REAL3 normals_of(const Scene* scene, u32 index, const SurfaceInteractions* s, REAL3 n) {
  return moved_normals(scene, index, world_normals(scene->instances + index, n), time_of(s));
}

static inline REAL greatest_size(REAL3 a) { return greatest3(real3(fabs(a.x), fabs(a.y), fabs(a.z))); }

// The distance from the surface at which new rays must start: a few float spacings at the magnitudes that
// produced the position (the idea of Waechter and Binder 2019, without their absolute threshold, so that
// scenes work in any unit); `turned`: that of the point about which it was rotated.
static inline REAL offset_distance(REAL3 o, REAL3 p, REAL turned) {
  return real_max(real_max(greatest_size(o), greatest_size(p)), turned) * 0x1p-19f;
}

// Likewise for the space in which the hit was found, along the normals `ng` there: its distance from the
// world's origin and, on a curved solid, its size. Triangles have their own extent, since distant corners
// also affect rounding. rounding_offset() converts lengths along `ng` to the world.
static inline REAL space_rounding(__global const Instance* instance, REAL3 ng) {
  const u32 shape = instance->shape;
  const bool flat =
      shape == SHAPE_MESH || shape == SHAPE_PLANE || shape == SHAPE_DISK || shape == SHAPE_RECTANGLE;
  const float size = flat ? 0.0f : 1.0f;
  const float4 r0 = instance->object_from_world[0], r1 = instance->object_from_world[1],
               r2 = instance->object_from_world[2];
  return greatest_size(
      multiply3(ng, all3((float3)(fabs(r0.w) + size, fabs(r1.w) + size, fabs(r2.w) + size))));
}
static inline REAL rounding_offset(REAL rounding, REAL3 outward) {
  return rounding * 0x1p-21f / nonzero(greatest_size(outward));
}

// Moves positions on a sphere onto its surface by one Newton step; rounding of t is largest for far origins.
static inline REAL3 settle_on_sphere(const Scene* scene, u32 index, const SurfaceInteractions* s) {
  const REAL3 q = points_of(scene, index, s, s->p), gradient = normals_of(scene, index, s, q);
  return along3(s->p, -0.5f * (dot3(q, q) - 1.0f) / dot3(gradient, gradient), gradient);
}

// A corner's normal that turns further than this cosine from its triangle's means no smooth surface.
#define SMOOTH_COSINE 0.5f

// How far the surface that is smooth by the normals na, nb, nc at its corners is before the triangle p0, p0 +
// e1, p0 + e2 at its point p0 + v e1 + w e2, seen from their side if that is 1, else -1: the mean height of
// the planes through the corners, where they are before it (Hanika 2021, "Hacking the Shadow Terminator").
// Negative if the normals mean no such surface.
static inline float smooth_lift(float3 p0, float3 e1, float3 e2, float v, float w, float side, float3 na,
                                float3 nb, float3 nc) {
  const float3 face = cross(e1, e2), at = v * e1 + w * e2;
  const float least = SMOOTH_COSINE * sqrt(dot(face, face));
  if (!(fmin(dot(face, na), fmin(dot(face, nb), dot(face, nc))) > least)) return -1.0f;
  return (1.0f - v - w) * fmax(-side * dot(at, na), 0.0f) + v * fmax(-side * dot(at - e1, nb), 0.0f) +
         w * fmax(-side * dot(at - e2, nc), 0.0f);
}

// Interpolated corner normals and colours for the lanes of `lanes`, and the triangles' extents. World space,
// unit. `lift`: smooth_lift() in the world.
NEVER_INLINE REAL3 shading_normals(const Scene* scene, u32 index, const Hits* hits, MASK entering, MASK lanes,
                                   REAL3* color, REAL* extent, REAL* lift) {
  REAL3 normal = hits->ng;
  EACH_LANE(i, lanes) {
    __global const TriangleShading* triangle = scene->triangles + MASK_LANE(hits->prim, i);
    const Vertex a = scene->vertices[triangle->vertex[0]], b = scene->vertices[triangle->vertex[1]],
                 c = scene->vertices[triangle->vertex[2]];
    REAL_LANE(*extent, i) = triangle->extent;
    const float u = REAL_LANE(hits->u, i), v = REAL_LANE(hits->v, i), w = 1.0f - u - v;
    set3(color, i, w * (float3)(a.r, a.g, a.b) + u * (float3)(b.r, b.g, b.b) + v * (float3)(c.r, c.g, c.b));
    const float3 na = (float3)(a.nx, a.ny, a.nz), nb = (float3)(b.nx, b.ny, b.nz),
                 nc = (float3)(c.nx, c.ny, c.nz);
    const float3 n = w * na + u * nb + v * nc;
    set3(&normal, i, n);
    __global const TriangleBlock* block = scene->blocks + (triangle->place >> 3);
    const u32 lane = triangle->place & 7u;
    const float3 p0 = corner_of(block, 0u, lane);
    REAL_LANE(*lift, i) =
        sqrt(dot(n, n)) * smooth_lift(p0, corner_of(block, 1u, lane) - p0, corner_of(block, 2u, lane) - p0, u,
                                      v, MASK_LANE(entering, i) ? 1.0f : -1.0f, na, nb, nc);
  }
  normal = moved_normals(scene, index, world_normals(scene->instances + index, normal), time_of_hits(hits));
  *lift /= nonzero(length3(normal));
  return safe_unit3(normal);
}

// Turns a mesh's shading normals `ns` against the rays; the geometric normals if unusable. A normal facing
// away from the viewer would light the back of objects, so it is bent to the silhouette.
static inline REAL3 facing_normals(REAL3 ns, REAL3 ng, MASK entering, REAL3 d) {
  const REAL3 facing = select3(negate3(ns), ns, entering);
  const REAL towards = dot3(facing, d);
  const REAL3 bent = safe_unit3(along3(facing, -(towards + 1e-4f), d));
  const REAL3 normal = select3(bent, facing, MASK_OF(towards < 0.0f));
  return select3(ng, normal, MASK_OF(dot3(facing, facing) > 0.0f));
}

#if HAS_SDF
// Field colours of instance `index` where the world rays (o, d) hit it, at the distances t.
NEVER_INLINE REAL3 field_colors(const Scene* scene, u32 index, const REAL3* o, const REAL3* d, REAL t) {
  __global const Instance* instance = scene->instances + index;
  const REAL3 p = along3(field_points(instance, *o), t, object_vectors(instance, *d));
  return sdf_color(scene, instance->root, p);
}
#endif

// Sets texture data of the hits of `lanes`, at the points s->p.
static inline void locate(const Scene* scene, const Hits* hits, MASK lanes, SurfaceInteractions* s) {
  HAVING(HAS_UV, find_coordinates(scene, hits, &s->p, lanes, &s->at);)
  HAVING(HAS_MAPS, s->prim = hits->prim; s->b = hits->u; s->c = hits->v;)
  HAVING(HAS_PARALLAX, s->shift = s->top = all3((float3)(0.0f)); s->sunk = s->below = (REAL)(0.0f);)
}

// Vertex colours apply if the material says so, field colours always.
static inline MASK has_color(const Faces* faces, MASK on_field) {
  return on_field | MASK_OF((faces->flags & (int)MATERIAL_VERTEX_COLOR) != 0);
}

// The interactions of the rays (o, d) at the hits of `lanes`.
static inline void interact(const Scene* scene, REAL3 o, REAL3 d, const Hits* hits, const Faces* faces,
                            MASK lanes, SurfaceInteractions* s) {
  const REAL3 outward = safe_unit3(faces->outward), white = all3((float3)(1.0f));
  s->ng = select3(negate3(outward), outward, faces->entering);
  s->ns = s->side = s->ng;
  s->lift = (REAL)(0.0f);
  s->p = along3(o, hits->t, d);
  s->instance = hits->instance;
  s->material = faces->material;
  s->flags = faces->flags;
  s->medium = faces->medium;
  s->entering = faces->entering;
  HAVING(HAS_OBJECT_MOTION, s->time = hits->time;)
  REAL extent = (REAL)(0.0f), turned = extent, rounding = extent;
  REAL3 color = white;
  MASK on_field = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(hits->instance, &left, &index);
    __global const Instance* instance = scene->instances + index;
    turned = select(turned, (REAL)(moved_extent(scene, index)), mine);
    if (!(HAS_SDF && instance->shape == SHAPE_SDF))
      rounding = select(rounding, space_rounding(instance, hits->ng), mine);
    if (HAS_SPHERE && instance->shape == SHAPE_SPHERE)
      s->p = select3(s->p, settle_on_sphere(scene, index, s), mine);
    if (HAS_MESH && instance->shape == SHAPE_MESH) {
      REAL lift = s->lift;
      const REAL3 ns = shading_normals(scene, index, hits, faces->entering, mine, &color, &extent, &lift);
      s->ns = select3(s->ns, facing_normals(ns, s->ng, faces->entering, d), mine);
      const MASK smooth =
          mine & MASK_OF(lift >= 0.0f) & MASK_OF((faces->flags & (int)MATERIAL_TRANSMITS) == 0);
      s->side = select3(s->side, s->ns, smooth);
      s->lift = select(s->lift, lift, smooth);
    }
#if HAS_SDF
    if (instance->shape == SHAPE_SDF) {
      const REAL3 still = still_origins(hits, index, o), way = still_directions(hits, index, d);
      color = select3(color, field_colors(scene, index, &still, &way, hits->t), mine);
      on_field |= mine;
    }
#endif
  }
  s->color = select3(white, color, has_color(faces, on_field));
  rounding = real_max(rounding, extent * greatest_size(hits->ng));
  s->offset = real_max(rounding_offset(rounding, faces->outward), offset_distance(o, s->p, turned));
  locate(scene, hits, lanes, s);
}

// Sets the surfaces' footprints: the longer axis of the ellipse in which the pixel's cone meets the surface
// (Akenine-Moeller and others 2019, "Texture Level of Detail Strategies for Real-Time Ray Tracing").
static inline void set_footprints(const Scene* scene, const SceneRays* rays, REAL t, SurfaceInteractions* s) {
#if HAS_CONES || HAS_CHECKER
  const REAL cosine = real_max(fabs(dot3(s->ng, rays->d)), (REAL)(0.01f));
#endif
#if HAS_CONES
  s->footprint = fabs(fma(t, rays->cone_spread, rays->cone_width)) / cosine;
#else
  HAVING(HAS_MAPS, s->footprint = (REAL)(0.0f);)
#endif
  HAVING(HAS_CHECKER, s->camera_footprint = t * sample_spread(scene->info) / cosine;)
}
