// The rays of Whitted's tree that wait, and how far they are from the camera.
#include "plain/core.h"

// Flag in the depth of rays that do not go straight on from the camera.
#define TURNED 0x80
// A ray that met a surface with more lights than the stack has room for waits itself, to meet it once more:
// its depth then holds the next light in the bits from here on.
#define DEPTH_BITS 8

// Data of a ray besides its geometry.
typedef struct WaitingRay {
  float3 throughput;              // of a shadow ray: the light that it carries
  int pixel;                      // in the work-item's tile
  int depth;                      // 1 for a camera ray, 0 for a shadow ray; with TURNED and DEPTH_BITS
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
ENTRY static inline bool is_from_camera(const WaitingRay* path) {
  return (path->depth & ((1 << DEPTH_BITS) - 1)) == 1;
}

// The next light of a surface that the ray meets again, 0 at the first meeting (devices with one ray a lane).
ENTRY static inline int next_light(const WaitingRay* path) {
  if (HAS_ONE_RAY) return path->depth >> DEPTH_BITS;
  return 0;
}
ENTRY static inline void wait_for_light(WaitingRay* path, UNIFORM int light) {
  path->depth = (path->depth & ((1 << DEPTH_BITS) - 1)) | light << DEPTH_BITS;
}
