// Where light comes from: the scene's lights, and what glows by itself. A point or a ray a lane.
#pragma once
#include "lib/core/tables.h"
#include "lib/light/area_light.cl"
#include "lib/light/environment.cl"
#include "lib/path/scene_ray.cl"
#include "plain/light/light.cl"

// Whether rays may meet the light `index`: it is seen, and has an extent.
static inline bool rays_meet(const Scene* scene, u32 index) {
  __global const Light* light = scene->lights + index;
  if (light->kind == LIGHT_ENVIRONMENT) return scene->info->sees_environment != 0u;
  if (light->kind == LIGHT_SUN) return light->direction.w > 0.0f;
  return light->kind >= LIGHT_RECTANGLE && light->position.w == 0.0f;
}
