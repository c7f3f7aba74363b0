// Whitted's rays: what they see on their way and at its end, and the rays that come of it.
#include "plain/light/sky.cl"
#include "plain/shade/shading.cl"
#include "plain/whitted/children.cl"

// The world's fog, for a ray that was not inside anything: what it adds, and what it takes from all behind
// it.
HAVING(HAS_FOG)
static inline float3 see_fog(UNIFORM const Scene* scene, const Encounter* met, WaitingRay* path) {
  const float clear = clear_of_fog(scene, met);
  const float3 light = path->throughput * (1.0f - clear) * scene->info->fog.xyz;
  path->throughput *= clear;
  return light;
}

// The background. A pixel that shows it straight on is covered less.
static inline float3 see_background(UNIFORM const Scene* scene, UNIFORM const TileSamples* tile,
                                    const SceneRay* ray, const WaitingRay* path) {
  const bool straight = is_straight(path);
  if (straight) uncover(tile, path->pixel, mean_of(path->throughput));
  const float3 light = path->throughput * sky_along(scene, ray->d, is_from_camera(path));
  return straight && scene->info->transparent != 0u ? (float3)(0.0f) : light;
}

// The surface's emission, on its outside.
HAVING(HAS_EMISSION)
static inline float3 see_emission(UNIFORM const Scene* scene, const WaitingRay* path,
                                  const SurfaceShading* at) {
  float3 light = (float3)(0.0f);
  if ((at->bsdf.flags & (int)MATERIAL_EMITS) != 0 && at->s.entering)
    EACH_ALIKE(int, index, at->s.material) light = scene->materials[index].emission.xyz;
  light = path->throughput * light;
  if (HAS_MAPS) light *= at->bsdf.emission;
  return light;
}

// The ambient light on a surface, less in the crevices of fields.
static inline float3 see_ambient(UNIFORM const Scene* scene, const SceneRay* ray, const WaitingRay* path,
                                 const Encounter* met, const SurfaceShading* at) {
  float3 ambient = at->bsdf.ambient * scene->info->ambient.xyz;
  if (HAS_OCCLUSION) ambient *= field_openness(scene, ray, &met->hit);
  return path->throughput * ambient;
}

// The light that the ray sees up to what it has met, which it does not see if it is `crossing` that. If it
// meets a surface for the first time, it leaves the rays that come of it on the stack.
ENTRY static inline float3 see_met(UNIFORM const Scene* scene, UNIFORM const TileSamples* tile,
                                   const SceneRay* ray, WaitingRay* path, bool crossing, const Encounter* met,
                                   SurfaceShading* at, UNIFORM u32* counts) {
  const float3 arriving = path->throughput;
  float3 light = (float3)(0.0f);
  if (HAS_GLOW) light = arriving * emitted(ray);
  path->throughput = arriving * met->absorbed;
  if (crossing) {
    if (HAS_MATTES && is_straight(path)) {
      const float taken = mean_of(arriving) - mean_of(path->throughput);
      if (taken != 0.0f) cover_by(scene, tile, path->pixel, met->hit.instance, met->face.material, taken);
    }
    wait_again(tile, ray, path);
    return light;
  }
  if (HAS_FOG) light += see_fog(scene, met, path);
  if (!hit_anything(&met->hit)) return light + see_background(scene, tile, ray, path);
  shade_hit(scene, ray, met, at);
  if (meets_again(path)) return light;
  light += see_ambient(scene, ray, path, met, at);
  if (HAS_EMISSION) light += see_emission(scene, path, at);
  if (HAS_MATTES && is_straight(path))
    cover_by(scene, tile, path->pixel, at->s.instance, at->s.material, mean_of(arriving));
  bool nothing = false;
  if (HAS_SECONDARY) nothing = spawn_children(scene, tile, ray, path, met, at, counts);
  if (!nothing && is_from_camera(path)) count(counts, COUNT_PRIMARY_HIT);
  return light;
}
