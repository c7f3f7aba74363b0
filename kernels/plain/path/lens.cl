// Camera rays of samples, with a lens and a moving camera if the scene has these, and a reconstruction filter
// (shared/filter.h).
#include "plain/path/directions.cl"
#include "plain/path/scene_ray.cl"
#include "shared/filter.h"

void places_in_pixels(const SampleAt* at, HERE, UNIFORM u32 samples, float* x, float* y);
void pair_lanes(const SampleAt* at, int dimension, UNIFORM bool later, float* u, float* v);

// A uniformly distributed point of the regular polygon with `blades` corners on the unit circle: chooses a
// triangle, then a point in it.
static inline void place_in_polygon(UNIFORM float blades, float u_x, float u_y, float* x, float* y) {
  const float scaled = u_x * blades, blade = real_min(floor(scaled), blades - 1.0f);
  const float out = real_sqrt(real_clamp(scaled - blade, 0.0f, 1.0f));
  const float from = blade * (2.0f * M_PI_F / blades), to = from + 2.0f * M_PI_F / blades;
  *x = out * (cos(from) + u_y * (cos(to) - cos(from)));
  *y = out * (sin(from) + u_y * (sin(to) - sin(from)));
}

// The origin's offset by the lens.
static inline float3 lens_offset(UNIFORM __global const SceneInfo* info, float u_x, float u_y) {
  float x, y;
  if (info->lens_y.w > 0.0f)
    place_in_polygon(info->lens_y.w, u_x, u_y, &x, &y);
  else
    place_in_disk(u_x, u_y, &x, &y);
  return info->lens_x.xyz * x + info->lens_y.xyz * y;
}

// The ray of a sample at the place (x, y) of the image.
static inline CameraRay sampled_camera_ray(UNIFORM __global const SceneInfo* info, const SampleAt* at,
                                           float x, float y) {
  float time = 0.0f;
  if (HAS_MOTION) {
    float free = 0.0f;
    pair_lanes(at, (int)DIMENSION_TIME, false, &time, &free);
  }
  if (!HAS_LENS && !HAS_CAMERA_MOTION) return camera_rays(info, x, y, time);
  float3 o = info->camera_position.xyz, corner = info->camera_corner.xyz;
  float3 dx = info->camera_dx.xyz, dy = info->camera_dy.xyz;
  if (HAS_CAMERA_MOTION) {
    o = along(o, time, info->moved_position.xyz);
    corner = along(corner, time, info->moved_corner.xyz);
    dx = along(dx, time, info->moved_dx.xyz);
    dy = along(dy, time, info->moved_dy.xyz);
  }
  float3 ahead = along(along(corner, x, dx), y, dy);
  if (HAS_ORTHOGRAPHIC) {
    o = o + ahead;
    ahead = info->camera_forward.xyz;
    if (HAS_CAMERA_MOTION) {
      const float3 turned = (float3)(info->moved_position.w, info->moved_corner.w, info->moved_dx.w);
      ahead = along(ahead, time, turned);
    }
  }
  if (HAS_LENS) {
    float u_x = 0.0f, u_y = 0.0f;
    pair_lanes(at, (int)DIMENSION_PIXEL, true, &u_x, &u_y);
    const float3 offset = lens_offset(info, u_x, u_y);
    o = o + offset;
    ahead = along(ahead, -1.0f / info->lens_x.w, offset);  // still through the point in focus
  }
  return clipped_ray(info, o, ahead, time);
}

// The filter's offset along an axis for the sample value u in [0, 1). Multiplies `sign` by the filter's sign
// there.
static inline float filter_offset(UNIFORM __global const float* table, float u, float* sign) {
  const float below = table[0];
  const bool lobe = u < below;
  const float side = 2.0f * (lobe ? u / below : (u - below) / (1.0f - below)) - 1.0f;
  const float at = fabs(side) * (float)FILTER_STEPS;
  const int step = min((int)at, FILTER_STEPS - 1), first = (lobe ? FILTER_BELOW : FILTER_ABOVE) + step;
  const float near = table[first], far = table[first + 1];
  if (lobe) *sign = -*sign;
  return copysign(near + (at - (float)step) * (far - near), side);
}

// The ray of a sample, where a pixel has `samples`; `sign`: the sample's weight, 1.0 or -1.0.
ENTRY static inline SceneRay sample_ray(UNIFORM const Scene* scene, const SampleAt* at, UNIFORM u32 samples,
                                        UNIFORM const MediaStack* around, OUT float* sign) {
  float x, y, weight = 1.0f;
  places_in_pixels(at, samples, &x, &y);
  if (HAS_FILTER && samples > 1u) {
    x = 0.5f + filter_offset(scene->filter, x, &weight);
    y = 0.5f + filter_offset(scene->filter, y, &weight);
  }
  *sign = weight;
  const CameraRay camera = sampled_camera_ray(scene->info, at, (float)at->x + x, (float)at->y + y);
  return begun_ray(&camera, around);
}
