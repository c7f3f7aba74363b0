// One stage: what the camera sees first, for the extra images: depth, normal, position, albedo, object and
// material.
#include "lib/counters.cl"
#include "lib/segment.cl"

// One work-item of the kernel below: the pixels from `first` on.
NEVER_INLINE void first_surfaces_item(TRACE_PARAMETERS, SHADE_PARAMETERS,
                                      __global const u32* restrict camera_media,
                                      __global float4* restrict aovs, __global u32* restrict counters, u32 x0,
                                      u32 y0, u32 width, u32 pixel_count, u32 first) {
  u32 counts[COUNTERS];
  for (u32 k = 0; k < COUNTERS; ++k) counts[k] = 0;
#if HAS_SDF
  counts[COUNT_MARCH_LEFT] = MARCH_WORK;
#endif
  const MediaStack stack = (MediaStack)camera_media[1] << 32 | camera_media[0];
  const u32 count = min((u32)BATCH, pixel_count - first);
  SceneRay rays[BATCH];
  Encounter met[BATCH];
  for (u32 i = 0; i < count; ++i) {
    const u32 pixel = first + i;
    const CameraRay camera =
        camera_ray(info, (float)(x0 + pixel % width) + 0.5f, (float)(y0 + pixel / width) + 0.5f);
    rays[i] = scene_ray(&camera, stack);
  }
  next_surfaces(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, count, true, met, counts);
  for (u32 i = 0; i < count; ++i) {
    const Encounter* e = &met[i];
    __global float4* out = aovs + 3u * (first + i);
    if (e->hit.instance == NO_INSTANCE) {
      out[0] = (float4)(0.0f, 0.0f, 0.0f, INFINITY);
      out[1] = (float4)(0.0f, 0.0f, 0.0f, -1.0f);
      out[2] = (float4)(0.0f, 0.0f, 0.0f, -1.0f);
      continue;
    }
    const SurfaceInteraction s = interact(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays[i].o, rays[i].d, &e->hit);
    out[0] = (float4)(s.ns, e->hit.t * dot(rays[i].d, info->camera_forward.xyz));
    out[1] = (float4)(s.p, (float)instances[e->hit.instance].object);
    out[2] = (float4)(s.diffuse, (float)s.material);
  }
  add_finished(counters, count, pixel_count);
}

// Reads the scene; writes three float4 a pixel of the rectangle, through the pixel's centre: (normal, depth
// along the view), (position, object), (albedo, material). Where nothing is seen depth is infinite, object
// and material are -1, the rest is 0; adds the pixels finished to counters. A work-item takes BATCH pixels in
// a row.
__kernel void first_surfaces(TRACE_PARAMETERS, SHADE_PARAMETERS, __global const u32* restrict camera_media,
                             __global float4* restrict aovs, __global u32* restrict counters, u32 x0, u32 y0,
                             u32 width, u32 pixel_count) {
  const u32 first = get_global_id(0) * BATCH;
  if (first >= pixel_count) return;
  first_surfaces_item(TRACE_ARGUMENTS, SHADE_ARGUMENTS, camera_media, aovs, counters, x0, y0, width,
                      pixel_count, first);
}
