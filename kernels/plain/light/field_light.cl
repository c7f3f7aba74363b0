// Light about distance fields: their soft shadows, and crevices that ambient light does not reach.
#include "plain/shade/interface.h"

float time_of_rays(const SceneRay* ray);
float sdf_openness(UNIFORM const Scene* scene, UNIFORM u32 field, float3 p, float3 normal,
                   UNIFORM float reach, HERE);
float sdf_soft_shadow(UNIFORM const Scene* scene, UNIFORM u32 field, float3 p, float3 wi, float t_min,
                      float t_max, UNIFORM u32* steps_left, HERE);
UNIFORM u32 steps_left(UNIFORM __global const SdfField* field, UNIFORM const u32* counts);
void pay_for_steps(UNIFORM __global const SdfField* field, UNIFORM u32 steps, UNIFORM u32* counts);

// The ray in the space of field `index`, of which it keeps the parameter: returns the direction.
HAVING(HAS_SDF)
static inline float3 ray_in_field(UNIFORM const Scene* scene, UNIFORM u32 index, const SceneRay* ray,
                                  OUT float3* o) {
  __global const Instance* instance = scene->instances + index;
  const float time = time_of_rays(ray);
  *o = field_points(instance, still_points(scene, index, ray->o, time));
  return object_vectors(instance, still_vectors(scene, index, ray->d, time));
}

// The fraction of light that fields with soft shadows let pass along the ray.
HAVING(HAS_SOFT_SHADOWS)
static float soft_shadows(UNIFORM const Scene* scene, const SceneRay* ray, UNIFORM u32* counts) {
  float through = 1.0f;
  for (u32 index = scene->info->instance_count; index < scene->info->field_end; ++index) {
    const u32 number = scene->instances[index].root;
    __global const SdfField* field = scene->sdf_fields + number;
    if (!(field->shadow_hardness > 0.0f)) continue;
    float3 o;
    const float3 d = ray_in_field(scene, index, ray, &o);
    const float speed = length(d);
    const float threshold =
        real_clamp(ray->footprint * speed * field->detail, field->lower.w, field->upper.w);
    const bool leaving = (ray->from | 1) == (int)(index * 2u + 1u);
    const float start = leaving ? 4.0f * threshold : ray->t_min * speed;  // off its own surface
    const u32 before = steps_left(field, counts);
    u32 left = before;
    through *= sdf_soft_shadow(scene, number, o, d * (1.0f / speed), start, ray->t_max * speed, &left);
    pay_for_steps(field, before - left, counts);
  }
  return through;
}

// The part of ambient light that the field of a hit lets reach that point of it: 1 for everything else, and
// where the field has no occlusion.
HAVING(HAS_OCCLUSION)
static float field_openness(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceHit* hit) {
  float open = 1.0f;
  for (u32 index = scene->info->instance_count; index < scene->info->field_end; ++index) {
    const u32 field = scene->instances[index].root;
    const float reach = scene->sdf_fields[field].occlusion_reach;
    if (!(reach > 0.0f && hit->instance == (int)index)) continue;
    float3 o;
    const float3 d = ray_in_field(scene, index, ray, &o);
    open = sdf_openness(scene, field, along(o, hit->t, d), unit3(hit->ng), reach);
  }
  return open;
}
