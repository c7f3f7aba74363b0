// From raw hits to what shading needs: position, normals, material, pattern. A ray a lane.
#ifndef SUNDOG_LIB_SURFACE_CL
#define SUNDOG_LIB_SURFACE_CL
#include "lib/hits.cl"
#include "lib/tables.h"
#include "lib/transform.cl"

// Which side of what a ray hit.
typedef struct Faces {
  REAL3 outward;       // world, not normalised; its sign against the direction tells entering from leaving
  MASK entering;       // the ray comes from outside
  MASK material;       // index
  MASK flags, medium;  // of the material
} Faces;

typedef struct Surfaces {
  REAL3 p;                 // world
  REAL3 ng, ns;            // unit, both against the ray
  REAL offset;             // distance off the surface at which a further ray starts
  REAL3 ambient, diffuse;  // with pattern and vertex colour
} Surfaces;

// The faces of the hits of `lanes`.
static inline Faces hit_faces(const Scene* scene, REAL3 d, const Hits* hits, MASK lanes) {
  Faces faces;
  faces.outward = hits->ng;
  faces.material = NO_LANES;
  faces.flags = NO_LANES;
  faces.medium = NO_LANES;
  u32 index;
  for (MASK left = lanes; any_lane(left);) {
    const MASK mine = take_alike(hits->instance, &left, &index);
    __global const Instance* instance = scene->instances + index;
    if (!(instance->flags & INSTANCE_IDENTITY))
      faces.outward = select3(faces.outward, world_normals(instance, hits->ng), mine);
    if (instance->material != NO_MATERIAL)
      faces.material = select(faces.material, (MASK)((int)instance->material), mine);
    else
      for (u32 bits = lane_bits(mine); bits; bits &= bits - 1u) {
        const u32 i = lowest_bit(bits);
        MASK_LANE(faces.material, i) = (int)scene->triangles[MASK_LANE(hits->prim, i)].material;
      }
  }
  for (MASK left = lanes; any_lane(left);) {
    const MASK mine = take_alike(faces.material, &left, &index);
    faces.flags = select(faces.flags, (MASK)((int)scene->materials[index].flags), mine);
    faces.medium = select(faces.medium, (MASK)((int)scene->materials[index].medium), mine);
  }
  faces.entering = MASK_OF(dot3(faces.outward, d) < 0.0f);
  return faces;
}

static inline REAL greatest_size(REAL3 a) { return greatest3(real3(fabs(a.x), fabs(a.y), fabs(a.z))); }

// How far from the surface a new ray must start: a few of the float's spacings at the magnitudes that made
// the position (the idea of Waechter and Binder 2019, without their absolute threshold, so that a scene works
// in any unit).
static inline REAL offset_distance(REAL3 o, REAL3 p) {
  return real_max(greatest_size(o), greatest_size(p)) * 0x1p-19f;
}

// The same on triangles: corners that are far away round the hit as well, in the mesh's space. `normal` is
// the normal there and `outward` in the world: the quotient of their lengths takes what is measured along it
// to the world.
static inline REAL triangle_offset(REAL extent, REAL3 normal, REAL3 outward) {
  return extent * 0x1p-21f * greatest_size(normal) / nonzero(greatest_size(outward));
}

static inline MASK odd_cell(REAL3 p, float frequency) {
  // Half a cell in 2^16 off the lattice, so that a face on a cell's border is one colour.
  const REAL3 cell = real3(floor(p.x * frequency + 0x1p-17f), floor(p.y * frequency + 0x1p-17f),
                           floor(p.z * frequency + 0x1p-17f));
  const REAL parity = cell.x + cell.y + cell.z;
  return MASK_OF(parity - 2.0f * floor(parity * 0.5f) != 0.0f);
}

// Takes positions on a sphere onto its surface by one Newton step; rounding of t is largest for far origins.
static inline REAL3 settle_on_sphere(__global const Instance* instance, REAL3 p) {
  const REAL3 q = object_points(instance, p);
  const REAL3 gradient = world_normals(instance, q);
  return along3(p, -0.5f * (dot3(q, q) - 1.0f) / dot3(gradient, gradient), gradient);
}

