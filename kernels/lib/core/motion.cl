// Things that move straight on while the shutter is open: a ray of time t, in [0, 1), meets each where it is
// then. The world is shifted about the ray, by a thing's row of the table `moves` times t, to where the thing
// was when the shutter opened; its transform, bounds in its own space and normals stay as they are.
#ifndef SUNDOG_LIB_MOTION_CL
#define SUNDOG_LIB_MOTION_CL
#include "lib/core/lanes.h"
#include "lib/core/tables.h"

#if HAS_OBJECT_MOTION
// Points of the world at these times where instance `index` would have had them when the shutter opened.
static inline REAL3 still_points(const Scene* scene, u32 index, REAL3 p, REAL time) {
  return along3(p, -time, all3(scene->moves[index].xyz));
}
static inline float3 still_point(const Scene* scene, u32 index, float3 p, float time) {
  return p - time * scene->moves[index].xyz;
}
#else
static inline REAL3 still_points(const Scene* scene, u32 index, REAL3 p, REAL time) { return p; }
static inline float3 still_point(const Scene* scene, u32 index, float3 p, float time) { return p; }
#endif

#endif
