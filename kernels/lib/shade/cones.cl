// Curvature of surfaces, by which reflection and refraction change pixel cones (Akenine-Moeller and others
// 2021, "Improved Shader and Texture Level of Detail Using Ray Cones"). Behind its focus a cone's width is
// negative.
#pragma once
#include "lib/shade/bsdf.cl"
#include "plain/shade/cones.cl"

#if HAS_CONES && HAS_SECONDARY
// Curvature at triangle hits of `lanes`: how their corners' normals turn along the edges, the mean of the
// three.
static inline REAL triangle_curvatures(const Scene* scene, const SurfaceInteractions* s, MASK lanes) {
  REAL curvature = (REAL)(0.0f);
  EACH_LANE(i, lanes) {
    __global const TriangleShading* triangle = scene->triangles + MASK_LANE(s->prim, i);
    __global const TriangleBlock* block = scene->blocks + (triangle->place >> 3);
    float sum = 0.0f;
    for (u32 a = 0; a < 3u; ++a) {
      const u32 b = a == 2u ? 0u : a + 1u;
      const Vertex from = scene->vertices[triangle->vertex[a]], to = scene->vertices[triangle->vertex[b]];
      const float3 edge =
          corner_of(block, b, triangle->place & 7u) - corner_of(block, a, triangle->place & 7u);
      const float turn = dot((float3)(to.nx - from.nx, to.ny - from.ny, to.nz - from.nz), edge);
      sum += turn / fmax(dot(edge, edge), 1e-30f);
    }
    REAL_LANE(curvature, i) = sum * (1.0f / 3.0f);
  }
  return curvature;
}

// Curvature as seen by the rays, in world space: positive for surfaces that bulge towards them.
static inline REAL curvatures(const Scene* scene, const SurfaceInteractions* s, MASK lanes) {
  REAL curvature = (REAL)(0.0f);
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->instance, &left, &index);
    __global const Instance* instance = scene->instances + index;
    const float4 scale = instance->pattern_scale;
    const float size = cbrt(scale.x * scale.y * scale.z) / scale.w;  // per unit of object space, in the world
    const REAL own = HAS_MESH && instance->shape == SHAPE_MESH
                         ? triangle_curvatures(scene, s, mine)
                         : solid_curvatures(scene, instance->shape, instance->parameters,
                                            points_of(scene, index, s, s->p), s->prim);
    curvature = select(curvature, own * (1.0f / size) / moved_size(scene, index, time_of(s)), mine);
  }
  return select(-curvature, curvature, s->entering);
}
#endif
