// Finds the media that contain a place by following a line from it to the outside.
#pragma once
#include "lib/path/segment.cl"

// The line leaves `medium`: one that it entered, or one that contains the camera. Of the latter, media left
// later were entered earlier, so they go to the far end.
static inline void leave_medium(u32 medium, MediaStack* entered, MediaStack* holding) {
  if (!cross_one(entered, (int)medium, false)) put_below(holding, (int)medium);
}

#if HAS_TOUCHING
// Processes the line at coincident faces. Returns the distance of the last one.
static inline float cross_faces(const Scene* scene, SceneRays* rays, const Hits* hits, MediaStack* entered,
                                MediaStack* holding, u32* counts) {
  const Hit first = get_hit(hits, 0);
  ListedFace listed[MOST_TOUCHING];
  Touching touching;
  touching.met.faces = listed;
  HAVING(HAS_OBJECT_MOTION, touching.met.time = 0.0f;)
  if (HAS_SIDES && first.instance >= scene->info->instance_count) {
    HAVING(HAS_SIDES,
           rays->sides ^= find_touching_fields(scene, rays, 0, MARCH_TO_SEE, &first, &touching, counts);)
  } else
    find_touching(scene, get3(&rays->o, 0), get3(&rays->d, 0), REAL_LANE(rays->t_min, 0), &first, &touching);
  const Stretch* met = &touching.met;
  Changes changes = faces_of(scene, met);
  take_out_pairs(scene, met, &changes);
  while (changes.left) leave_medium(take_face(scene, met, &changes.left, false), entered, holding);
  enter_all(scene, met, changes.entered, entered);
  return touching.end;
}
#endif

// The media around the place p: a solid that the line leaves without having entered it contains p, and the
// nearest such exit was entered last.
NEVER_INLINE MediaStack media_around(const Scene* scene, float3 p) {
  const float3 d =
      (float3)(0.3141f, 0.8660f, 0.3890f);  // not along an axis that a scene is likely to be aligned with
  const MASK lane = lanes_of(1u);
  const CameraRays line = endless_ray(scene->info, all3(p), renormalized3(all3(d)), (REAL)(0.0f), lane);
  const MediaStack none = {0, 0};
  SceneRays rays = scene_rays(&line, none);  // one ray, in lane 0
  u32 counts[COUNTERS];                      // required by marching, unused here
  for (u32 i = 0; i < COUNTERS; ++i) counts[i] = 0;
  start_marching(counts);
  MediaStack entered = none, holding = none;
  for (u32 i = 0; i < 4096u; ++i) {
    Hits hits;
    nearest_hits(scene, &rays, lane, false, &hits, counts);
    if (MASK_LANE(hits.instance, 0) == (int)NO_INSTANCE) break;
    const Faces faces = hit_faces(scene, rays.d, &hits, lane);
    const MASK touching = may_touch_others(scene->instances, &hits, lane);
    HAVING(HAS_TOUCHING, if (any_lane(touching)) REAL_LANE(hits.t, 0) =
                             cross_faces(scene, &rays, &hits, &entered, &holding, counts);)
    continue_behind(scene->info, &rays, &hits, faces.entering, lane);
    if (any_lane(touching)) continue;
    __global const Material* material = scene->materials + MASK_LANE(faces.material, 0);
    if (!(material->flags & MATERIAL_TRANSMITS) || (material->flags & MATERIAL_THIN)) continue;
    if (MASK_LANE(faces.entering, 0))
      cross_one(&entered, (int)material->medium, true);
    else
      leave_medium(material->medium, &entered, &holding);
  }
  return holding;
}
