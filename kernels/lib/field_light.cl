// What fields do to light besides stopping it: crevices that ambient light does not reach, and soft shadows.
#ifndef SUNDOG_LIB_FIELD_LIGHT_CL
#define SUNDOG_LIB_FIELD_LIGHT_CL
#include "lib/fields.cl"
#include "lib/sdf/light.cl"

#if HAS_SDF
// open[k] becomes the part of ambient light that the field met as hits[k] lets reach that point of it: 1 for
// everything else, and where the field has no occlusion. k < count.
NEVER_INLINE void field_openness(TRACE_PARAMETERS, SHADE_PARAMETERS, const SceneRay* rays, const Hit* hits,
                                 u32 count, float* open) {
  u32 all[BATCH];
  for (u32 k = 0; k < count; ++k) {
    all[k] = k;
    open[k] = 1.0f;
  }
  for (u32 first = 0; first < count; first += LANES) {
    const RayLanes lanes = load_lanes(rays, all, first, count, hits);
    for (u32 index = info->instance_count; index < info->field_end; ++index) {
      const float reach = sdf_fields[instances[index].root].occlusion_reach;
      if (!(reach > 0.0f)) continue;
      MASK mine = NO_LANES;
      REAL3 normal = lanes.d;
      for (u32 i = 0; i < LANES && first + i < count; ++i) {
        const Hit* hit = &hits[first + i];
        if (hit->instance != index) continue;
        MASK_LANE(mine, i) = -1;
        REAL_LANE(normal.x, i) = hit->ng_x;
        REAL_LANE(normal.y, i) = hit->ng_y;
        REAL_LANE(normal.z, i) = hit->ng_z;
      }
      if (!any_lane(mine)) continue;
      const REAL3 o = object_points(instances + index, lanes.o),
                  d = object_vectors(instances + index, lanes.d);
      const REAL value = sdf_openness(SDF_ARGUMENTS, instances[index].root, along3(o, lanes.t_best, d),
                                      unit3(normal), reach, mine);
      for (u32 i = 0; i < LANES; ++i)
        if (MASK_LANE(mine, i)) open[first + i] = REAL_LANE(value, i);
    }
  }
}

// Multiplies through[k] by what the fields with soft shadows let pass along rays[k], k < count.
NEVER_INLINE void soft_shadows(TRACE_PARAMETERS, SHADE_PARAMETERS, const SceneRay* rays, u32 count,
                               float3* through, u32* counts) {
  Hit ends[BATCH];
  u32 all[BATCH];
  for (u32 k = 0; k < count; ++k) {
    all[k] = k;
    ends[k].t = rays[k].t_max;
  }
  for (u32 first = 0; first < count; first += LANES) {
    RayLanes lanes = load_lanes(rays, all, first, count, ends);
    for (u32 index = info->instance_count; index < info->field_end; ++index) {
      __global const SdfField* field = sdf_fields + instances[index].root;
      if (!(field->shadow_hardness > 0.0f)) continue;
      const MarchRays ray = march_from(SDF_ARGUMENTS, info, instances, index, false, &lanes);
      const REAL speed = length3(ray.direction);
      const REAL threshold =
          clamp(ray.footprint * speed * field->detail, (REAL)(field->lower.w), (REAL)(field->upper.w));
      const REAL start = select(ray.t_min * speed, 4.0f * threshold, ray.leaving);  // off its own surface
      const u32 before = steps_left(field, counts);
      u32 left = before;
      const REAL open = sdf_soft_shadow(SDF_ARGUMENTS, instances[index].root, ray.origin,
                                        scale3(ray.direction, 1.0f / speed), start, ray.t_max * speed,
                                        field->shadow_hardness, &left, ray.active);
      pay_for_steps(field, before - left, counts);
      for (u32 i = 0; i < LANES && first + i < count; ++i) through[first + i] *= REAL_LANE(open, i);
    }
  }
}

#endif
#endif