// Normals of the corners and their colours, interpolated, for the lanes of `lanes`, and the triangles'
// extents. World space, unit.
NEVER_INLINE REAL3 shading_normals(const Scene* scene, __global const Instance* instance, const Hits* hits,
                                   MASK lanes, REAL3* color, REAL* extent) {
  REAL3 normal = hits->ng;
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    __global const TriangleShading* triangle = scene->triangles + MASK_LANE(hits->prim, i);
    const Vertex a = scene->vertices[triangle->vertex[0]], b = scene->vertices[triangle->vertex[1]],
                 c = scene->vertices[triangle->vertex[2]];
    REAL_LANE(*extent, i) = triangle->extent;
    const float u = REAL_LANE(hits->u, i), v = REAL_LANE(hits->v, i), w = 1.0f - u - v;
    set3(color, i, w * (float3)(a.r, a.g, a.b) + u * (float3)(b.r, b.g, b.b) + v * (float3)(c.r, c.g, c.b));
    set3(&normal, i,
         w * (float3)(a.nx, a.ny, a.nz) + u * (float3)(b.nx, b.ny, b.nz) + v * (float3)(c.nx, c.ny, c.nz));
  }
  return safe_unit3(world_normals(instance, normal));
}

// Shading normals `ns` of a mesh, turned against the rays; the geometric ones where they say nothing. One
// that is turned from the viewer would light the back of things: it is bent no further than the silhouette.
static inline REAL3 facing_normals(REAL3 ns, REAL3 ng, MASK entering, REAL3 d) {
  const REAL3 facing = select3(negate3(ns), ns, entering);
  const REAL towards = dot3(facing, d);
  const REAL3 bent = safe_unit3(along3(facing, -(towards + 1e-4f), d));
  const REAL3 normal = select3(bent, facing, MASK_OF(towards < 0.0f));
  return select3(ng, normal, MASK_OF(dot3(facing, facing) > 0.0f));
}

// Ambient and diffuse colours of the lanes of `lanes`, all of one material.
static inline void color_surfaces(__global const Material* material, __global const Instance* instance,
                                  MASK lanes, Surfaces* s) {
  s->ambient = select3(s->ambient, all3(material->ambient.xyz), lanes);
  s->diffuse = select3(s->diffuse, all3(material->diffuse.xyz), lanes);
  if (!(material->flags & MATERIAL_CHECKER)) return;
  const REAL3 q = multiply3(object_points(instance, s->p), all3(instance->pattern_scale.xyz));
  const MASK odd = lanes & odd_cell(q, material->checker_diffuse.w);
  s->ambient = select3(s->ambient, all3(material->checker_ambient.xyz), odd);
  s->diffuse = select3(s->diffuse, all3(material->checker_diffuse.xyz), odd);
}

// The surfaces at the hits of `lanes`.
static inline void interact(const Scene* scene, REAL3 o, REAL3 d, const Hits* hits, const Faces* faces,
                            MASK lanes, Surfaces* s) {
  const REAL3 outward = safe_unit3(faces->outward);
  s->ng = select3(negate3(outward), outward, faces->entering);
  s->ns = s->ng;
  s->p = along3(o, hits->t, d);
  REAL extent = (REAL)(0.0f);
  REAL3 color = all3((float3)(1.0f));
  MASK colored = MASK_OF((faces->flags & (int)MATERIAL_VERTEX_COLOR) != 0);
  u32 index;
  for (MASK left = lanes; any_lane(left);) {
    const MASK mine = take_alike(hits->instance, &left, &index);
    __global const Instance* instance = scene->instances + index;
#if HAS_SPHERE
    if (instance->shape == SHAPE_SPHERE) s->p = select3(s->p, settle_on_sphere(instance, s->p), mine);
#endif
#if HAS_MESH
    if (instance->shape == SHAPE_MESH) {
      const REAL3 ns = shading_normals(scene, instance, hits, mine, &color, &extent);
      const MASK smooth = mine & MASK_OF((faces->flags & (int)MATERIAL_FLAT) == 0);
      s->ns = select3(s->ns, facing_normals(ns, s->ng, faces->entering, d), smooth);
    }
#endif
#if HAS_SDF
    if (instance->shape == SHAPE_SDF) {
      color = select3(color, real3(hits->u, hits->v, AS_REAL(hits->prim)), mine);
      colored |= mine;
    }
#endif
    u32 material;
    for (MASK alike = mine; any_lane(alike);) {
      const MASK of_material = take_alike(faces->material, &alike, &material);
      color_surfaces(scene->materials + material, instance, of_material, s);
    }
  }
  s->offset = real_max(triangle_offset(extent, hits->ng, faces->outward), offset_distance(o, s->p));
  if (any_lane(colored & lanes)) {
    s->ambient = select3(s->ambient, multiply3(s->ambient, color), colored);
    s->diffuse = select3(s->diffuse, multiply3(s->diffuse, color), colored);
  }
}

#endif
