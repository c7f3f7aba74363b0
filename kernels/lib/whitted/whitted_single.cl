// Whitted's ray tree of one pixel, for devices that run a lane a ray: one loop takes path and shadow rays
// alike. The lanes of a group follow trees of their own, and are quick only where they trace at the same
// time: so a surface's shadow rays wait on the stack, above its children, and each round takes a ray of
// whatever kind.
#pragma once
#include "lib/whitted/waiting.cl"

#if BATCH == 1
// Shadow rays of the surface to the lights that `whole` has left, as far as there is room; it waits for the
// rest.
static inline void send_to_lights(const Scene* scene, const TileSamples* tile, const SceneRays* rays,
                                  const WaitingRays* paths, const WaitingRays* whole, const Encounters* met,
                                  const SurfaceShadings* at, u32* counts) {
  u32 light = meets_again(whole, ALL_LANES) ? tile->stack->light : 0u;
#if HAS_SHAFTS
  u32 sent[LIGHT_ROOM], count = 0;
  while (light < scene->info->light_count && count < LIGHT_ROOM)
    if (any_lane(sends_ray(scene, tile, rays, paths, ALL_LANES, at, &light, counts))) sent[count++] = light++;
#else
  const u32 first = light, count = min(scene->info->light_count - light, (u32)LIGHT_ROOM);
  light += count;
#endif
  if (light < scene->info->light_count) {
    WaitingRays again = *whole;
    meet_again(&again, ALL_LANES);
    push_rays(tile->stack, rays, &again, ALL_LANES);
    tile->stack->light = light;
    tile->stack->t_min = rays->t_min;
    HAVING(HAS_MEDIA, tile->stack->since = rays->since;)
  }
  for (u32 i = 0; i < count; ++i) {
#if HAS_SHAFTS
    const u32 index = sent[i];
#else
    const u32 index = first + i;
#endif
    cast_shadow(scene, index, tile, rays, paths, met, at, counts, ALL_LANES);
  }
}

// Takes a ray to what it meets next. Returns whether it continues.
static inline MASK follow_ray(const Scene* scene, const TileSamples* tile, SceneRays* rays,
                              WaitingRays* paths, u32* counts) {
  Encounters met CLEARED_ON_GPUS;
  const bool to_light = paths->depth == 0;
  next_hits(scene, rays, ALL_LANES, to_light, &met.hit, counts);
  if (to_light) return pass_or_end_shadow(scene, tile, rays, paths, &met.hit, counts, ALL_LANES);
  HAVING(HAS_PARALLAX, enter_relief(scene, rays, &met, counts, ALL_LANES);)
  MASK unseen = reach_interfaces(scene, rays, &met, counts, ALL_LANES);
  const MASK straight = ~unseen & is_from_camera(paths, ALL_LANES);
  unseen |= straight & pass_hidden(scene, rays, &met, straight);
  const WaitingRays whole = *paths;
  // Ways to lights ask for hits in reliefs while the surface waits.
  EITHER(HAS_PARALLAX, KEEP_IN_MEMORY(SurfaceShadings, at);, SurfaceShadings shading CLEARED_ON_GPUS;
         SurfaceShadings* at = &shading;)
  const REAL3 seen = see_met(scene, tile, rays, paths, unseen, &met, at, counts, ALL_LANES);
  add_to_pixels(seen, paths->pixel, ~meets_again(&whole, ALL_LANES), tile->radiance);
  forget_glow(rays, ALL_LANES);
  if (unseen | ~hit_anything(&met.hit)) return unseen;
  send_to_lights(scene, tile, rays, paths, &whole, &met, at, counts);
  return NO_LANES;
}

// The camera's ray in `rays`, with all that comes of it.
static inline void follow_camera_rays(const Scene* scene, TileSamples* tile, SceneRays* rays, MASK lanes,
                                      u32* counts) {
  RayStack stack;
  stack.count = 0;
  tile->stack = tile->shadows = &stack;
  KEEP_IN_MEMORY(WaitingRays, paths);
  *paths = camera_path(NO_LANES, lanes);
  while (any_lane(lanes)) {
    lanes = follow_ray(scene, tile, rays, paths, counts);
    if (!any_lane(lanes) && stack.count) {
      lanes = pop_rays(&stack, 1u, rays, paths);
      const bool again = meets_again(paths, lanes);
      rays->t_min = again ? stack.t_min : 0.0f;
      HAVING(HAS_MEDIA, rays->since = again ? stack.since : 0.0f;)
    }
  }
}
#endif
