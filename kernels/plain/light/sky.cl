// Light from infinitely far away.
#include "plain/light/light.cl"
#include "plain/path/camera.cl"

// The environment where rays see it, with the density of choosing it, else the background.
static inline bool sees_environment(UNIFORM const Scene* scene) {
  if (HAS_ENVIRONMENT) return scene->info->sees_environment != 0u;
  return false;
}
static inline float3 distant_along(UNIFORM const Scene* scene, float3 d, float* pdf) {
  *pdf = 0.0f;
  if (sees_environment(scene)) return environment_along(scene, d, pdf);
  return background_along(scene->info, d);
}

// The environment's light along d; camera rays see the background instead if it is hidden from them.
static inline float3 hide_environment(UNIFORM const Scene* scene, float3 d, float3 light, bool camera) {
  if (scene->info->sees_environment == SEEN_OFF_CAMERA && camera) return background_along(scene->info, d);
  return light;
}

// The radiance of rays that meet nothing: the environment or background, and the sky's lights before it.
HAVING(HAS_SKY)
static inline float3 lit_sky_along(UNIFORM const Scene* scene, float3 d, bool camera) {
  float pdf;
  const float3 behind = distant_along(scene, d, &pdf);
  float3 light = hide_environment(scene, d, behind, camera);
  if (HAS_AREA_LIGHTS)
    for (u32 index = 0; index < scene->info->table_lights; ++index) {
      __global const Light* lamp = scene->lights + index;
      if (is_in_sky(lamp)) light += sky_light_radiance(lamp, d, camera);
    }
  return light;
}
static inline float3 sky_along(UNIFORM const Scene* scene, float3 d, bool camera) {
  if (HAS_SKY)
    return lit_sky_along(scene, d, camera);
  else
    return background_along(scene->info, d);
}
