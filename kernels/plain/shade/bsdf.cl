// The Bsdf of a surface between two media.
#include "plain/shade/maps.cl"

// The checkerboard. It is fixed in the instance's space, and filtered by the footprint of a camera ray of the
// same length, so that kernels without cones draw the same.
HAVING(HAS_CHECKER)
static inline float odd_cells(UNIFORM const Scene* scene, UNIFORM float frequency,
                              const SurfaceInteraction* s) {
  float odd = 0.0f;
  EACH_ALIKE(u32, index, (u32)s->instance) {
    const float4 scale = scene->instances[index].pattern_scale;
    const float3 q = points_at(scene, index, s->p, time_of(s)) * scale.xyz * frequency;
    const float3 n = safe_unit3(vectors_at(scene, index, s->ng, time_of(s)) * scale.xyz);
    const float width = s->camera_footprint * (frequency * scale.w) / moved_size(scene, index, time_of(s));
    odd = checker_pattern(q, sines_to_axes(n) * width);
  }
  return odd;
}

// Sets the frame about ns, with the tangent along `first`, turned towards `second`.
HAVING(HAS_LAYERS)
static inline void turn_frame(UNIFORM __global const Layers* m, float3 first, float3 second, Bsdf* bsdf) {
  const float3 flat = along(first, -dot(first, bsdf->ns), bsdf->ns);
  float3 s, t;
  tangent_frame(bsdf->ns, &s, &t);
  const float3 u = dot(flat, flat) > 1e-20f * dot(first, first) ? safe_unit3(flat) : s;
  const float3 v = cross(bsdf->ns, u);
  const float turn_y = dot(v, second) < 0.0f ? -m->turn_y : m->turn_y;
  bsdf->tangent = along(u * m->turn_x, turn_y, v);
  bsdf->bitangent = along(v * m->turn_x, -turn_y, u);
}

// A replacement for the diffuse term in layered materials (shared/layers.h).
HAVING(HAS_LAYERS)
static inline void add_layers(UNIFORM const Scene* scene, const SurfaceInteraction* s, Bsdf* bsdf) {
  const bool outside = s->entering || (bsdf->flags & (int)MATERIAL_THIN) != 0;
  const float3 base = bsdf->diffuse * (1.0f / real_max(bsdf->there, 1e-6f));
  bsdf->base = (float3)(real_min(base.x, 1.0f), real_min(base.y, 1.0f), real_min(base.z, 1.0f));
  bsdf->tangent = (float3)(0.0f);
  bsdf->bitangent = (float3)(0.0f);
  bsdf->coated = false;
  bsdf->coated_behind = false;
  if ((bsdf->flags & (int)MATERIAL_LAYERED) == 0) return;
  bsdf->diffuse = (float3)(0.0f);
  bsdf->coated = outside;
  bsdf->coated_behind = !outside;
  float3 first = (float3)(0.0f), second = first;
  if (HAS_UV) {
    first = s->at.dpdu;
    second = s->at.dpdv;
  }
  EACH_ALIKE(u32, index, (u32)bsdf->material) turn_frame(scene->layers + index, first, second, bsdf);
}

ENTRY static inline Bsdf make_bsdfs(UNIFORM const Scene* scene, const SurfaceInteraction* s, int before,
                                    int after) {
  Bsdf bsdf;
  bsdf.side = s->side;
  bsdf.ns = s->ns;
  bsdf.material = s->material;
  bsdf.flags = s->flags;
  bsdf.before = before;
  bsdf.after = after;
  if (HAS_DISPERSION) bsdf.row = 0.0f;
  if (HAS_MAPS) bsdf.emission = (float3)(1.0f);
  if (HAS_OPACITY) bsdf.there = 1.0f;
  if (HAS_COAT_MAPS) bsdf.coat = 1.0f;
  if (HAS_FUZZ_MAPS) bsdf.fuzz = (float3)(1.0f);
  if (HAS_SPECULAR_MAPS) bsdf.tint = (float3)(1.0f);
  EACH_ALIKE(u32, index, (u32)s->material) {
    __global const Material* material = scene->materials + index;
    bsdf.ambient = material->ambient.xyz;
    bsdf.diffuse = material->diffuse.xyz;
    if (HAS_CHECKER && (material->flags & MATERIAL_CHECKER) != 0u) {
      const float odd = odd_cells(scene, material->checker_diffuse.w, s);
      bsdf.ambient = along(bsdf.ambient * (1.0f - odd), odd, material->checker_ambient.xyz);
      bsdf.diffuse = along(bsdf.diffuse * (1.0f - odd), odd, material->checker_diffuse.xyz);
    }
    if (HAS_LAYER_MAPS && (material->flags & MATERIAL_LAYERED) != 0u) {
      bsdf.metalness = scene->layers[index].specular.w;
      bsdf.roughness = scene->layers[index].roughness;
      bsdf.glass = scene->layers[index].glass;
    }
  }
  bsdf.ambient *= s->color;
  bsdf.diffuse *= s->color;
  if (HAS_MAPS) {
    bool mapped = false;
    EACH_ALIKE(u32, index, (u32)s->material) {
      __global const Material* material = scene->materials + index;
      bsdf.specular = material->specular.xyz;
      bsdf.reflection = material->reflection.xyz;
      bsdf.transmission = material->transmission.xyz;
      bsdf.exponent = material->specular.w;
      mapped = material->maps != NO_MAPS;
    }
    if (mapped) map_bsdf(scene, s, &bsdf);
  }
  if (HAS_MAPS && HAS_RELIEF) widen_highlight(s->even, &bsdf.exponent, &bsdf.specular);
  if (HAS_LAYERS) add_layers(scene, s, &bsdf);
  return bsdf;
}
