// Light that the rays of paths meet: what shines on surfaces, the sky, and what lies on the way.
#include "plain/light/choose_light.cl"
#include "plain/pathtracer/light_parts.cl"
#include "plain/pathtracer/mis.cl"

// The density with which path->from chooses the light `lamp` at the point p, which the ray met in the
// direction d.
HAVING(HAS_AREA_LIGHTS)
static float chosen_pdf(UNIFORM const Scene* scene, const PathState* path, float3 d, float3 p, int lamp) {
  const float distance = length(p - path->from);
  float pdf = 0.0f;
  EACH_ALIKE(int, index, lamp) {
    __global const Light* light = scene->lights + index;
    if (light->position.w == 0.0f) {
      pdf = area_light_pdf(light, path->from, d, distance);
      if (HAS_LIGHT_TREE) pdf *= light_probability(scene, scene->light_leaves[index], chosen_from(path));
      pdf = pdf_on_segment_to(path, light, pdf);
    }
  }
  return pdf / (float)scene->info->light_count;
}

// The light that an instance shows where it was hit: a mesh may have one a triangle.
HAVING(HAS_AREA_LIGHTS)
static inline int light_of_instance(UNIFORM const Scene* scene, UNIFORM int index, int prim) {
  const u32 first = scene->instances[index].light;
  if (first == NO_LIGHT || scene->instances[index].shape != SHAPE_MESH) return (int)first;
  return prim + (int)(first - scene->instances[index].first_prim);
}

// The surface's light with the weight that it has where it is a light to choose, too.
HAVING(HAS_AREA_LIGHTS)
static inline float3 weighed_emission(UNIFORM const Scene* scene, const PathState* path, float3 d,
                                      const SurfaceHit* hit, const SurfaceShading* at, float3 light) {
  int lamp = (int)NO_LIGHT;
  EACH_ALIKE(int, index, at->s.instance) lamp = light_of_instance(scene, index, hit->prim);
  if (lamp == (int)NO_LIGHT) return light;
  const float3 left = left_by_photons(path, light);
  if (!(path->pdf > 0.0f)) return left;
  return left * weight_of_met(scene, path, chosen_pdf(scene, path, d, at->s.p, lamp));
}

// The surface's emission, on its outside.
HAVING(HAS_EMISSION)
static inline float3 met_surface(UNIFORM const Scene* scene, const PathState* path, const SceneRay* ray,
                                 const SurfaceHit* hit, const SurfaceShading* at) {
  if ((at->bsdf.flags & (int)MATERIAL_EMITS) == 0 || !at->s.entering) return (float3)(0.0f);
  float3 light = (float3)(0.0f);
  EACH_ALIKE(int, index, at->s.material) light = scene->materials[index].emission.xyz;
  if (HAS_MAPS) light *= at->bsdf.emission;
  if (HAS_AREA_LIGHTS) light = weighed_emission(scene, path, ray->d, hit, at, light);
  return light;
}

// The radiance of a ray that meets nothing: sky_along() with the weight of each part.
HAVING(HAS_SKY)
static inline float3 met_lit_sky(UNIFORM const Scene* scene, const PathState* path, float3 d) {
  const float chance = 1.0f / (float)max(scene->info->light_count, 1u);
  const bool camera = path->depth == 1;
  float pdf;
  float3 light = distant_along(scene, d, &pdf);
  if (sees_environment(scene)) {
    light *= weight_of_met(scene, path, pdf_on_segment(path, pdf * chance));
    light = hide_environment(scene, d, left_by_photons(path, light), camera);
  }
  if (HAS_AREA_LIGHTS)
    for (u32 index = 0; index < scene->info->table_lights; ++index) {
      __global const Light* lamp = scene->lights + index;
      if (is_in_sky(lamp)) {
        const float weight = weight_of_met(scene, path, pdf_on_segment(path, sky_light_pdf(lamp, chance)));
        light = along(light, weight, left_by_photons(path, sky_light_radiance(lamp, d, camera)));
      }
    }
  return light;
}
// Moves the light of suns that lie in the direction d, and are of another group than the environment, to
// their groups. Returns the environment's, for the whole of met_sky().
HAVING(HAS_LIGHT_GROUPS)
static int note_suns(UNIFORM const Scene* scene, PathState* path, float3 d) {
  int around = NO_LIGHT_GROUP;
  if (HAS_ENVIRONMENT) around = (int)scene->environments->ahead.w;
  if (HAS_SKY && HAS_AREA_LIGHTS) {
    const float chance = 1.0f / (float)max(scene->info->light_count, 1u);
    const bool shown = !(path->straight && scene->info->transparent != 0u);
    for (u32 index = 0; index < scene->info->table_lights; ++index) {
      __global const Light* lamp = scene->lights + index;
      if (is_in_sky(lamp) && (int)lamp->color.w != around) {
        const float weight = weight_of_met(scene, path, pdf_on_segment(path, sky_light_pdf(lamp, chance)));
        const float3 seen = left_by_photons(path, sky_light_radiance(lamp, d, path->depth == 1));
        SampledSpectrum light = path->throughput * spectrum_of(&path->wavelengths, seen * weight);
        if (!shown) light = (SampledSpectrum)(0.0f);
        note_group(path, (int)lamp->color.w, light);
        note_group(path, around, (SampledSpectrum)(0.0f) - light);
      }
    }
  }
  return around;
}

static inline float3 met_sky(UNIFORM const Scene* scene, const PathState* path, float3 d) {
  if (HAS_SKY)
    return met_lit_sky(scene, path, d);
  else
    return background_along(scene->info, d);
}

// The world's fog, for rays that were not inside anything: what it adds, and what it takes from all behind
// it.
HAVING(HAS_FOG)
static inline SampledSpectrum met_fog(UNIFORM const Scene* scene, const Encounter* met, PathState* path) {
  const float clear = real_max(clear_of_fog(scene, met), 0x1p-60f);  // it can be undone
  const SampledSpectrum color = spectrum_of(&path->wavelengths, scene->info->fog.xyz);
  const SampledSpectrum light = path->throughput * (1.0f - clear) * color;
  path->throughput *= clear;
  path->unfog /= clear;
  return light;
}
