// From a raw Hit to what shading needs: position, normals, material, pattern.
#ifndef SUNDOG_LIB_SURFACE_CL
#define SUNDOG_LIB_SURFACE_CL
#include "lib/config.h"
#include "lib/tables.h"
#include "lib/transform.cl"

typedef struct SurfaceInteraction {
  float3 p;       // world
  float3 ng, ns;  // unit, both against the ray
  float offset;   // distance off the surface at which a further ray starts
  u32 material;
  bool entering;            // the ray comes from outside
  float3 ambient, diffuse;  // with pattern and vertex colour
} SurfaceInteraction;

static inline u32 hit_material(TRACE_PARAMETERS, SHADE_PARAMETERS, const Hit* hit) {
  const u32 material = instances[hit->instance].material;
  return material != NO_MATERIAL ? material : triangles[hit->prim].material;
}

// The outward geometric normal in world space, not normalised; its sign against d tells entering from
// leaving.
static inline float3 outward_normal(TRACE_PARAMETERS, const Hit* hit) {
  return world_normal(instances + hit->instance, (float3)(hit->ng_x, hit->ng_y, hit->ng_z));
}

// How far from the surface a new ray must start: a few of the float's spacings at the magnitudes that made
// the position (the idea of Waechter and Binder 2019, without their absolute threshold, so that a scene works
// in any unit).
static inline float offset_distance(float3 o, float3 p) {
  const float3 m = fmax(fabs(o), fabs(p));
  return fmax(m.x, fmax(m.y, m.z)) * 0x1p-19f;
}

static inline bool odd_cell(float3 p, float frequency) {
  // Half a cell in 2^16 off the lattice, so that a face on a cell's border is one colour.
  const float3 cell = floor(p * frequency + 0x1p-17f);
  const float parity = cell.x + cell.y + cell.z;
  return parity - 2.0f * floor(parity * 0.5f) != 0.0f;
}

// Takes the position of a solid's hit onto its surface by one Newton step; rounding of t is largest for far
// origins.
static inline float3 settle_on_solid(__global const Instance* instance, float3 p) {
  if (instance->shape != SHAPE_SPHERE) return p;
  const float3 q = object_point(instance, p);
  const float3 gradient = world_normal(instance, q);
  return p - gradient * (0.5f * (dot(q, q) - 1.0f) / dot(gradient, gradient));
}

static inline float3 shading_normal(SHADE_PARAMETERS, __global const Instance* instance, const Hit* hit,
                                    float3* color) {
  const TriangleShading triangle = triangles[hit->prim];
  const Vertex a = vertices[triangle.vertex[0]], b = vertices[triangle.vertex[1]],
               c = vertices[triangle.vertex[2]];
  const float u = hit->u, v = hit->v, w = 1.0f - u - v;
  *color = w * (float3)(a.r, a.g, a.b) + u * (float3)(b.r, b.g, b.b) + v * (float3)(c.r, c.g, c.b);
  return world_normal(instance, w * (float3)(a.nx, a.ny, a.nz) + u * (float3)(b.nx, b.ny, b.nz) +
                                    v * (float3)(c.nx, c.ny, c.nz));
}

static inline SurfaceInteraction interact(TRACE_PARAMETERS, SHADE_PARAMETERS, float3 o, float3 d,
                                          const Hit* hit) {
  SurfaceInteraction s;
  __global const Instance* instance = instances + hit->instance;
  s.material = hit_material(TRACE_ARGUMENTS, SHADE_ARGUMENTS, hit);
  __global const Material* material = materials + s.material;
  const float3 outward = unit(outward_normal(TRACE_ARGUMENTS, hit));
  s.entering = dot(outward, d) < 0.0f;
  s.ng = s.entering ? outward : -outward;
  s.p = settle_on_solid(instance, o + hit->t * d);
  s.offset = offset_distance(o, s.p);
  s.ns = s.ng;
  float3 color = (float3)(1.0f);
  if (instance->shape == SHAPE_MESH) {
    const float3 ns = unit(shading_normal(SHADE_ARGUMENTS, instance, hit, &color));
    const float3 facing = s.entering ? ns : -ns;
    // A shading normal turned from the viewer would light the back of things: bend it no further than the
    // silhouette.
    if (!(material->flags & MATERIAL_FLAT) && dot(facing, facing) > 0.0f) {
      const float towards = dot(facing, d);
      s.ns = towards < 0.0f ? facing : unit(facing - (towards + 1e-4f) * d);
    }
  }
#if HAS_SDF
  if (instance->shape == SHAPE_SDF) color = (float3)(hit->u, hit->v, as_float(hit->prim));
#endif
  s.ambient = material->ambient.xyz;
  s.diffuse = material->diffuse.xyz;
  if (material->flags & MATERIAL_CHECKER) {
    const float3 q = object_point(instance, s.p) * instance->pattern_scale.xyz;
    if (odd_cell(q, material->checker_diffuse.w)) {
      s.ambient = material->checker_ambient.xyz;
      s.diffuse = material->checker_diffuse.xyz;
    }
  }
  if ((material->flags & MATERIAL_VERTEX_COLOR) || instance->shape == SHAPE_SDF) {
    s.ambient *= color;
    s.diffuse *= color;
  }
  return s;
}

#endif
