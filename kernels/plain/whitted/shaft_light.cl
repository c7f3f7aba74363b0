// Light of the lights with an extent that surfaces see whole or behind solids alone, without rays that go
// through the scene: a shaft says what may stand before the light (trace/shaft.cl). Where nothing does, the
// diffuse term is exact and highlights are sampled; else samples are tried against the solids in the shafts.
#pragma once
#include "lib/light/light.cl"
#include "lib/light/seen_light.cl"
#include "lib/light/shadow_rays.cl"
#include "lib/trace/shaft.cl"

#if HAS_SHAFTS
// The lanes of `lanes` whose surfaces have highlights.
static inline MASK with_highlights(const Scene* scene, const Bsdfs* bsdf, MASK lanes) {
  if (!HAS_HIGHLIGHTS) return NO_LANES;
  HAVING(HAS_MAPS, return lanes & MASK_OF(greatest3(bsdf->specular) > 0.0f);)
  MASK shine = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    const float4 specular = scene->materials[index].specular;
    if (specular.x != 0.0f || specular.y != 0.0f || specular.z != 0.0f) shine |= mine;
  }
  return shine;
}

// The lanes of `lanes` whose ways (o, d) meet one of `solids` before `t_max`.
static inline MASK blocked_by(const Scene* scene, u32 solids, REAL3 o, REAL3 d, REAL t_max, MASK lanes) {
  Hits hits = no_hits(t_max);
  prepare_hits(scene, (REAL)(0.0f), &hits);  // shafts know nothing that moves
  const REAL t_min = (REAL)(0.0f);
  for (; HAS_SOLID && solids; solids &= solids - 1u) {
    const u32 i = lowest_bit(solids);
    hit_solids(scene->instances, i, i + 1u, &o, &d, &t_min, lanes, true, &hits);
  }
  return lanes & hit_anything(&hits);
}

// From so many rays on it pays to look first whether a solid hides all of a light.
#define RAYS_THAT_PAY 8u

// The lanes of `lanes` before whose lights one of `solids` stands and hides them whole: it is convex, and
// every way to a corner of a square a little larger meets it.
static inline MASK hidden_lanes(const Scene* scene, u32 solids, const Shafts* shafts, MASK lanes) {
  MASK dark = NO_LANES;
  const REAL3 middle = scale3(add3(shafts->edge[0], shafts->edge[2]), (REAL)(0.5f));
  for (; solids; solids &= solids - 1u) {
    const u32 i = lowest_bit(solids);
    MASK hidden = lanes & ~dark & outside_convex(scene->instances + i, shafts->o);
    for (u32 k = 0; k < 4u && any_lane(hidden); ++k) {
      const REAL3 beside = subtract3(shafts->edge[k], middle);
      hidden = blocked_by(scene, 1u << i, shafts->o, along3(shafts->edge[k], (REAL)(SHAFT_MARGIN), beside),
                          (REAL)(SHORT_OF_LIGHT), hidden);
    }
    dark |= hidden;
  }
  return dark;
}

// Light of the samples of the light of `way` on the surfaces of `lanes`, which `bsdf` describes; of those of
// `soft` what passes `solids`.
static inline REAL3 sampled_light(const Scene* scene, const LightRay* way, const TileSamples* tile,
                                  const WaitingRays* paths, REAL3 wo, const SurfaceInteractions* s,
                                  const Bsdfs* bsdf, MASK lanes, MASK soft, u32 solids, u32* counts) {
  __global const Light* light = scene->lights + way->light;
  BounceNumbers numbers;
  begin_numbers(tile, paths, way->light, BOUNCE_LIGHT_POINT, lanes, &numbers);
  SphericalRectangles rectangle;
  const bool flat = is_rectangle(light);
  if (flat) rectangle = see_rectangle(light, s->p, lanes);
  const REAL3 o = along3(s->p, s->offset + s->lift, s->ng);
  REAL3 sum = all3((float3)(0.0f));
  for (u32 ray = 0; ray < way->rays; ++ray) {
    REAL u_x, u_y;
    next_numbers(tile, ray, way->rays, &numbers, &u_x, &u_y);
    const LightSamples sample = flat ? sample_seen_rectangle(light, &rectangle, s->p, u_x, u_y, lanes)
                                     : sample_area_light(light, s->p, u_x, u_y, lanes);
    const MASK facing = lanes & MASK_OF(dot3(s->ns, sample.wi) > 0.0f);
    if (!any_lane(facing)) continue;
    const REAL weight = light_weight(&sample, facing) / (float)way->rays;
    const REAL3 possible =
        multiply3(scale3(sample.radiance, weight), local_light(scene, bsdf, wo, sample.wi, NO_LANES, facing));
    MASK lit = facing & MASK_OF(greatest3(possible) >= FLT_MIN);
    const MASK asking = lit & soft;
    if (any_lane(asking)) {
      counts[COUNT_SHADOW] += lane_count(asking);
      note_rays(paths->pixel, asking, counts);
      lit &= ~blocked_by(scene, solids, o, sample.wi, sample.distance, asking);
    }
    sum = select3(sum, add3(sum, possible), lit);
  }
  return sum;
}

