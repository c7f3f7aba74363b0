// The rays of Whitted's tree that wait, and how far they are from the camera.
#include "plain/core.h"

// Flag in the depth of rays that do not go straight on from the camera.
#define TURNED 0x80
// Flag in the depth of a ray that met a surface with more lights than the stack has room for, and waits to
// meet it once more (devices with one ray a lane).
#define AGAIN 0x100

// Data of a ray besides its geometry.
typedef struct WaitingRay {
  float3 throughput;              // of a shadow ray: the light that it carries
  int pixel;                      // in the work-item's tile
  int depth;                      // 1 for a camera ray, 0 for a shadow ray; with TURNED and AGAIN
  HAVING(HAS_RANDOM) int branch;  // position in the ray tree, for random numbers; 0: the camera ray
} WaitingRay;

ENTRY static inline WaitingRay camera_path(int pixel) {
  WaitingRay path;
  path.throughput = (float3)(1.0f);
  path.pixel = pixel;
  path.depth = 1;
  if (HAS_RANDOM) path.branch = 0;
  return path;
}

ENTRY static inline int depth_of(const WaitingRay* path) { return path->depth & (TURNED - 1); }
static inline bool is_straight(const WaitingRay* path) { return (path->depth & TURNED) == 0; }
ENTRY static inline bool is_from_camera(const WaitingRay* path) { return (path->depth & (AGAIN - 1)) == 1; }
ENTRY static inline bool meets_again(const WaitingRay* path) {
  return HAS_ONE_RAY && (path->depth & AGAIN) != 0;
}
ENTRY static inline void meet_again(WaitingRay* path) { path->depth |= AGAIN; }
