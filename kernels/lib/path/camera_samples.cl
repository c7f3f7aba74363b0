// Samples of pixels as they begin, a pixel's a lane: their places in the image, and the camera's rays there.
#ifndef SUNDOG_LIB_CAMERA_SAMPLES_CL
#define SUNDOG_LIB_CAMERA_SAMPLES_CL
#include "lib/core/filter.cl"
#include "lib/core/sampler.cl"
#include "lib/path/lens.cl"
#include "lib/path/scene_ray.cl"
#include "lib/path/tile.cl"

typedef struct BegunSamples {
  REAL x, y;   // in the image
  MASK lanes;  // those that have a sample
  CameraSamples camera;
} BegunSamples;

static inline BegunSamples no_samples(void) {
  const BegunSamples none = {(REAL)(0.0f), (REAL)(0.0f), NO_LANES, {.sample = 0u}};
  return none;
}

// The lane begins with sample `sample` of its pixel. Returns whether it has one; `sign` is what the sample
// counts.
static inline bool begin_sample(const Scene* scene, const Launch* launch, __global const u32* restrict pixels,
                                u32 item, u32 lane, u32 sample, BegunSamples* begun, uint2* pixel,
                                float* sign) {
  if (!image_pixel(launch, pixels, lane_pixel(launch, item, lane), pixel)) return false;
  float2 in_pixel = pixel_sample(*pixel, sample, scene->info->samples);
  *sign = filter_place(scene->filter, scene->info->samples, &in_pixel);
  REAL_LANE(begun->x, lane) = (float)pixel->x + in_pixel.x;
  REAL_LANE(begun->y, lane) = (float)pixel->y + in_pixel.y;
  MASK_LANE(begun->lanes, lane) = -1;
  begun->camera.sample = sample;
  set_camera_sample(&begun->camera, lane, *pixel);
  return true;
}

static inline SceneRays begun_rays(const Scene* scene, const BegunSamples* begun, MediaStack around) {
  const Rays camera = sampled_camera_rays(scene->info, begun->x, begun->y, &begun->camera);
  return scene_rays(&camera, around);
}

#endif
