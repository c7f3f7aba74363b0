// Starts samples of pixels, one pixel per lane: positions in the image, and camera rays.
#pragma once
#include "lib/core/directions.cl"
#include "lib/core/filter.cl"
#include "lib/core/sampler_lanes.cl"
#include "lib/path/scene_ray.cl"
#include "lib/path/tile.cl"
#include "plain/path/lens.cl"

typedef struct BegunSamples {
  LaneSamples at;
  MASK lanes;  // those with a sample
} BegunSamples;

// The samples' rays, where a pixel has `samples`; signs[lane] becomes the lane's sample weight.
static inline SceneRays begun_rays(const Scene* scene, const BegunSamples* begun, u32 samples,
                                   MediaStack around, float* signs) {
  REAL u_x, u_y;
  places_in_pixels(&begun->at, begun->lanes, samples, &u_x, &u_y);
  EACH_LANE(lane, begun->lanes) {
    signs[lane] = filter_place(scene->filter, samples, &REAL_LANE(u_x, lane), &REAL_LANE(u_y, lane));
  }
  const CameraRays camera = sampled_camera_rays(scene->info, &begun->at, TO_REAL(begun->at.x) + u_x,
                                                TO_REAL(begun->at.y) + u_y, begun->lanes);
  return scene_rays(&camera, around);
}
