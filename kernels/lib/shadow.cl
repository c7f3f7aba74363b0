// How much of a light reaches the points of a batch. Opaque scenes end at the first occluder; else
// transmissive things are filters: each interface lets its transmission through (1 - F of a dielectric, on
// the straight line), and media absorb.
#ifndef SUNDOG_LIB_SHADOW_CL
#define SUNDOG_LIB_SHADOW_CL
#include "lib/field_light.cl"
#include "lib/segment.cl"

#define MAX_FILTERS 64u

#if HAS_SHADOW_FILTERS
// Shadow rays on their way.
typedef struct Filtered {
  REAL from;      // where the medium that they are in began
  REAL3 through;  // what is left of the light
} Filtered;

// A dielectric's part of light that straight shadow rays let through. The straight ray stands for one that
// bends, whose slant is this one in the rarer medium: a pane at any angle then loses (1 - F)^2, and nothing
// to a total reflection that the bent ray would not meet.
static inline REAL straight_transmittance(__global const Medium* restrict media, MASK here, MASK there,
                                          REAL3 normal, REAL3 wi, MASK lanes) {
  const REAL ratio = refraction_index(media, there, lanes) / refraction_index(media, here, lanes);
  const REAL eta = real_max(ratio, 1.0f / ratio);
  const REAL cos_i = real_min(fabs(dot3(safe_unit3(normal), wi)), (REAL)(1.0f));
  return 1.0f - fresnel_reflectance(cos_i, refracted_cosine(cos_i, eta), eta);
}

// Multiplies `through` by the transmission of the surfaces that the lanes of `lanes` pass.
static inline void filter_light(__global const Material* restrict materials,
                                __global const Medium* restrict media, const Faces* faces, MASK here,
                                MASK there, REAL3 wi, MASK lanes, REAL3* through) {
  MASK dielectric = NO_LANES;
  u32 index;
  for (MASK left = lanes; any_lane(left);) {
    const MASK mine = take_alike(faces->material, &left, &index);
    *through = select3(*through, multiply3(*through, all3(materials[index].transmission.xyz)), mine);
    if (materials[index].kind == MATERIAL_DIELECTRIC) dielectric |= mine;
  }
  if (!any_lane(dielectric)) return;
  const REAL kept = straight_transmittance(media, here, there, faces->outward, wi, dielectric);
  *through = select3(*through, scale3(*through, kept), dielectric);
}

// The lanes of `waiting` at their next hits. Returns those that go on to the light.
static inline MASK pass_filters(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRays* rays, const Hits* hits,
                                MASK waiting, Filtered* light) {
  const MASK hit = waiting & hit_anything(hits);
  const MASK here = current_media(media, rays, waiting);
  const Faces faces = hit_faces(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays->d, hits, hit);
  const int kind = (int)(MATERIAL_TRANSMITS | MATERIAL_SHADOW_OPAQUE);
  const MASK passing = hit & MASK_OF((faces.flags & kind) == (int)MATERIAL_TRANSMITS);
  light->through = select3(light->through, all3((float3)(0.0f)), hit & ~passing);
  const MASK interface = passing & MASK_OF((faces.flags & (int)MATERIAL_THIN) == 0);
  MASK there = here;
  for (u32 bits = lane_bits(interface); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    MediaStack stack = get_media(rays, i);
    cross_boundary(&stack, (u32)MASK_LANE(faces.medium, i), MASK_LANE(faces.entering, i));
    set_media(rays, i, stack);
    MASK_LANE(there, i) = (int)current_medium(media, stack);
  }
  const MASK changes = interface & MASK_OF(there != here);
  const REAL3 kept = absorb(media, here, hits->t - light->from, (waiting & ~hit) | changes);
  light->through = multiply3(light->through, kept);
  if (!any_lane(passing)) return NO_LANES;
  light->from = select(light->from, hits->t, changes);
  filter_light(materials, media, &faces, here, there, rays->d, (passing & ~interface) | changes,
               &light->through);
  continue_behind(info, rays, hits, faces.entering, passing);
  return passing & MASK_OF(greatest3(light->through) > 0.0f);
}
#endif

// The factors on the light that comes along the rays from their ends to their starts.
static inline REAL3 visibilities(TRACE_PARAMETERS, SHADE_PARAMETERS, SceneRays* rays, MASK active,
                                 bool coherent, u32* counts) {
  REAL3 through = all3((float3)(1.0f));
#if HAS_SDF
  const REAL soft = soft_shadows(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, active, counts);
  through = real3(soft, soft, soft);
#endif
#if HAS_SHADOW_FILTERS
  Filtered light = {(REAL)(0.0f), through};
  MASK waiting = active;
  for (u32 filter = 0; any_lane(waiting) && filter < MAX_FILTERS; ++filter) {
    Hits hits;
    nearest_hits(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, waiting, coherent && filter == 0u, true, &hits,
                 counts);
    waiting = pass_filters(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, &hits, waiting, &light);
  }
  counts[COUNT_SHADOW_LIMIT] += lane_count(waiting);
  return select3(light.through, all3((float3)(0.0f)), waiting);
#else
  const MASK occluded = any_hits(TRACE_ARGUMENTS, SHADE_ARGUMENTS, rays, active, coherent, counts);
  return select3(through, all3((float3)(0.0f)), occluded);
#endif
}

#endif
