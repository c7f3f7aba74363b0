// Whitted's ray tree of one pixel, for devices that run a lane a ray: one loop takes path and shadow rays
// alike. The lanes of a group follow trees of their own, and are quick only where they trace at the same
// time: so a surface's shadow rays wait on the stack, above its children, and each round takes a ray of
// whatever kind.
#pragma once
#include "lib/light/direct_light.cl"
#include "lib/light/shadow.cl"
#include "lib/whitted/steps.cl"

#if BATCH == 1
// A ray that met a surface with more lights than the stack has room for waits itself, to meet it once more:
// its depth then holds the next light in the bits from here on.
#define DEPTH_BITS 8u

// Shadow rays of the surface from the number `light` on, as far as there is room; the ray `whole` waits for
// the rest.
#if HAS_SHAFTS
static inline void send_to_lights(const Scene* scene, const TileSamples* tile, const SceneRays* rays,
                                  const WaitingRays* paths, const WaitingRays* whole, u32 light, MASK hit,
                                  const Hits* hits, const Shading* at, RayStack* stack, float4* radiance,
                                  u32* counts) {
  u32 sent[LIGHT_ROOM], count = 0;
  MASK casting = hit;  // also where a light's first rays have been sent before: shafts have not found all
  while (light < scene->info->light_count && count < LIGHT_ROOM)
    if (sends_ray(scene, tile, rays, paths, hit, at, &light, &casting, radiance, counts))
      sent[count++] = light++;
  if (light < scene->info->light_count) {
    WaitingRays again = *whole;
    again.depth = paths->depth | (int)(light << DEPTH_BITS);
    push_rays(stack, rays, &again, ALL_LANES);
  }
  for (u32 i = 0; i < count; ++i)
    cast_shadows(scene, sent[i], tile, rays, paths, hit, hits, at, stack, counts);
}
#else
static inline void send_to_lights(const Scene* scene, const TileSamples* tile, const SceneRays* rays,
                                  const WaitingRays* paths, const WaitingRays* whole, u32 light, MASK hit,
                                  const Hits* hits, const Shading* at, RayStack* stack, float4* radiance,
                                  u32* counts) {
  const u32 last = min(scene->info->light_count, light + LIGHT_ROOM);
  if (last < scene->info->light_count) {
    WaitingRays again = *whole;
    again.depth = paths->depth | (int)(last << DEPTH_BITS);
    push_rays(stack, rays, &again, ALL_LANES);
  }
  for (; light < last; ++light) cast_shadows(scene, light, tile, rays, paths, hit, hits, at, stack, counts);
}
#endif

// Takes a ray to what it meets next. Returns whether it continues.
static inline MASK follow_ray(const Scene* scene, const TileSamples* tile, SceneRays* rays,
                              WaitingRays* paths, RayStack* stack, float4* radiance, u32* counts) {
  Encounters met = {0};
  const bool to_light = paths->depth == 0;
  next_hits(scene, rays, ALL_LANES, to_light, &met.hit, counts);
  if (to_light) return reach_filters(scene, rays, paths, &met.hit, ALL_LANES, radiance, counts);
  HAVING(HAS_PARALLAX, enter_reliefs(scene, rays, ALL_LANES, &met, counts);)
  MASK unseen = reach_interfaces(scene, rays, ALL_LANES, &met, counts);
  unseen |= pass_hidden(scene, rays, &met, ~unseen & MASK_OF((paths->depth & ((1 << DEPTH_BITS) - 1)) == 1));
  const WaitingRays whole = *paths;
  u32 light = (u32)paths->depth >> DEPTH_BITS;
  const MASK fresh = MASK_OF(light == 0u);
  paths->depth &= (1 << DEPTH_BITS) - 1;
  // Ways to lights ask for hits in reliefs while the surface waits.
  EITHER(HAS_PARALLAX, KEEP_IN_MEMORY(Shading, at);, Shading shading = {0}; Shading* at = &shading;)
  REAL3 seen;
  const MASK hit = meet_surfaces(scene, tile, rays, paths, ALL_LANES, unseen, fresh, &met, at, &seen, stack,
                                 radiance, counts);
  add_to_pixels(seen, paths->pixel, fresh, radiance);
  forget_glow(rays, ALL_LANES);
  if (!hit) return unseen;
  send_to_lights(scene, tile, rays, paths, &whole, light, hit, &met.hit, at, stack, radiance, counts);
  return NO_LANES;
}

// The camera's ray in `rays`, with all that comes of it. radiance->xyz receives the light of the pixel, from
// w is taken what of the background is seen straight on.
static inline void trace_whitted(const Scene* scene, const TileSamples* tile, SceneRays* rays, MASK lanes,
                                 RayStack* stack, float4* radiance, u32* counts) {
  KEEP_IN_MEMORY(WaitingRays, paths);
  paths->throughput = all3((float3)(1.0f));
  paths->pixel = NO_LANES;
  paths->depth = (MASK)(1);
  start_branches(paths);
  stack->count = 0;
  while (any_lane(lanes)) {
    lanes = follow_ray(scene, tile, rays, paths, stack, radiance, counts);
    if (!any_lane(lanes) && stack->count) lanes = pop_rays(stack, 1u, rays, paths);
  }
}
#endif
