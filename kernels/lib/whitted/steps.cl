// What Whitted's integrator does with rays where they end: the light that they see on the way and there, each
// kind by a step of its own. Each takes the rays of some lanes and returns the light that their pixels
// receive.
#pragma once
#include "lib/light/field_openness.cl"
#include "lib/light/shadow_rays.cl"
#include "lib/path/camera.cl"
#include "lib/whitted/children.cl"

// Light of the fields that glow along the rays.
static inline REAL3 see_glow(const SceneRays* rays, const WaitingRays* paths) {
  return HAS_GLOW ? multiply3(paths->throughput, emitted(rays, ALL_LANES)) : all3((float3)(0.0f));
}

// The world's fog, for rays of `ended` that were not inside anything: what it adds, and what it takes from
// all behind it.
static inline REAL3 see_fog(const Scene* scene, const Encounters* met, MASK ended, WaitingRays* paths) {
  if (!HAS_FOG) return all3((float3)(0.0f));
  const REAL clear = clear_of_fog(scene, met, ended);
  const REAL3 light = multiply3(scale3(paths->throughput, 1.0f - clear), all3(scene->info->fog.xyz));
  paths->throughput = scale3(paths->throughput, clear);
  return light;
}

// Of `lanes`, the pixels that show what is behind the scene, straight on, are covered by so much less: w is
// what covers the pixel of its background. Returns these lanes.
static inline MASK uncover(const WaitingRays* paths, MASK lanes, float4* radiance) {
  const MASK straight = lanes & MASK_OF((paths->depth & TURNED) == 0);
  const REAL3 t = paths->throughput;
  const REAL passed = (t.x + t.y + t.z) * (1.0f / 3.0f);
  EACH_LANE(i, straight) { radiance[MASK_LANE(paths->pixel, i)].w -= REAL_LANE(passed, i); }
  return straight;
}

static inline REAL3 see_background(const Scene* scene, const SceneRays* rays, const WaitingRays* paths,
                                   MASK lanes, float4* radiance) {
  const MASK straight = uncover(paths, lanes, radiance);
  const REAL3 light =
      multiply3(paths->throughput, sky_along(scene, rays->d, MASK_OF(paths->depth == 1), lanes));
  return scene->info->transparent ? select3(light, all3((float3)(0.0f)), straight) : light;
}

// Ambient light on surfaces, less in the crevices of fields.
static inline REAL3 see_ambient(const Scene* scene, const SceneRays* rays, const WaitingRays* paths,
                                const Hits* hits, const Bsdfs* bsdf, MASK lanes) {
  REAL3 own = multiply3(bsdf->ambient, all3(scene->info->ambient.xyz));
  HAVING(HAS_OCCLUSION, own = scale3(own, field_openness(scene, rays, hits, lanes));)
  return multiply3(paths->throughput, own);
}

// The light that surfaces of `lanes` emit, on their outsides.
static inline REAL3 see_emission(const Scene* scene, const WaitingRays* paths, const SurfaceInteractions* s,
                                 const Bsdfs* bsdf, MASK lanes) {
  REAL3 light = all3((float3)(0.0f));
  if (!HAS_EMISSION) return light;
  u32 index;
  for (u32 left = lane_bits(of_kind(bsdf, MATERIAL_EMITS, lanes & s->entering)); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    light = select3(light, all3(scene->materials[index].emission.xyz), mine);
  }
  light = multiply3(paths->throughput, light);
  HAVING(HAS_MAPS, light = multiply3(light, bsdf->emission);)
  return light;
}

// The rays of `lanes` at what they met: the surfaces of those that hit something, which are returned, and
// what the `fresh` ones see and spawn there. The rays of `unseen` saw only what lay before.
static inline MASK meet_surfaces(const Scene* scene, const TileSamples* tile, const SceneRays* rays,
                                 WaitingRays* paths, MASK lanes, MASK unseen, MASK fresh,
                                 const Encounters* met, Shading* at, REAL3* light, RayStack* stack,
                                 float4* radiance, u32* counts) {
  HAVING(HAS_MATTES, const WaitingRays arriving = *paths;)
  if (HAS_MEDIA) note_lost_pixels(paths->pixel, counts);
  REAL3 seen = see_glow(rays, paths);
  paths->throughput = multiply3(paths->throughput, met->absorbed);
  if (BATCH > 1 && any_lane(unseen)) push_rays(stack, rays, paths, unseen);
  const MASK ended = lanes & ~unseen, hit = ended & hit_anything(&met->hit);
  if (HAS_FOG) seen = add3(seen, see_fog(scene, met, ended, paths));
  seen = select3(seen, add3(seen, see_background(scene, rays, paths, ended & ~hit, radiance)), ended & ~hit);
  if (any_lane(hit)) {
    shade_hits(scene, rays, met, hit, at);
    HAVING(HAS_MATTES, add_mattes(scene, tile, &arriving, &at->s, hit & fresh, 1.0f);)
    seen = select3(seen, add3(seen, see_ambient(scene, rays, paths, &met->hit, &at->bsdf, hit)), hit);
    if (HAS_EMISSION) seen = add3(seen, see_emission(scene, paths, &at->s, &at->bsdf, hit));
    MASK nothing = NO_LANES;
    HAVING(HAS_SECONDARY, nothing = spawn_children(scene, tile, &at->s, &at->bsdf, met, rays, paths,
                                                   hit & fresh, stack, counts);)
    counts[COUNT_PRIMARY_HIT] += lane_count(hit & fresh & ~nothing & MASK_OF(paths->depth == 1));
  }
  *light = seen;
  return hit;
}
