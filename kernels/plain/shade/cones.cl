// Changes of pixel cones by reflection and refraction at curved surfaces (Akenine-Moeller and others 2021,
// "Improved Shader and Texture Level of Detail Using Ray Cones"). Behind its focus a cone's width is
// negative.
#include "plain/shade/interaction.cl"
#include "plain/shade/specular.cl"

// Neighbouring rays diverge by twice the angle between their normals.
ENTRY static inline void spread_reflected(float curvature, SceneRay* child) {
  if (HAS_CONES) child->cone_spread = fma(2.0f * curvature, child->cone_width, child->cone_spread);
}

// Snell's law for neighbouring rays perpendicular to the plane of incidence (Coddington's sagittal equation).
ENTRY static inline void spread_transmitted(float curvature, const Interface* interface, SceneRay* child) {
  if (HAS_CONES && interface->eta != 1.0f) {
    const float inverse = 1.0f / interface->eta, bend = interface->cos_t - interface->cos_i * inverse;
    child->cone_spread = fma(-curvature * bend, child->cone_width, child->cone_spread * inverse);
  }
}

// Curvature at a triangle's hit: how its corners' normals turn along the edges, the mean of the three.
HAVING(HAS_CONES)
static inline float triangle_curvature(UNIFORM const Scene* scene, int prim) {
  __global const TriangleShading* triangle = scene->triangles + prim;
  float sum = 0.0f;
  for (u32 a = 0; a < 3u; ++a) {
    const u32 b = a == 2u ? 0u : a + 1u;
    __global const Vertex* from = scene->vertices + triangle->vertex[a];
    __global const Vertex* to = scene->vertices + triangle->vertex[b];
    const float3 edge = corner_of(scene, triangle->place, b) - corner_of(scene, triangle->place, a);
    const float3 turn = (float3)(to->nx - from->nx, to->ny - from->ny, to->nz - from->nz);
    sum += plain_dot(turn, edge) / fmax(plain_dot(edge, edge), 1e-30f);
  }
  return sum * (1.0f / 3.0f);
}

// Curvature as seen by the ray, in world space: positive for surfaces that bulge towards it.
HAVING(HAS_CONES)
static inline float curvature_at(UNIFORM const Scene* scene, const SurfaceInteraction* s) {
  float curvature = 0.0f;
  EACH_ALIKE(u32, index, (u32)s->instance) {
    __global const Instance* instance = scene->instances + index;
    const float4 scale = instance->pattern_scale;
    const float size = cbrt(scale.x * scale.y * scale.z) / scale.w;  // per unit of object space, in the world
    float own = 0.0f;
    if (HAS_MESH && instance->shape == SHAPE_MESH)
      own = triangle_curvature(scene, s->prim);
    else
      own = solid_curvatures(scene, instance->shape, instance->parameters,
                             points_at(scene, index, s->p, time_of(s)), s->prim);
    curvature = own * (1.0f / size) / moved_size(scene, index, time_of(s));
  }
  return s->entering ? curvature : -curvature;
}
