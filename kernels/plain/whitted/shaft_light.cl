// Light of area lights that surfaces see whole or behind solids alone, without rays through the scene: a
// shaft says what may stand before the light (lib/trace/shaft.cl). Where nothing does, the diffuse term is
// exact and highlights are sampled; else samples are tried against the solids in the shafts.
#include "plain/light/seen_light.cl"
#include "plain/shade/local_light.cl"
#include "plain/whitted/interface.h"

CONSTANT float SHAFT_MARGIN;
typedef struct LANES(Shafts) {
  float3 o, edge[4];
  float slack;
  int outside;
} Shaft;
typedef struct LANES(BounceNumbers) {
} BounceNumbers;

UNIFORM u32 lowest_bit(UNIFORM u32 bits);
void cast_shafts(UNIFORM const Scene* scene, UNIFORM u32 light, const Shaft* shaft, HERE, bool* soft,
                 bool* hard, UNIFORM u32* solids);
bool outside_convex(UNIFORM __global const Instance* instance, float3 o);
bool blocked_by(UNIFORM const Scene* scene, UNIFORM u32 solids, float3 o, float3 d, float t_max, HERE);
void begin_numbers(UNIFORM const TileSamples* tile, const WaitingRay* path, UNIFORM u32 dimension, HERE,
                   BounceNumbers* numbers);
void next_numbers(UNIFORM const TileSamples* tile, UNIFORM u32 part, UNIFORM u32 parts,
                  BounceNumbers* numbers, float* u_x, float* u_y);

// From so many rays on it pays to look first whether a solid hides all of a light.
#define RAYS_THAT_PAY 8u

// The part of a light at a shaft's end that is left to sample.
typedef struct ShaftLight {
  Bsdf bsdf;  // without the lobes for which the light is exact
  float3 wo;
  bool soft;  // a solid may stand in the shaft
} ShaftLight;

// Whether one of `solids` stands before the light and hides it whole: it is convex, and every way to a corner
// of a square a little larger meets it.
HAVING(HAS_SHAFTS)
static bool is_hidden(UNIFORM const Scene* scene, UNIFORM u32 solids, const Shaft* shaft) {
  const float3 middle = (shaft->edge[0] + shaft->edge[2]) * 0.5f;
  for (u32 left = solids; left != 0u; left &= left - 1u) {
    const u32 i = lowest_bit(left);
    bool hidden = outside_convex(scene->instances + i, shaft->o);
    for (u32 k = 0; k < 4u && any(hidden); ++k)
      if (hidden) {
        const float3 beside = along(shaft->edge[k], SHAFT_MARGIN, shaft->edge[k] - middle);
        hidden = blocked_by(scene, 1u << i, shaft->o, beside, SHORT_OF_LIGHT);
      }
    if (hidden) return true;
  }
  return false;
}

// Light of the samples of the light of `way`; where a solid may stand in the shaft, what passes `solids`.
HAVING(HAS_SHAFTS)
static inline float3 sampled_light(UNIFORM const Scene* scene, UNIFORM __global const LightRay* way,
                                   UNIFORM const TileSamples* tile, const WaitingRay* path,
                                   const SurfaceInteraction* s, const ShaftLight* left, UNIFORM u32 solids,
                                   UNIFORM u32* counts) {
  __global const Light* light = scene->lights + way->light;
  const float3 o = along(s->p, s->offset + s->lift, s->ng);
  BounceNumbers numbers;
  begin_numbers(tile, path, DIMENSIONS_OF_LIGHT(way->light) + BOUNCE_LIGHT_POINT, &numbers);
  SphericalRectangle rectangle;
  if (is_rectangle(light)) rectangle = see_rectangle(light, s->p);
  float3 sum = (float3)(0.0f);
  for (u32 part = 0; part < way->rays; ++part) {
    float u_x, u_y;
    next_numbers(tile, part, way->rays, &numbers, &u_x, &u_y);
    LightSample sample;
    if (is_rectangle(light))
      sample = sample_seen_rectangle(light, &rectangle, s->p, u_x, u_y);
    else
      sample = sample_area_light(light, s->p, u_x, u_y);
    if (!(dot(s->ns, sample.wi) > 0.0f)) continue;
    const float weight = light_weight(&sample) / (float)way->rays;
    const float3 possible =
        sample.radiance * weight * local_light(scene, &left->bsdf, left->wo, sample.wi, false);
    if (!(greatest(possible) >= FLT_MIN)) continue;
    if (left->soft) {
      count(counts, COUNT_SHADOW);
      note_pixel_ray(path->pixel, counts);
      if (blocked_by(scene, solids, o, sample.wi, sample.distance)) continue;
    }
    sum += possible;
  }
  return sum;
}

