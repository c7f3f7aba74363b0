// Light estimated from a field: ambient occlusion and soft shadows (A. Evans 2006; I. Quilez, Soft shadows in
// raymarched SDFs, 2010).
#pragma once
#include "lib/sdf/march.cl"

// Distance of p from the surface, for occlusion.
static inline REAL open_distance(const Scene* scene, u32 index, REAL3 p, MASK active) {
  if (sdf_uneven(index, scene->sdf_parameters))
    return called_near(index, p, active, NO_LANES, scene->sdf_parameters);
  return sdf_distance(index, p, active, scene->sdf_parameters) * scene->sdf_fields[index].safety;
}

// 1 in the open, towards 0 in a crevice: five estimates along the normal, up to `reach` off the surface.
static inline REAL sdf_openness(const Scene* scene, u32 index, REAL3 p, REAL3 normal, float reach,
                                MASK active) {
  REAL missing = (REAL)(0.0f);
  float weight = 1.0f, total = 0.0f;
  for (int i = 1; i <= 5; ++i) {
    const float h = reach * (float)i * 0.2f;
    const REAL d = open_distance(scene, index, along3(p, (REAL)(h), normal), active);
    missing = fma((REAL)(weight / h), real_max(h - d, (REAL)(0.0f)), missing);
    total += weight;
    weight *= 0.6f;
  }
  return clamp(1.0f - missing / total, (REAL)(0.0f), (REAL)(1.0f));
}

// The fraction of a light that reaches p along the unit direction wi, within t_max: 0 behind the surface,
// between 0 and 1 if the way passes it within 1 / shadow_hardness of the distance. Takes its steps from
// *steps_left; when they run out, returns the estimate so far.
static inline REAL sdf_soft_shadow(const Scene* scene, u32 index, REAL3 p, REAL3 wi, REAL t_min, REAL t_max,
                                   u32* steps_left, MASK active) {
  __global const SdfField* restrict field = scene->sdf_fields + index;
  REAL enter = t_min, leave = t_max;
  clip_to_interval(field, p, wi, &enter, &leave);
  active &= MASK_OF(enter <= leave);
  REAL t = enter, open = (REAL)(1.0f);
  const u32 limit = min(field->step_limit, *steps_left);
  for (u32 i = 0; i < limit && any_lane(active); ++i) {
    *steps_left -= 1u;
    const REAL d = sdf_distance(index, along3(p, t, wi), active, scene->sdf_parameters) * field->safety;
    REAL beside = d;
    if (sdf_uneven(index, scene->sdf_parameters))
      beside = open_distance(scene, index, along3(p, t, wi), active);
    open = select(open, real_min(open, field->shadow_hardness * beside * rough_inverse(t)), active);
    t += real_max(d, 0.02f * t);  // minimum step in a penumbra
    active &= MASK_OF(open > 0.002f) & MASK_OF(t < leave);
  }
  return clamp(open, (REAL)(0.0f), (REAL)(1.0f));
}
