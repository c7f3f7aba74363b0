// Crevices of fields that ambient light does not reach.
#pragma once
#include "lib/path/scene_ray.cl"
#if HAS_OCCLUSION
#include "lib/path/fields.cl"
#include "lib/sdf/light.cl"

// The part of ambient light that the field of a hit lets reach that point of it: 1 for everything else, and
// where the field has no occlusion.
NEVER_INLINE REAL field_openness(const Scene* scene, const SceneRays* rays, const Hits* hits, MASK lanes) {
  REAL open = (REAL)(1.0f);
  for (u32 index = scene->info->instance_count; index < scene->info->field_end; ++index) {
    const float reach = scene->sdf_fields[scene->instances[index].root].occlusion_reach;
    const MASK mine = lanes & MASK_OF(hits->instance == (int)index);
    if (!(reach > 0.0f) || !any_lane(mine)) continue;
    const REAL time = time_of_rays(rays);
    const REAL3 still = still_points(scene, index, rays->o, time);
    const REAL3 o = field_points(scene->instances + index, still),
                d = object_vectors(scene->instances + index, still_vectors(scene, index, rays->d, time));
    const REAL value = sdf_openness(scene, scene->instances[index].root, along3(o, hits->t, d),
                                    unit3(hits->ng), reach, mine);
    open = select(open, value, mine);
  }
  return open;
}
#endif