// The light of `way`: goes to `sum` if the surface sees it behind solids at most. Else the surface has to
// send its rays through the scene.
HAVING(HAS_SHAFTS)
static bool shaft_light(UNIFORM const Scene* scene, UNIFORM __global const LightRay* way,
                        UNIFORM const TileSamples* tile, const SceneRay* ray, const WaitingRay* path,
                        const SurfaceShading* at, float3* sum, UNIFORM u32* counts) {
  const SurfaceInteraction* s = &at->s;
  __global const Light* light = scene->lights + way->light;
  const SeenLight seen = see_light(light, s->p);
  Shaft shaft;
  shaft.o = along(s->p, s->offset + s->lift, s->ng);
  shaft.slack = s->offset;
  shaft.outside = s->entering ? s->instance : (int)NO_INSTANCE;
  bool facing = false;
  for (u32 i = 0; i < 4u; ++i) {
    shaft.edge[i] = seen.corner[i];
    facing = facing || dot(s->ns, seen.corner[i]) > 0.0f;
  }
  *sum = (float3)(0.0f);
  if (!facing || seen.behind) return false;
  if (!seen.in_front) return true;
  bool soft, hard;
  u32 solids = 0u;
  cast_shafts(scene, way->light, &shaft, &soft, &hard, &solids);
  if (hard) return true;
  if (way->rays >= RAYS_THAT_PAY && soft) {
    if (is_hidden(scene, solids, &shaft)) return false;
  }
  ShaftLight left = {at->bsdf, -ray->d, soft};
  if (is_rectangle(light) && !soft) {
    float integral;
    if (cosine_of_rectangle(light, &seen, s->ns, &integral)) {
      *sum = light->color.xyz * (at->bsdf.diffuse * (integral * (1.0f / M_PI_F)));
// Lobes that are neither: layers have no shafts, new ones may.
#define COUNT_LOBE(feature, name, flags) +(feature)
      const bool others = 0 LOCAL_LOBES(COUNT_LOBE) > HAS_SURFACES + HAS_HIGHLIGHTS;
      if (!others && !has_highlight(&at->bsdf)) return false;
      left.bsdf.diffuse = (float3)(0.0f);
    }
  }
  *sum += sampled_light(scene, way, tile, path, s, &left, solids, counts);
  return false;
}

// Whether the surface sends the shadow ray `index`, the first one to its light: the pixel receives what a
// shaft finds, which serves for all of them.
ENTRY static inline bool needs_rays(UNIFORM const Scene* scene, UNIFORM u32 index,
                                    UNIFORM const TileSamples* tile, const SceneRay* ray,
                                    const WaitingRay* path, const SurfaceShading* at, UNIFORM u32* counts) {
  if (HAS_SHAFTS && scene->info->shafts != 0u) {
    __global const LightRay* way = scene->light_rays + index;
    if (way->light != LIGHT_CHOSEN && has_corners(scene->lights + way->light)) {
      float3 sum;
      const bool needs = shaft_light(scene, way, tile, ray, path, at, &sum, counts);
      add_light(tile, path->pixel, path->throughput * sum);
      return needs;
    }
  }
  return true;
}
