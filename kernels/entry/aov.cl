// One stage: what the camera sees first, for the extra images: depth, normal, position, albedo, object and
// material; with FEATURE_AOVS also what a denoiser takes; with ALL_AOVS also the geometric normal, steps of
// marching and coordinates.
#include "lib/core/counters.cl"
#include "lib/path/segment.cl"
#include "lib/shade/bsdf.cl"
#include "plain/shade/lobes.cl"
#include "plain/shade/specular.cl"
#include "shared/launch.h"

#ifndef ALL_AOVS
#define ALL_AOVS 0
#endif
#ifndef FEATURE_AOVS
#define FEATURE_AOVS 0
#endif

#define AOV_VECTORS (ALL_AOVS ? 7u : FEATURE_AOVS ? 5u : 3u)

#if FEATURE_AOVS
#include "lib/pathtracer/steps.cl"
#include "plain/pathtracer/features.cl"

// The two vectors behind the first three, of the pixels whose middles are (x, y).
NEVER_INLINE void write_features(const Scene* scene, MediaStack stack, REAL x, REAL y, MASK lanes,
                                 u32* counts, __global float4* aovs) {
  REAL3 normal;
  const LaneSamples at = {TO_MASK(x), TO_MASK(y), NO_LANES, scene->info->seed};
  const REAL3 albedo = mean_features(scene, &stack, &at, &normal, counts, lanes);
  EACH_LANE(i, lanes) {
    __global float4* out = aovs + AOV_VECTORS * i;
    out[3] = (float4)(get3(&albedo, i), 0.0f);
    out[4] = (float4)(get3(&normal, i), 0.0f);
  }
}
#endif

#if ALL_AOVS
// The steps that the ray of each lane alone marches.
static inline REAL steps_alone(const Scene* scene, const SceneRays* camera, MASK lanes) {
  REAL steps = (REAL)(0.0f);
  if (!HAS_SDF) return steps;
  EACH_LANE(i, lanes) {
    u32 counts[COUNTERS];
    for (u32 k = 0; k < COUNTERS; ++k) counts[k] = 0;
    start_marching(counts);
    SceneRays rays = *camera;
    Encounters met;
    see_surfaces(scene, &rays, ALL_LANES, true, &met, counts, lanes_of(1u << i));
    REAL_LANE(steps, i) = (float)counts[COUNT_MARCH_STEPS];
  }
  return steps;
}

// The vectors behind the first five, of the pixels about (x, y) whose first surfaces are `s`, where `hit`.
NEVER_INLINE void write_more(const Scene* scene, MediaStack stack, REAL x, REAL y, MASK lanes, MASK hit,
                             const SurfaceInteractions* s, u32* counts, __global float4* aovs) {
  const CameraRays camera = camera_rays(scene->info, x, y, (REAL)(0.0f), lanes);
  const SceneRays middle = scene_rays(&camera, stack);
  const REAL steps = steps_alone(scene, &middle, lanes);
  EACH_LANE(i, lanes) {
    __global float4* out = aovs + AOV_VECTORS * i;
    const bool seen = MASK_LANE(hit, i) != 0;
    const float3 ng = seen ? get3(&s->ng, i) : (float3)(0.0f);
    out[5] = (float4)(ng, REAL_LANE(steps, i));
    out[6] = (float4)(seen ? REAL_LANE(s->at.u, i) : 0.0f, seen ? REAL_LANE(s->at.v, i) : 0.0f, 0.0f, 0.0f);
  }
}
#endif

// see_surfaces() for camera rays in the middles of pixels, which pass surfaces that are cut away; s and bsdf
// receive what they see. Returns the lanes of `lanes` that see anything.
static inline MASK see_middles(const Scene* scene, SceneRays* rays, MASK lanes, Encounters* met,
                               SurfaceInteractions* s, Bsdfs* bsdf, u32* counts) {
  see_surfaces(scene, rays, ALL_LANES, true, met, counts, lanes);
  for (;;) {
    const MASK hit = lanes & hit_anything(&met->hit);
    interact(scene, rays->o, rays->d, &met->hit, &met->face, s, hit);
    set_footprints(scene, rays, met->hit.t, s, hit);
    note_depth(met, s, hit);
    HAVING(HAS_PARALLAX, add_parallax(scene, rays->d, s, hit);)
    HAVING(HAS_RELIEF, add_relief(scene, rays->d, s, hit);)
    *bsdf = make_bsdfs(scene, s, met->before, met->after, hit);
    if (!HAS_SHADOW_FILTERS) return hit;
    const Interfaces interface = make_interface(scene, bsdf, negate3(rays->d), hit);
    const MASK passing = cut_away(bsdf, &interface, hit) & may_cross(rays, hit);
    if (!any_lane(passing)) return hit;
    continue_behind(scene->info, rays, &met->hit, met->face.entering, passing);
    see_behind(scene, rays, ALL_LANES, met, counts, passing);
  }
}

