// What fields do to light besides stopping it: crevices that ambient light does not reach, and soft shadows.
#ifndef SUNDOG_LIB_FIELD_LIGHT_CL
#define SUNDOG_LIB_FIELD_LIGHT_CL
#include "lib/path/scene_ray.cl"
#if HAS_SDF
#include "lib/path/fields.cl"
#include "lib/sdf/light.cl"
#endif

// The part of ambient light that the field of a hit lets reach that point of it: 1 for everything else, and
// where the field has no occlusion.
#if HAS_OCCLUSION
NEVER_INLINE REAL field_openness(const Scene* scene, const SceneRays* rays, const Hits* hits, MASK lanes) {
  REAL open = (REAL)(1.0f);
  for (u32 index = scene->info->instance_count; index < scene->info->field_end; ++index) {
    const float reach = scene->sdf_fields[scene->instances[index].root].occlusion_reach;
    const MASK mine = lanes & MASK_OF(hits->instance == (int)index);
    if (!(reach > 0.0f) || !any_lane(mine)) continue;
    const REAL3 o = field_points(scene->instances + index, rays->o),
                d = object_vectors(scene->instances + index, rays->d);
    const REAL value = sdf_openness(scene, scene->instances[index].root, along3(o, hits->t, d),
                                    unit3(hits->ng), reach, mine);
    open = select(open, value, mine);
  }
  return open;
}
#else
static inline REAL field_openness(const Scene* scene, const SceneRays* rays, const Hits* hits, MASK lanes) {
  return (REAL)(1.0f);
}
#endif

// What the fields with soft shadows let pass along the rays.
#if HAS_SOFT_SHADOWS
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
#else
static inline REAL soft_shadows(const Scene* scene, const SceneRays* rays, MASK active, u32* counts) {
  return (REAL)(1.0f);
}
#endif

#endif
