// Objects that move while the shutter is open: a ray of time t, in [0, 1), meets each at its position then.
// The ray is transformed to when the shutter opened: shifted by the object's row of the table `moves` times
// t, then rotated and scaled about points by its rows of `turns`. The object's transform and bounds are
// unchanged.
#pragma once
#include "lib/core/lanes.h"
#include "lib/core/tables.h"
#include "lib/core/turns.cl"

// World points at these times, moved with instance `index` back to when the shutter opened.
static inline REAL3 still_points(const Scene* scene, u32 index, REAL3 p, REAL time) {
  HAVING(HAS_TURNS, return unturned_points(scene->turns, scene->moves[index], p, time);)
  if (HAS_OBJECT_MOTION) return along3(p, -time, all3(scene->moves[index].xyz));
  return p;
}
static inline float3 still_point(const Scene* scene, u32 index, float3 p, float time) {
  if (HAS_OBJECT_MOTION & !HAS_TURNS) return p - time * scene->moves[index].xyz;
  const REAL3 still = still_points(scene, index, all3(p), (REAL)(time));
  return get3(&still, 0);
}

// Moves directions back likewise; moves normals and surface vectors forward from when the shutter opened; the
// instance's scale at the time, and the largest coordinate that limits its points' precision.
static inline REAL3 still_vectors(const Scene* scene, u32 index, REAL3 d, REAL time) {
  return EITHER(HAS_TURNS, unturned_vectors(scene->turns, scene->moves[index], d, time), d);
}
static inline float3 still_vector(const Scene* scene, u32 index, float3 d, float time) {
  const REAL3 still = still_vectors(scene, index, all3(d), (REAL)(time));
  return get3(&still, 0);
}
static inline REAL3 moved_normals(const Scene* scene, u32 index, REAL3 n, REAL time) {
  return EITHER(HAS_TURNS, turned_normals(scene->turns, scene->moves[index], n, time), n);
}
static inline float3 moved_normal(const Scene* scene, u32 index, float3 n, float time) {
  const REAL3 moved = moved_normals(scene, index, all3(n), (REAL)(time));
  return get3(&moved, 0);
}
static inline REAL3 moved_vectors(const Scene* scene, u32 index, REAL3 a, REAL time) {
  return EITHER(HAS_TURNS, turned_vectors(scene->turns, scene->moves[index], a, time), a);
}
static inline REAL moved_size(const Scene* scene, u32 index, REAL time) {
  return EITHER(HAS_TURNS, turned_size(scene->turns, scene->moves[index], time), (REAL)(1.0f));
}
static inline float moved_extent(const Scene* scene, u32 index) {
  return EITHER(HAS_TURNS, turned_extent(scene->turns, scene->moves[index]), 0.0f);
}
