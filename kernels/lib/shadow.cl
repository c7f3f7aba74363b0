// How much of a light reaches the points of a batch. Opaque scenes end at the first occluder; else
// transmissive things are filters: each interface lets its transmission through (1 - F of a dielectric, on
// the straight line), and media absorb.
#ifndef SUNDOG_LIB_SHADOW_CL
#define SUNDOG_LIB_SHADOW_CL
#include "lib/field_light.cl"
#include "lib/segment.cl"

#define MAX_FILTERS 64u

#if HAS_SHADOW_FILTERS
// A dielectric's part of light that a straight shadow ray lets through. The straight ray stands for one that
// bends, whose slant is this one in the rarer medium: a pane at any angle then loses (1 - F)^2, and nothing
// to a total reflection that the bent ray would not meet.
static inline float straight_transmittance(__global const Medium* restrict media, u32 here, u32 there,
                                           float3 normal, float3 wi) {
  const float ratio = media[there].absorption.w / media[here].absorption.w;
  const float eta = fmax(ratio, 1.0f / ratio);
  const float cos_i = fmin(fabs(dot(unit(normal), wi)), 1.0f);
  return 1.0f - fresnel_reflectance(cos_i, refracted_cosine(cos_i, eta), eta);
}

// The shadow ray at its nearest hit, having come from `from`: whether it goes on to the light with what is
// left in `through`.
static inline bool passes_filter(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRay* ray, const Hit* hit,
                                 float* from, float3* through) {
  const u32 here = current_medium(media, ray->media);
  if (hit->instance == NO_INSTANCE) {
    *through *= absorb(media, here, ray->t_max - *from);
    return false;
  }
  __global const Material* material = materials + hit_material(TRACE_ARGUMENTS, SHADE_ARGUMENTS, hit);
  if (!(material->flags & MATERIAL_TRANSMITS) || (material->flags & MATERIAL_SHADOW_OPAQUE)) {
    *through = (float3)(0.0f);
    return false;
  }
  u32 there = here;
  const float3 normal = outward_normal(TRACE_ARGUMENTS, hit);
  const bool entering = dot(normal, ray->d) < 0.0f;
  continue_behind(instances, ray, hit, entering);
  if (!(material->flags & MATERIAL_THIN)) {
    cross_boundary(&ray->media, material->medium, entering);
    there = current_medium(media, ray->media);
    if (there == here) return true;
    *through *= absorb(media, here, hit->t - *from);
    *from = hit->t;
  }
  *through *= material->transmission.xyz;
  if (material->kind == MATERIAL_DIELECTRIC)
    *through *= straight_transmittance(media, here, there, normal, ray->d);
  return fmax(through->x, fmax(through->y, through->z)) > 0.0f;
}
#endif

// through[i] becomes the factor on the light that comes along rays[i] from its end to its start, i < count.
static inline void visibilities(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRay* rays, u32 count, bool coherent,
                                float3* through, u32* counts) {
  for (u32 i = 0; i < count; ++i) through[i] = (float3)(1.0f);
#if HAS_SDF
  soft_shadows(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, count, through, counts);
#endif
#if HAS_SHADOW_FILTERS
  Hit hits[BATCH];
  u32 waiting[BATCH];
  float from[BATCH];
  for (u32 i = 0; i < count; ++i) {
    waiting[i] = i;
    from[i] = 0.0f;
  }
  for (u32 filter = 0; count && filter < MAX_FILTERS; ++filter) {
    nearest_hits(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, waiting, count, coherent && filter == 0u, true, hits,
                 counts);
    u32 left = 0;
    for (u32 k = 0; k < count; ++k) {
      const u32 i = waiting[k];
      if (passes_filter(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &rays[i], &hits[k], &from[i], &through[i]))
        waiting[left++] = i;
    }
    count = left;
  }
  counts[COUNT_SHADOW_LIMIT] += count;
  for (u32 k = 0; k < count; ++k) through[waiting[k]] = (float3)(0.0f);
#else
  u32 occluded[BATCH];
  any_hits(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, count, coherent, occluded, counts);
  for (u32 i = 0; i < count; ++i)
    if (occluded[i]) through[i] = (float3)(0.0f);
#endif
}

#endif
