// The shadow rays that surfaces send.
#pragma once
#include "lib/whitted/waiting.cl"
#include "plain/whitted/shadow_rays.cl"
#include "plain/whitted/shaft_light.cl"

// The shadow ray *index is the next of the surfaces of `lanes`: returns whether any of them, `casting`, sends
// it. If shafts serve its light, *index becomes the first ray to the next one.
static inline bool sends_ray(const Scene* scene, const TileSamples* tile, const SceneRays* rays,
                             const WaitingRays* paths, MASK lanes, const SurfaceShadings* at, u32* index,
                             MASK* casting, u32* counts) {
  if (!HAS_SHAFTS || scene->light_rays[*index].ray) return true;
  *casting = lanes & needs_rays(scene, *index, tile, rays, paths, at, counts, lanes);
  if (any_lane(*casting)) return true;
  *index += scene->light_rays[*index].rays;
  return false;
}
