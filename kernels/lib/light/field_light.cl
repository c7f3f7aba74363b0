// Fields dim light besides stopping it: soft shadows.
#pragma once
#include "lib/path/scene_ray.cl"
#if HAS_SOFT_SHADOWS
#include "lib/path/fields.cl"
#include "lib/sdf/light.cl"

// The light that fields with soft shadows let pass along the rays.
NEVER_INLINE REAL soft_shadows(const Scene* scene, const SceneRays* rays, MASK active, u32* counts) {
  REAL through = (REAL)(1.0f);
  FieldSearch search = start_search(rays, rays->t_max, active);
  for (u32 index = scene->info->instance_count; index < scene->info->field_end; ++index) {
    __global const SdfField* field = scene->sdf_fields + scene->instances[index].root;
    if (!(field->shadow_hardness > 0.0f)) continue;
    const MarchRays ray = march_from(scene, index, false, &search);
    const REAL speed = length3(ray.direction);
    const REAL threshold =
        clamp(ray.footprint * speed * field->detail, (REAL)(field->lower.w), (REAL)(field->upper.w));
    const REAL start = select(ray.t_min * speed, 4.0f * threshold, ray.leaving);  // off its own surface
    const u32 before = steps_left(field, counts);
    u32 left = before;
    const REAL open =
        sdf_soft_shadow(scene, scene->instances[index].root, ray.origin, scale3(ray.direction, 1.0f / speed),
                        start, ray.t_max * speed, field->shadow_hardness, &left, ray.active);
    pay_for_steps(field, before - left, counts);
    through *= open;
  }
  return through;
}
#endif
