// Camera rays of samples, with a lens and a moving camera if the scene has these.
#include "plain/path/camera.cl"

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
ENTRY static inline CameraRay sampled_camera_rays(UNIFORM __global const SceneInfo* info, const SampleAt* at,
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
