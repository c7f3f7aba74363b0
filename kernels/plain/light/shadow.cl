// How much of a light arrives. Media absorb. Opaque scenes end at the first occluder; else transmissive
// things are filters: each interface lets its transmission through (1 - F of a dielectric, on the straight
// line).
#include "plain/path/segment.cl"
#include "plain/shade/layers.cl"
#include "plain/shade/shading.cl"
#include "plain/shade/specular.cl"

#define MAX_FILTERS 64

bool any_hits(UNIFORM const Scene* scene, SceneRay* ray, HERE, UNIFORM bool coherent, UNIFORM u32* counts);
void nearest_to_light(UNIFORM const Scene* scene, SceneRay* ray, HERE, UNIFORM bool coherent, SurfaceHit* hit,
                      UNIFORM u32* counts);

// A dielectric interface's transmittance for straight light between two media. The straight ray stands for
// one that bends, whose slant is this one in the rarer medium: a pane at any angle then loses (1 - F)^2, and
// nothing to a total reflection that the bent ray would not meet.
static inline float transmittance_interface(UNIFORM const Scene* scene, const Face* face, int here, int there,
                                            float cosine) {
  const float ratio = relative_index(scene->media, here, there), eta = real_max(ratio, 1.0f / ratio);
  const float left = 1.0f - fresnel_reflectance(cosine, refracted_cosine(cosine, eta), eta);
  if (!HAS_THIN_WALLS) return left;
  return 1.0f - reflected_by_walls(scene, face->material, face->flags, cosine, 1.0f - left);
}

// The transmittance of a surface with its textures; `plain`: without.
HAVING(HAS_MAPS)
static float3 textured_filter(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceHit* hit,
                              const Face* face, float3 plain) {
  SurfaceInteraction s;
  locate(scene, hit, along(ray->o, hit->t, ray->d), &s);
  s.ng = safe_unit3(face->outward);
  s.ns = s.ng;
  s.side = s.ng;
  s.instance = hit->instance;
  s.material = face->material;
  set_footprints(scene, ray, hit->t, &s);
  // A surface has one side: where paths meet lights by chance as well, a shadow ray sees the side that it
  // comes to, as those do; else the one that the light comes to.
  bool hidden = face->entering;
  if (HAS_PATHS) hidden = !face->entering;
  return mapped_filter(scene, &s, hidden, plain);
}

// The transmittance of a surface for straight light with its fuzz and coats; `through`: without.
HAVING(HAS_LAYERED_FILTERS)
static float3 transmittance_layers(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceHit* hit,
                                   const Face* face, float3 through) {
  SurfaceInteraction s;
  interact(scene, ray->o, ray->d, hit, face, &s);
  set_footprints(scene, ray, hit->t, &s);
  const Bsdf bsdf = make_bsdfs(scene, &s, 0, 0);
  return passed_by_layers(scene, &bsdf, real_clamp(-dot(bsdf.ns, ray->d), 0.0f, 1.0f), through);
}

// `light` behind the surface, between the media `here` and `there`.
static inline float3 filtered(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceHit* hit,
                              const Face* face, int here, int there, float3 light) {
  float3 passed = (float3)(1.0f);
  bool dielectric = false;
  EACH_ALIKE(int, index, face->material) {
    __global const Material* material = scene->materials + index;
    passed = material->transmission.xyz;
    dielectric = material->kind == MATERIAL_DIELECTRIC;
  }
  if (HAS_MAPS) {
    bool mapped = false;
    EACH_ALIKE(int, index, face->material) mapped = scene->materials[index].maps != NO_MAPS;
    if (mapped) passed = textured_filter(scene, ray, hit, face, passed);
  }
  if (HAS_LAYERED_FILTERS && (face->flags & (int)MATERIAL_LAYERED) != 0)
    passed = transmittance_layers(scene, ray, hit, face, passed);
  if (!dielectric) return light * passed;
  const float cosine = real_min(fabs(dot(safe_unit3(face->outward), ray->d)), 1.0f);
  return light * passed * transmittance_interface(scene, face, here, there, cosine);
}

// The shadow ray at its next hit. Whether it continues to the light, with the rest of it in `light`.
static inline bool pass_filter(UNIFORM const Scene* scene, SceneRay* ray, SurfaceHit* hit, float3* light,
                               UNIFORM u32* counts) {
  int here = 0;
  if (HAS_MEDIA) here = current_media(scene->media, ray);
  int there = here;
  if (!hit_anything(hit)) {
    if (HAS_MEDIA) *light *= absorb(scene->media, here, hit->t - ray->since);
    return false;
  }
  Face face = hit_faces(scene, ray->d, hit);
  if (HAS_MEDIA) pass_interface(scene, ray, hit, &face, counts);
  const int kind = (int)(MATERIAL_TRANSMITS | MATERIAL_SHADOW_OPAQUE);
  if ((face.flags & kind) != (int)MATERIAL_TRANSMITS) {
    *light = (float3)(0.0f);
    return false;
  }
  bool filters = true;  // touching ones between the same media do not
  if (HAS_MEDIA && (face.flags & (int)MATERIAL_THIN) == 0) {
    there = current_media(scene->media, ray);
    filters = there != here;
    if (filters) {
      *light *= absorb(scene->media, here, hit->t - ray->since);
      ray->since = hit->t;
    }
  }
  if (filters) *light = filtered(scene, ray, hit, &face, here, there, *light);
  continue_behind(scene->info, ray, hit, face.entering);
  return greatest(*light) > 0.0f;
}

// `light` after the medium on the way to it, where nothing blocks it.
static inline float3 unblocked(UNIFORM const Scene* scene, const SceneRay* ray, float3 light) {
  if (HAS_MEDIA) return light * absorb(scene->media, current_media(scene->media, ray), ray->t_max);
  return light;
}

// Whether the ray has passed as many filters as it may.
static inline bool passed_most(const SceneRay* ray, UNIFORM u32* counts) {
  if (HAS_CROSSINGS && ray->crossings >= MAX_FILTERS) {
    count(counts, COUNT_SHADOW_LIMIT);
    return true;
  }
  return false;
}

// The part of `light` that arrives at the end of the shadow ray, taken all the way there.
static inline float3 light_arriving(UNIFORM const Scene* scene, SceneRay* ray, float3 sent,
                                    UNIFORM u32* counts) {
  float3 light = sent;
  if (!HAS_SHADOW_FILTERS) {
    if (any_hits(scene, ray, false, counts)) return (float3)(0.0f);
    return unblocked(scene, ray, light);
  }
  for (;;) {
    SurfaceHit hit;
    nearest_to_light(scene, ray, false, &hit, counts);
    if (!pass_filter(scene, ray, &hit, &light, counts)) return light;
    if (passed_most(ray, counts)) return (float3)(0.0f);
  }
}
