// Whitted's ray tree (Whitted 1980) walked with an explicit stack, in two ways. Where a work-item has a batch
// of pixels they share the stack, so that the newest BATCH rays are taken together, a ray a lane. Where it
// has one pixel, one loop takes path and shadow rays alike. What a pixel receives is added in an order that
// depends on nothing but the work-item's pixels.
#ifndef SUNDOG_LIB_WHITTED_CL
#define SUNDOG_LIB_WHITTED_CL
#include "lib/children.cl"

#if BATCH > 1
// Adds the lights that the surfaces of `lanes` see. `coherent`: the rays run close together, and so do those
// to one light; else shadow rays wait until there are many, or with `last` until no others come.
static inline void add_lights(const Scene* scene, const SceneRays* rays, const PathStates* paths, MASK lanes,
                              bool coherent, bool last, const Encounters* met, const Surfaces* s,
                              ShadowStack* stack, float4* radiance, u32* counts) {
  u32 light = any_lane(lanes) ? 0u : scene->info->light_count;
  for (;;) {
    u32 most = BATCH;
    bool together = false;
    if (stack->count < BATCH) {
      if (light < scene->info->light_count) {
        const u32 before = stack->count;
        cast_shadows(scene, light++, rays, paths, lanes, met, s, stack, counts);
        most = stack->count - before;
        together = coherent && most;
        if (!together) continue;
      } else if (!last || !stack->count)
        return;
    }
    // The only place where shadow rays are traced: some compilers copy all that is called.
    advance_shadows(scene, stack, most, together, radiance, counts);
  }
}

// Takes a batch to the next interfaces, adds what it sees there to the pixels and leaves the rays that come
// of it on the stacks.
NEVER_INLINE void follow_batch(const Scene* scene, SceneRays* rays, PathStates* paths, MASK lanes,
                               bool coherent, RayStack* stack, ShadowStack* shadows, float4* radiance,
                               u32* counts) {
  Encounters met;
  Surfaces s;
  REAL3 seen;
  const MASK unseen = next_interfaces(scene, rays, lanes, coherent, &met, counts);
  const MASK hit =
      look_around(scene, rays, paths, lanes, unseen, ALL_LANES, &met, &s, &seen, stack, radiance, counts);
  add_lights(scene, rays, paths, hit, coherent, stack->count == 0u, &met, &s, shadows, radiance, counts);
  add_to_pixels(seen, paths->pixel, lanes, radiance);
}

// The camera's rays of the lanes of `lanes`, pixel i in lane i, with all that comes of them. radiance[i].xyz
// receives the light of pixel i of the tile, w whether its camera ray hit anything.
static inline void trace_whitted(const Scene* scene, SceneRays* rays, MASK lanes, RayStack* stack,
                                 float4* radiance, u32* counts) {
  PathStates paths;
  paths.throughput = all3((float3)(1.0f));
  paths.depth = (MASK)(1);
  for (u32 i = 0; i < BATCH; ++i) MASK_LANE(paths.pixel, i) = (int)i;
  ShadowStack shadows;
  shadows.count = 0;
  stack->count = 0;
  bool from_camera = true;
  do {
    follow_batch(scene, rays, &paths, lanes, from_camera, stack, &shadows, radiance, counts);
    from_camera = false;
    lanes = stack->count ? pop_rays(stack, BATCH, rays, &paths) : NO_LANES;
  } while (any_lane(lanes));
}

#else
// The lanes of a group follow trees of their own, and are quick only where they trace at the same time: so a
// surface's shadow rays wait on the stack, above its children, and each round takes a ray of whatever kind.
//
// A ray that met a surface with more lights than the stack has room for waits itself, to meet it once more:
// its depth then holds the next light in the bits from here on.
#define DEPTH_BITS 8u

// Takes a ray to what it meets next. Returns whether it goes on.
static inline MASK follow_ray(const Scene* scene, SceneRays* rays, PathStates* paths, RayStack* stack,
                              float4* radiance, u32* counts) {
  Encounters met;
  const bool to_light = paths->depth == 0;
  next_hits(scene, rays, ALL_LANES, to_light, &met.hit, counts);
  if (to_light) return reach_filters(scene, rays, paths, &met.hit, ALL_LANES, radiance, counts);
  const MASK unseen = reach_interfaces(scene, rays, ALL_LANES, &met, counts);
  const PathStates whole = *paths;
  u32 light = (u32)paths->depth >> DEPTH_BITS;
  const MASK fresh = MASK_OF(light == 0u);
  paths->depth &= (1 << DEPTH_BITS) - 1;
  Surfaces s;
  REAL3 seen;
  const MASK hit =
      look_around(scene, rays, paths, ALL_LANES, unseen, fresh, &met, &s, &seen, stack, radiance, counts);
  add_to_pixels(seen, paths->pixel, fresh, radiance);
#if HAS_GLOW
  rays->glow = all3((float3)(0.0f));
#endif
  if (!hit) return unseen;
  const u32 last = min(scene->info->light_count, light + LIGHT_ROOM);
  if (last < scene->info->light_count) {
    PathStates again = whole;
    again.depth = paths->depth | (int)(last << DEPTH_BITS);
    push_rays(stack, rays, &again, ALL_LANES);
  }
  for (; light < last; ++light) cast_shadows(scene, light, rays, paths, hit, &met, &s, stack, counts);
  return NO_LANES;
}

// The camera's ray in `rays`, with all that comes of it. radiance->xyz receives the light of the pixel, w
// whether the ray hit anything.
static inline void trace_whitted(const Scene* scene, SceneRays* rays, MASK lanes, RayStack* stack,
                                 float4* radiance, u32* counts) {
  PathStates paths = {all3((float3)(1.0f)), NO_LANES, (MASK)(1)};
  stack->count = 0;
  while (any_lane(lanes)) {
    lanes = follow_ray(scene, rays, &paths, stack, radiance, counts);
    if (!any_lane(lanes) && stack->count) lanes = pop_rays(stack, 1u, rays, &paths);
  }
}
#endif

#endif
