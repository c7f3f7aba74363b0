// Whitted's ray tree (Whitted 1980) for a batch of pixels, which share a stack: the newest BATCH rays are
// taken together, a ray a lane. What a pixel receives is added in an order that depends on nothing but the
// work-item's pixels.
#pragma once
#include "lib/whitted/waiting.cl"

#if BATCH > 1
// Takes the newest shadow rays, at most `most`, to the light or to filters, behind which those that pass wait
// again. `coherent`: the rays run close together.
#if LISTS_HITS && HAS_SHADOW_FILTERS
NEVER_INLINE void advance_shadows(const Scene* scene, const TileSamples* tile, u32 most, bool coherent,
                                  u32* counts) {
  ShadowStack* stack = tile->shadows;
  SceneRays rays;
  WaitingRays paths;
  HitList lists[BATCH];
  Hits last, hits;
  MASK lanes = pop_shadows(stack, most, &rays, &paths);
  TraceRays traced = {&rays.o, &rays.d, &rays.t_min, &last, lists, 0};
  if (coherent) {
    for (u32 i = 0; i < BATCH; ++i) clear_list(lists + i);
    traced.lists = 0;
    find_hits(scene, &traced, rays.t_max, time_of_rays(&rays), lanes, TRACE_COHERENT);
  } else
    list_batch(scene, &traced, rays.t_max, time_of_rays(&rays), lanes);
  do {
    MASK listed;
    const MASK again = next_listed(scene, lists, &rays.t_min, lanes, &last, &hits, &listed);
    if (any_lane(again)) push_shadows(stack, &rays, &paths, again);
    lanes &= ~again;
    const MASK passing = lanes & pass_or_end_shadow(scene, tile, &rays, &paths, &hits, counts, lanes);
    push_shadows(stack, &rays, &paths, passing & ~listed);
    lanes = passing & listed;
  } while (any_lane(lanes));
}
#else
NEVER_INLINE void advance_shadows(const Scene* scene, const TileSamples* tile, u32 most, bool coherent,
                                  u32* counts) {
  ShadowStack* stack = tile->shadows;
  SceneRays rays;
  WaitingRays paths;
  const MASK lanes = pop_shadows(stack, most, &rays, &paths);
  Hits hits;
  if (HAS_SHADOW_FILTERS) {
    nearest_to_light(scene, &rays, lanes, coherent, &hits, counts);
  } else {  // any hit will do
    hits = no_hits(rays.t_max);
    const MASK occluded = any_hits(scene, &rays, lanes, coherent, counts);
    hits.instance = select(hits.instance, NO_LANES, occluded);
  }
  const MASK passing = lanes & pass_or_end_shadow(scene, tile, &rays, &paths, &hits, counts, lanes);
  push_shadows(stack, &rays, &paths, passing);
}
#endif

// The surfaces that a batch has hit, and their shading.
typedef struct SeenSurfaces {
  const Encounters* met;
  const SurfaceShadings* at;
} SeenSurfaces;

// Adds the lights that the surfaces of `lanes` see. `coherent`: the rays run close together, and so do those
// to one light; else shadow rays wait until there are many, or until no other rays come.
static inline void add_lights(const Scene* scene, const TileSamples* tile, const SceneRays* rays,
                              const WaitingRays* paths, MASK lanes, bool coherent, const SeenSurfaces* seen,
                              u32* counts) {
  u32 light = any_lane(lanes) ? 0u : scene->info->light_count;
  const bool last = tile->stack->count == 0u;
  MASK casting = lanes;
  ShadowStack* stack = tile->shadows;
  for (;;) {
    u32 most = BATCH;
    bool together = false;
    if (stack->count < BATCH) {
      if (light < scene->info->light_count) {
        // The first ray to a light decides for all of them.
        const MASK asked = HAS_SHAFTS && scene->light_rays[light].ray ? casting : lanes;
        casting = sends_ray(scene, tile, rays, paths, asked, seen->at, &light, counts);
        if (HAS_SHAFTS && !any_lane(casting)) continue;
        const u32 before = stack->count;
        cast_shadow(scene, light++, tile, rays, paths, seen->met, seen->at, counts, casting);
        most = stack->count - before;
        together = coherent && most;
        if (!together) continue;
      } else if (!last || !stack->count)
        return;
    }
    // The only place where shadow rays are traced: some compilers copy all that is called.
    advance_shadows(scene, tile, most, together, counts);
  }
}

// Takes a batch to the next interfaces, adds what it sees there to the pixels and leaves the rays that come
// of it on the stacks.
NEVER_INLINE void follow_batch(const Scene* scene, const TileSamples* tile, SceneRays* rays,
                               WaitingRays* paths, MASK lanes, bool coherent, u32* counts) {
  Encounters met;
  SurfaceShadings at;
  const SeenSurfaces seen = {&met, &at};
  MASK unseen =
      lanes & (coherent || !LISTS_UNSEEN ? meet_interfaces(scene, rays, coherent, &met, counts, lanes)
                                         : meet_listed(scene, rays, lanes, &met, counts));
  const MASK straight = lanes & ~unseen & is_from_camera(paths, lanes);
  unseen |= straight & pass_hidden(scene, rays, &met, straight);
  if (HAS_MEDIA) note_lost_pixels(paths->pixel, counts);
  const REAL3 radiance = see_met(scene, tile, rays, paths, unseen, &met, &at, counts, lanes);
  const MASK hit = lanes & ~unseen & hit_anything(&met.hit);
  add_lights(scene, tile, rays, paths, hit, coherent, &seen, counts);
  add_to_pixels(radiance, paths->pixel, lanes, tile->radiance);
}

// The camera's rays of the lanes of `lanes`, pixel i in lane i, with all that comes of them.
static inline void follow_camera_rays(const Scene* scene, TileSamples* tile, SceneRays* rays, MASK lanes,
                                      u32* counts) {
  RayStack stack;
  ShadowStack shadows;
  stack.count = shadows.count = 0;
  tile->stack = &stack;
  tile->shadows = &shadows;
  MASK pixels;
  for (u32 i = 0; i < BATCH; ++i) MASK_LANE(pixels, i) = (int)i;
  WaitingRays paths = camera_path(pixels, lanes);
  bool from_camera = true;
  do {
    follow_batch(scene, tile, rays, &paths, lanes, from_camera, counts);
    from_camera = false;
    lanes = stack.count ? pop_rays(&stack, BATCH, rays, &paths) : NO_LANES;
  } while (any_lane(lanes));
}
#endif