// One work-item of the kernel below: the pixels from `first` on.
NEVER_INLINE void first_surfaces_item(const Scene* scene, __global const u32* restrict camera_media,
                                      __global const u32* restrict pixels, __global float4* restrict aovs,
                                      __global u32* restrict counters, u32 x0, u32 y0, u32 width,
                                      u32 pixel_count, u32 listed, u32 first) {
  u32 counts[COUNTERS];
  for (u32 k = 0; k < COUNTERS; ++k) counts[k] = 0;
  start_marching(counts);
  const MediaStack stack = read_media(camera_media);
  MASK lanes = lanes_of((1u << min((u32)BATCH, pixel_count - first)) - 1u);
  REAL x = (REAL)(0.0f), y = (REAL)(0.0f);
  for (u32 i = 0; i < BATCH; ++i) {
    uint2 pixel = (uint2)(x0 + (first + i) % width, y0 + (first + i) / width);
    if (listed && MASK_LANE(lanes, i)) {
      const u32 of_image = pixels[first + i];
      pixel = (uint2)(of_image & 0xffffu, of_image >> 16);
      if (of_image == NO_PIXEL) MASK_LANE(lanes, i) = 0;
    }
    REAL_LANE(x, i) = (float)pixel.x + 0.5f;
    REAL_LANE(y, i) = (float)pixel.y + 0.5f;
  }
  if (!any_lane(lanes)) return;
  const CameraRays camera = camera_rays(scene->info, x, y, (REAL)(0.0f), lanes);
  SceneRays rays = scene_rays(&camera, stack);
  Encounters met;
  SurfaceInteractions s;
  Bsdfs bsdf;
  const MASK hit = see_middles(scene, &rays, lanes, &met, &s, &bsdf, counts);
  const REAL3 albedo = surface_color(scene, &bsdf, negate3(rays.d), hit);
  const REAL sunk = way_to_heights(scene, &s, rays.d, hit);
  const REAL3 world = add3(add3(along3(s.p, sunk, rays.d), all3(scene->info->origin_rest.xyz)),
                           all3(scene->info->origin.xyz));
  const REAL depth = (met.hit.t + sunk) * dot3(rays.d, all3(scene->info->camera_forward.xyz));
  EACH_LANE(i, lanes) {
    __global float4* out = aovs + AOV_VECTORS * (first + i);
    if (!MASK_LANE(hit, i)) {
      out[0] = (float4)(0.0f, 0.0f, 0.0f, INFINITY);
      out[1] = (float4)(0.0f, 0.0f, 0.0f, -1.0f);
      out[2] = (float4)(0.0f, 0.0f, 0.0f, -1.0f);
      continue;
    }
    out[0] = (float4)(get3(&s.ns, i), REAL_LANE(depth, i));
    out[1] = (float4)(get3(&world, i), (float)scene->instances[MASK_LANE(met.hit.instance, i)].object);
    out[2] = (float4)(get3(&albedo, i), (float)MASK_LANE(met.face.material, i));
  }
  HAVING(FEATURE_AOVS, write_features(scene, stack, x, y, lanes, counts, aovs + AOV_VECTORS * first);)
  HAVING(ALL_AOVS, write_more(scene, stack, x, y, lanes, hit, &s, counts, aovs + AOV_VECTORS * first);)
  add_finished(counters, lane_count(lanes), pixel_count);
}

// Reads the scene; writes AOV_VECTORS float4 a pixel of the rectangle (with `listed`, of the image's pixel
// that `pixels` has for it), through the pixel's centre: (normal, depth along the view), (position in the
// world, object), (albedo, material). Where nothing is seen depth is infinite, object and material are -1,
// the rest is 0; adds the pixels finished to counters. A work-item takes BATCH pixels in a row.
__kernel void first_surfaces(SCENE_PARAMETERS, __global const u32* restrict camera_media,
                             __global const u32* restrict pixels, __global float4* restrict aovs,
                             __global u32* restrict counters, u32 x0, u32 y0, u32 width, u32 pixel_count,
                             u32 listed) {
  const Scene scene = SCENE_OF_PARAMETERS;
  const u32 first = get_global_id(0) * BATCH;
  if (first >= pixel_count) return;
  first_surfaces_item(&scene, camera_media, pixels, aovs, counters_of(counters, first / BATCH), x0, y0, width,
                      pixel_count, listed, first);
}
