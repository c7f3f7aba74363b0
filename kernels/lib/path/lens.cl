// Camera rays of a sample, with a lens and a moving camera if the scene has these.
#pragma once
#include "lib/core/directions.cl"
#include "lib/core/sampler_lanes.cl"
#include "lib/path/camera.cl"

// A uniformly distributed point of the regular polygon with `blades` corners on the unit circle: chooses a
// triangle, then a point in it.
static inline void place_in_polygon(float blades, REAL u_x, REAL u_y, REAL* x, REAL* y) {
  const REAL scaled = u_x * blades, blade = real_min(floor(scaled), (REAL)(blades - 1.0f));
  const REAL out = real_sqrt(real_clamp(scaled - blade, (REAL)(0.0f), (REAL)(1.0f)));
  const REAL from = blade * (2.0f * M_PI_F / blades), to = from + 2.0f * M_PI_F / blades;
  *x = out * (cos(from) + u_y * (cos(to) - cos(from)));
  *y = out * (sin(from) + u_y * (sin(to) - sin(from)));
}

// Positions of samples in the image, on the lens, in time.
typedef struct CameraSamples {
  REAL x, y;
  HAVING(HAS_LENS, REAL lens_x; REAL lens_y;)
  HAVING(HAS_MOTION, REAL time;)
} CameraSamples;

// The pinhole camera at one time, before lens and motion; `along` has length 1 along the view.
typedef struct CameraPlaces {
  REAL3 position, along, dx, dy;
  HAVING(HAS_ORTHOGRAPHIC, REAL3 forward;)
} CameraPlaces;

static inline REAL sampled_time(const CameraSamples* samples) {
  return EITHER(HAS_MOTION, samples->time, (REAL)(0.0f));
}

static inline void move_camera(__global const SceneInfo* restrict info, REAL time, CameraPlaces* camera) {
  camera->position = along3(camera->position, time, all3(info->moved_position.xyz));
  camera->along = along3(camera->along, time, all3(info->moved_corner.xyz));
  camera->dx = along3(camera->dx, time, all3(info->moved_dx.xyz));
  camera->dy = along3(camera->dy, time, all3(info->moved_dy.xyz));
  HAVING(HAS_ORTHOGRAPHIC,
         const float3 turned = (float3)(info->moved_position.w, info->moved_corner.w, info->moved_dx.w);
         camera->forward = along3(camera->forward, time, all3(turned));)
}

// The origin's offset by the lens.
static inline REAL3 lens_offset(__global const SceneInfo* restrict info, REAL u_x, REAL u_y) {
  REAL x, y;
  if (info->lens_y.w > 0.0f)
    place_in_polygon(info->lens_y.w, u_x, u_y, &x, &y);
  else
    place_in_disk(u_x, u_y, &x, &y);
  return add3(scale3(all3(info->lens_x.xyz), x), scale3(all3(info->lens_y.xyz), y));
}
static inline void pass_lens(__global const SceneInfo* restrict info, REAL u_x, REAL u_y,
                             CameraPlaces* camera) {
  const REAL3 offset = lens_offset(info, u_x, u_y);
  camera->position = add3(camera->position, offset);
  camera->along =
      along3(camera->along, (REAL)(-1.0f / info->lens_x.w), offset);  // still through the point in focus
}

// Samples the lens and time.
static inline void set_camera_samples(const LaneSamples* at, CameraSamples* samples) {
  HAVING(HAS_LENS, pair_lanes(at, (MASK)((int)DIMENSION_PIXEL), true, &samples->lens_x, &samples->lens_y);)
  HAVING(HAS_MOTION, REAL free; pair_lanes(at, (MASK)((int)DIMENSION_TIME), false, &samples->time, &free);)
}

// The samples' rays.
static inline Rays sampled_camera_rays(__global const SceneInfo* restrict info,
                                       const CameraSamples* samples) {
  if (!(HAS_LENS | HAS_CAMERA_MOTION)) {
    Rays still = camera_rays(info, samples->x, samples->y);
    set_ray_times(sampled_time(samples), &still);
    return still;
  }
  CameraPlaces camera;
  camera.position = all3(info->camera_position.xyz);
  camera.along = all3(info->camera_corner.xyz);
  camera.dx = all3(info->camera_dx.xyz);
  camera.dy = all3(info->camera_dy.xyz);
  HAVING(HAS_ORTHOGRAPHIC, camera.forward = all3(info->camera_forward.xyz);)
  if (HAS_CAMERA_MOTION) move_camera(info, sampled_time(samples), &camera);
  camera.along = along3(along3(camera.along, samples->x, camera.dx), samples->y, camera.dy);
  HAVING(HAS_ORTHOGRAPHIC, camera.position = add3(camera.position, camera.along);
         camera.along = camera.forward;)
  HAVING(HAS_LENS, pass_lens(info, samples->lens_x, samples->lens_y, &camera);)
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
