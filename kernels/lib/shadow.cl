// How much of a light reaches a point. Opaque scenes end at the first occluder; else transmissive things are
// filters: each interface lets its transmission through (1 - F of a dielectric, on the straight line), and
// media absorb.
#ifndef SUNDOG_LIB_SHADOW_CL
#define SUNDOG_LIB_SHADOW_CL
#include "lib/segment.cl"

#define MAX_FILTERS 64u

// Factor on the light from (o, wi) up to `distance`. `stack` is the media at the point.
static inline float3 visibility(TRACE_PARAMETERS, SHADE_PARAMETERS, float3 o, float3 wi, float distance,
                                MediaStack stack, u32* counts) {
#if HAS_SHADOW_FILTERS
  float3 through = (float3)(1.0f);
  float t_min = 0.0f, from = 0.0f;
  for (u32 filter = 0; filter < MAX_FILTERS; ++filter) {
    const Hit hit = trace_closest(TRACE_ARGUMENTS, o, wi, t_min, distance);
    const u32 here = current_medium(media, stack);
    const float end = hit.instance == NO_INSTANCE ? distance : hit.t;
    if (hit.instance == NO_INSTANCE) return through * absorb(media, here, end - from);
    __global const Material* material = materials + hit_material(TRACE_ARGUMENTS, SHADE_ARGUMENTS, &hit);
    if (!(material->flags & MATERIAL_TRANSMITS) || (material->flags & MATERIAL_SHADOW_OPAQUE))
      return (float3)(0.0f);
    t_min = hit.t;
    u32 there = here;
    const float3 normal = outward_normal(TRACE_ARGUMENTS, &hit);
    if (!(material->flags & MATERIAL_THIN)) {
      cross_boundary(&stack, material->medium, dot(normal, wi) < 0.0f);
      there = current_medium(media, stack);
      if (there == here) continue;
      through *= absorb(media, here, end - from);
      from = end;
    }
    through *= material->transmission.xyz;
    if (material->kind == MATERIAL_DIELECTRIC) {
      // The straight ray stands for one that bends, whose slant is this one in the rarer medium: a pane at
      // any angle then loses (1 - F)^2, and nothing to a total reflection that the bent ray would not meet.
      const float ratio = media[there].absorption.w / media[here].absorption.w;
      const float eta = fmax(ratio, 1.0f / ratio);
      const float cos_i = fmin(fabs(dot(unit(normal), wi)), 1.0f);
      through *= 1.0f - fresnel_reflectance(cos_i, refracted_cosine(cos_i, eta), eta);
    }
    if (!(fmax(through.x, fmax(through.y, through.z)) > 0.0f)) return (float3)(0.0f);
  }
  counts[COUNT_SHADOW_LIMIT] += 1u;
  return (float3)(0.0f);
#else
  return trace_any(TRACE_ARGUMENTS, o, wi, 0.0f, distance) ? (float3)(0.0f) : (float3)(1.0f);
#endif
}

#endif
