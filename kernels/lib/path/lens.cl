// The camera's rays of a sample: through a lens, and while the camera moves, where the scene has these.
#ifndef SUNDOG_LIB_LENS_CL
#define SUNDOG_LIB_LENS_CL
#include "lib/core/directions.cl"
#include "lib/core/sampler.cl"
#include "lib/path/camera.cl"

// A point of the regular polygon of `blades` corners on the unit circle, uniform in area: one of its
// triangles, then a point of that.
static inline void place_in_polygon(float blades, REAL u_x, REAL u_y, REAL* x, REAL* y) {
  const REAL scaled = u_x * blades, blade = real_min(floor(scaled), (REAL)(blades - 1.0f));
  const REAL out = real_sqrt(real_clamp(scaled - blade, (REAL)(0.0f), (REAL)(1.0f)));
  const REAL from = blade * (2.0f * M_PI_F / blades), to = from + 2.0f * M_PI_F / blades;
  *x = out * (cos(from) + u_y * (cos(to) - cos(from)));
  *y = out * (sin(from) + u_y * (sin(to) - sin(from)));
}

// What a sample needs beside its place in the pixel.
typedef struct CameraSamples {
#if HAS_LENS
  REAL lens_x, lens_y;
#endif
#if HAS_CAMERA_MOTION || HAS_OBJECT_MOTION
  REAL time;
#endif
  u32 sample;
} CameraSamples;

// The pinhole camera at one time, before lens and motion; `along` is of length 1 along the view.
typedef struct CameraPlaces {
  REAL3 position, along, dx, dy;
} CameraPlaces;

#if HAS_CAMERA_MOTION || HAS_OBJECT_MOTION
static inline void set_time(CameraSamples* samples, u32 lane, uint2 pixel) {
  REAL_LANE(samples->time, lane) = sample_1d(pixel, samples->sample, DIMENSION_TIME);
}
static inline REAL sampled_time(const CameraSamples* samples) { return samples->time; }
#else
static inline void set_time(CameraSamples* samples, u32 lane, uint2 pixel) {}
static inline REAL sampled_time(const CameraSamples* samples) { return (REAL)(0.0f); }
#endif

#if HAS_CAMERA_MOTION
static inline void move_camera(__global const SceneInfo* restrict info, const CameraSamples* samples,
                               CameraPlaces* camera) {
  camera->position = along3(camera->position, samples->time, all3(info->moved_position.xyz));
  camera->along = along3(camera->along, samples->time, all3(info->moved_corner.xyz));
  camera->dx = along3(camera->dx, samples->time, all3(info->moved_dx.xyz));
  camera->dy = along3(camera->dy, samples->time, all3(info->moved_dy.xyz));
}
#else
static inline void move_camera(__global const SceneInfo* restrict info, const CameraSamples* samples,
                               CameraPlaces* camera) {}
#endif

#if HAS_LENS
static inline void set_lens_place(CameraSamples* samples, u32 lane, uint2 pixel) {
  const float2 u = sample_2d(pixel, samples->sample, DIMENSION_LENS);
  REAL_LANE(samples->lens_x, lane) = u.x;
  REAL_LANE(samples->lens_y, lane) = u.y;
}
// What the lens adds to the origin, by its two numbers.
static inline REAL3 lens_offset(__global const SceneInfo* restrict info, REAL u_x, REAL u_y) {
  REAL x, y;
  if (info->lens_y.w > 0.0f)
    place_in_polygon(info->lens_y.w, u_x, u_y, &x, &y);
  else
    place_in_disk(u_x, u_y, &x, &y);
  return add3(scale3(all3(info->lens_x.xyz), x), scale3(all3(info->lens_y.xyz), y));
}
static inline void pass_lens(__global const SceneInfo* restrict info, const CameraSamples* samples,
                             CameraPlaces* camera) {
  const REAL3 offset = lens_offset(info, samples->lens_x, samples->lens_y);
  camera->position = add3(camera->position, offset);
  camera->along =
      along3(camera->along, (REAL)(-1.0f / info->lens_x.w), offset);  // still through what is sharp
}
#else
static inline void set_lens_place(CameraSamples* samples, u32 lane, uint2 pixel) {}
static inline void pass_lens(__global const SceneInfo* restrict info, const CameraSamples* samples,
                             CameraPlaces* camera) {}
#endif

static inline void set_camera_sample(CameraSamples* samples, u32 lane, uint2 pixel) {
  set_lens_place(samples, lane, pixel);
  set_time(samples, lane, pixel);
}

// The rays through the places (x, y) of the image.
static inline Rays sampled_camera_rays(__global const SceneInfo* restrict info, REAL x, REAL y,
                                       const CameraSamples* samples) {
  if (!(HAS_LENS | HAS_CAMERA_MOTION)) {
    Rays still = camera_rays(info, x, y);
    set_ray_times(sampled_time(samples), &still);
    return still;
  }
  CameraPlaces camera = {all3(info->camera_position.xyz), all3(info->camera_corner.xyz),
                         all3(info->camera_dx.xyz), all3(info->camera_dy.xyz)};
  move_camera(info, samples, &camera);
  camera.along = along3(along3(camera.along, x, camera.dx), y, camera.dy);
  pass_lens(info, samples, &camera);
  const REAL depth_to_t = length3(camera.along);
  Rays rays;
  rays.o = camera.position;
  rays.d = scale3(camera.along, 1.0f / depth_to_t);
  rays.t_min = info->camera_forward.w * depth_to_t;
  rays.t_max = info->background_bottom.w * depth_to_t;
  start_cones(info, &rays);
  set_ray_times(sampled_time(samples), &rays);
  return rays;
}

#endif