// The light of `way` on the surfaces of `lanes`: goes to `sum` for those that see it behind solids at most.
// Returns the others, which have to send their rays through the scene.
NEVER_INLINE MASK direct_light(const Scene* scene, const LightRay* way, const TileSamples* tile,
                               const SceneRays* rays, const WaitingRays* paths, MASK lanes, const Shading* at,
                               REAL3* sum, u32* counts) {
  const SurfaceInteractions* s = &at->s;
  __global const Light* light = scene->lights + way->light;
  const SeenLights seen = see_light(light, s->p, lanes);
  Shafts shafts;
  shafts.o = along3(s->p, s->offset + s->lift, s->ng);
  shafts.slack = s->offset;
  MASK facing = NO_LANES;
  for (u32 i = 0; i < 4u; ++i) {
    shafts.edge[i] = seen.corner[i];
    facing |= MASK_OF(dot3(s->ns, seen.corner[i]) > 0.0f);
  }
  shafts.outside = select((MASK)((int)NO_INSTANCE), s->instance, s->entering);
  lanes &= facing & ~seen.behind;
  MASK asking = lanes & seen.in_front;
  MASK soft = NO_LANES, hard = NO_LANES;
  u32 solids = 0;
  if (any_lane(asking)) cast_shafts(scene, way->light, &shafts, asking, &soft, &hard, &solids);
  Bsdfs bsdf = at->bsdf;
  if (way->rays >= RAYS_THAT_PAY) {
    const MASK dark = hidden_lanes(scene, solids, &shafts, soft);
    lanes &= ~dark;
    asking &= ~dark;
    soft &= ~dark;
  }
  MASK sampled = asking & ~hard, whole = NO_LANES;
  *sum = all3((float3)(0.0f));
  if (is_rectangle(light)) {
    REAL integral;
    whole = cosine_of_rectangle(light, &seen, s->ns, sampled & ~soft, &integral);
    const REAL3 diffuse = multiply3(all3(light->color.xyz), scale3(bsdf.diffuse, integral * (1.0f / M_PI_F)));
    *sum = select3(*sum, diffuse, whole);
    bsdf.diffuse = select3(bsdf.diffuse, all3((float3)(0.0f)), whole);
    sampled = (sampled & ~whole) | with_highlights(scene, &bsdf, whole);
  }
  if (any_lane(sampled))
    *sum = add3(*sum, sampled_light(scene, way, tile, paths, negate3(rays->d), s, &bsdf, sampled, soft,
                                    solids, counts));
  return hard | (lanes & ~asking);
}

static inline bool has_shafts(const Scene* scene, u32 light) {
  return light != LIGHT_CHOSEN && has_corners(scene->lights + light);
}

// The shadow ray *index is the next of the surfaces of `lanes`: returns whether any of them, `casting`, sends
// it. Where it is the first to a light that shafts are for, the pixels receive what these find; where they
// find all, *index becomes the first ray to the next light.
static inline bool sends_ray(const Scene* scene, const TileSamples* tile, const SceneRays* rays,
                             const WaitingRays* paths, MASK lanes, const Shading* at, u32* index,
                             MASK* casting, float4* radiance, u32* counts) {
  if (!scene->info->shafts) return true;
  const LightRay way = scene->light_rays[*index];
  if (way.ray) return true;
  *casting = lanes;
  if (!has_shafts(scene, way.light)) return true;
  REAL3 sum;
  *casting = direct_light(scene, &way, tile, rays, paths, lanes, at, &sum, counts);
  add_to_pixels(multiply3(paths->throughput, sum), paths->pixel, lanes, radiance);
  if (any_lane(*casting)) return true;
  *index += way.rays;
  return false;
}
#else
static inline bool sends_ray(const Scene* scene, const TileSamples* tile, const SceneRays* rays,
                             const WaitingRays* paths, MASK lanes, const Shading* at, u32* index,
                             MASK* casting, float4* radiance, u32* counts) {
  return true;
}
#endif
