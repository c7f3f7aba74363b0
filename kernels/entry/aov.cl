// One stage: what the camera sees first, for the extra images: depth, normal, position, albedo, object and
// material.
#include "lib/camera.cl"
#include "lib/segment.cl"

// Reads the scene; writes three float4 a pixel of the rectangle, through the pixel's centre: (normal, depth
// along the view), (position, object), (albedo, material). Where nothing is seen depth is infinite, object
// and material are -1, the rest is 0.
__kernel void first_surfaces(TRACE_PARAMETERS, SHADE_PARAMETERS, __global const u32* restrict camera_media,
                             __global float4* restrict aovs, u32 x0, u32 y0, u32 width, u32 pixel_count) {
  const u32 i = get_global_id(0);
  if (i >= pixel_count) return;
  u32 counts[COUNTERS];
  for (u32 k = 0; k < COUNTERS; ++k) counts[k] = 0;
  MediaStack stack = (MediaStack)camera_media[1] << 32 | camera_media[0];
  const CameraRay ray = camera_ray(info, (float)(x0 + i % width) + 0.5f, (float)(y0 + i / width) + 0.5f);
  const Encounter e =
      next_surface(TRACE_ARGUMENTS, SHADE_ARGUMENTS, ray.o, ray.d, ray.t_min, ray.t_max, &stack, counts);
  __global float4* out = aovs + 3u * i;
  if (e.hit.instance == NO_INSTANCE) {
    out[0] = (float4)(0.0f, 0.0f, 0.0f, INFINITY);
    out[1] = (float4)(0.0f, 0.0f, 0.0f, -1.0f);
    out[2] = (float4)(0.0f, 0.0f, 0.0f, -1.0f);
    return;
  }
  const SurfaceInteraction s = interact(TRACE_ARGUMENTS, SHADE_ARGUMENTS, ray.o, ray.d, &e.hit);
  out[0] = (float4)(s.ns, e.hit.t * dot(ray.d, info->camera_forward.xyz));
  out[1] = (float4)(s.p, (float)instances[e.hit.instance].object);
  out[2] = (float4)(s.diffuse, (float)s.material);
}
