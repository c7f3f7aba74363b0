// One stage: what the camera sees first, for the extra images: depth, normal, position, albedo, object and
// material.
#include "lib/core/counters.cl"
#include "lib/path/segment.cl"
#include "lib/shade/bsdf.cl"
#include "lib/shade/relief.cl"
#include "shared/launch.h"

// One work-item of the kernel below: the pixels from `first` on.
NEVER_INLINE void first_surfaces_item(const Scene* scene, __global const u32* restrict camera_media,
                                      __global const u32* restrict pixels, __global float4* restrict aovs,
                                      __global u32* restrict counters, u32 x0, u32 y0, u32 width,
                                      u32 pixel_count, u32 listed, u32 first) {
  u32 counts[COUNTERS];
  for (u32 k = 0; k < COUNTERS; ++k) counts[k] = 0;
  start_marching(counts);
  const MediaStack stack = (MediaStack)camera_media[1] << 32 | camera_media[0];
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
  const Rays camera = camera_rays(scene->info, x, y);
  SceneRays rays = scene_rays(&camera, stack);
  Encounters met;
  SurfaceInteractions s;
  next_surfaces(scene, &rays, lanes, true, &met, counts);
  const MASK hit = lanes & hit_anything(&met.hit);
  interact(scene, rays.o, rays.d, &met.hit, &met.face, hit, &s);
  set_footprints(&rays, met.hit.t, &s);
  add_relief(scene, rays.d, hit, &s);
  const Bsdfs bsdf = make_bsdfs(scene, &s, met.before, met.after, hit);
  const REAL3 world = add3(add3(s.p, all3(scene->info->origin_rest.xyz)), all3(scene->info->origin.xyz));
  const REAL depth = met.hit.t * dot3(rays.d, all3(scene->info->camera_forward.xyz));
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    __global float4* out = aovs + 3u * (first + i);
    if (!MASK_LANE(hit, i)) {
      out[0] = (float4)(0.0f, 0.0f, 0.0f, INFINITY);
      out[1] = (float4)(0.0f, 0.0f, 0.0f, -1.0f);
      out[2] = (float4)(0.0f, 0.0f, 0.0f, -1.0f);
      continue;
    }
    out[0] = (float4)(get3(&s.ns, i), REAL_LANE(depth, i));
    out[1] = (float4)(get3(&world, i), (float)scene->instances[MASK_LANE(met.hit.instance, i)].object);
    out[2] = (float4)(get3(&bsdf.diffuse, i), (float)MASK_LANE(met.face.material, i));
  }
  add_finished(counters, lane_count(lanes), pixel_count);
}

// Reads the scene; writes three float4 a pixel of the rectangle (with `listed`, of the image's pixel that
// `pixels` has for it), through the pixel's centre: (normal, depth
// along the view), (position in the world, object), (albedo, material). Where nothing is seen depth is
// infinite, object and material are -1, the rest is 0; adds the pixels finished to counters. A work-item
// takes BATCH pixels in a row.
__kernel void first_surfaces(SCENE_PARAMETERS, __global const u32* restrict camera_media,
                             __global const u32* restrict pixels, __global float4* restrict aovs,
                             __global u32* restrict counters, u32 x0, u32 y0, u32 width, u32 pixel_count,
                             u32 listed) {
  const Scene scene = SCENE_OF_PARAMETERS;
  const u32 first = get_global_id(0) * BATCH;
  if (first >= pixel_count) return;
  first_surfaces_item(&scene, camera_media, pixels, aovs, counters, x0, y0, width, pixel_count, listed,
                      first);
}
