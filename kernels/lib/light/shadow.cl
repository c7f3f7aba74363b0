// How much of a light reaches the points of a batch. Media absorb. Opaque scenes end at the first occluder;
// else transmissive things are filters: each interface lets its transmission through (1 - F of a dielectric,
// on the straight line).
#pragma once
#include "lib/core/optics.cl"
#include "lib/path/ray_stack.cl"
#include "lib/path/segment.cl"
#include "lib/shade/bsdf.cl"
#include "plain/shade/layers.cl"

#define MAX_FILTERS 64

// Which side of a surface of one side a shadow ray sees: where paths meet lights by chance as well, the one
// that it comes to, as those do; else the one that the light comes to.
#ifndef SHADOWS_AS_PATHS
#define SHADOWS_AS_PATHS 0
#endif

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

// The transmittance of the surfaces of `lanes`; `plain`: without their textures.
#if HAS_MAPS
NEVER_INLINE REAL3 mapped_filters(const Scene* scene, const SceneRays* rays, const Hits* hits,
                                  const Faces* faces, MASK lanes, REAL3 plain) {
  SurfaceInteractions s;
  s.p = along3(rays->o, hits->t, rays->d);
  s.ng = safe_unit3(faces->outward);
  s.ns = s.side = s.ng;
  s.instance = hits->instance;
  s.material = faces->material;
  locate(scene, hits, lanes, &s);
  set_footprints(scene, rays, hits->t, &s);
  const MASK hidden = SHADOWS_AS_PATHS ? ~faces->entering : faces->entering;
  return mapped_filter(scene, &s, hidden, plain, lanes);
}
#endif

// The transmittance of the surfaces of `lanes` for straight light with their fuzz and coats; `through`:
// without. For paths only: Whitted's layers take nothing from transmitted light.
#define LAYERS_FILTER EITHER(HAS_LAYERS, EITHER(HAS_LAYER_FILTERS, SHADOWS_AS_PATHS, 0), 0)
#if LAYERS_FILTER
NEVER_INLINE REAL3 layered_filters(const Scene* scene, const SceneRays* rays, const Hits* hits,
                                   const Faces* faces, MASK lanes, REAL3 through) {
  SurfaceInteractions s;
  interact(scene, rays->o, rays->d, hits, faces, lanes, &s);
  set_footprints(scene, rays, hits->t, &s);
  const Bsdfs bsdf = make_bsdfs(scene, &s, NO_LANES, NO_LANES, lanes);
  const REAL c = real_clamp(-dot3(bsdf.ns, rays->d), (REAL)(0.0f), (REAL)(1.0f));
  return passed_by_layers(scene, &bsdf, c, through, lanes);
}
static inline void pass_layers(const Scene* scene, const SceneRays* rays, const Hits* hits,
                               const Faces* faces, MASK lanes, REAL3* passed) {
  const MASK layered = lanes & MASK_OF((faces->flags & (int)MATERIAL_LAYERED) != 0);
  if (any_lane(layered)) *passed = layered_filters(scene, rays, hits, faces, layered, *passed);
}
#endif

// Multiplies `through` by the transmission of the surfaces that the lanes of `lanes` pass.
static inline void filter_light(const Scene* scene, const SceneRays* rays, const Hits* hits,
                                const Faces* faces, MASK here, MASK there, MASK lanes, REAL3* through) {
  MASK dielectric = NO_LANES;
  u32 index;
  REAL3 passed = all3((float3)(1.0f));
  MASK mapped = NO_LANES;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(faces->material, &left, &index);
    passed = select3(passed, all3(scene->materials[index].transmission.xyz), mine);
    if (scene->materials[index].kind == MATERIAL_DIELECTRIC) dielectric |= mine;
    if (HAS_MAPS && scene->materials[index].maps != NO_MAPS) mapped |= mine;
  }
  if (HAS_MAPS && any_lane(mapped)) {
    HAVING(HAS_MAPS, passed = mapped_filters(scene, rays, hits, faces, mapped, passed);)
  }
  HAVING(LAYERS_FILTER, pass_layers(scene, rays, hits, faces, lanes, &passed);)
  *through = select3(*through, multiply3(*through, passed), lanes);
  if (!any_lane(dielectric)) return;
  REAL kept = straight_transmittance(scene->media, here, there, faces->outward, rays->d, dielectric);
  if (HAS_THIN_WALLS) {
    const REAL cosine = real_min(fabs(dot3(safe_unit3(faces->outward), rays->d)), (REAL)(1.0f));
    kept = 1.0f - reflected_by_walls(scene, faces->material, faces->flags, cosine, 1.0f - kept, dielectric);
  }
  *through = select3(*through, scale3(*through, kept), dielectric);
}

#if HAS_TOUCHING
// The lanes of `lanes`, whose faces may touch others: hits and faces become those of what touches there, the
// media of `behind` those behind it.
static inline void pass_touching(const Scene* scene, const SceneRays* rays, Hits* hits, Faces* faces,
                                 SceneRays* behind, MASK lanes) {
  EACH_LANE(i, lanes) {
    Seen seen = {0};
    float apart;
    REAL_LANE(hits->t, i) = meet_touching(scene, rays, i, MATERIAL_TRANSMITS | MATERIAL_SHADOW_OPAQUE, hits,
                                          faces, &seen, &apart);
    set_media(behind, i, seen.behind);
  }
}
#endif

#if HAS_MEDIA
// The lanes of `passing`, of `waiting` those that pass their surfaces, in the media behind these, which
// `behind` has for those of `touching`; `there` becomes the current ones. `light` is what the media before
// leave of it. Returns the lanes whose surfaces change the light.
static inline MASK change_media(const Scene* scene, SceneRays* rays, const Hits* hits, const Faces* faces,
                                const SceneRays* behind, MASK touching, MASK waiting, MASK passing, MASK here,
                                MASK* there, REAL3* light) {
  const MASK interface = passing & MASK_OF((faces->flags & (int)MATERIAL_THIN) == 0);
  EACH_LANE(i, interface) {
    MediaStack stack = get_media(rays, i);
    if (MASK_LANE(touching, i))
      stack = get_media(behind, i);
    else
      cross_boundary(&stack, (u32)MASK_LANE(faces->medium, i), MASK_LANE(faces->entering, i));
    set_media(rays, i, stack);
    MASK_LANE(*there, i) = (int)current_medium(scene->media, stack);
  }
  rays->media_low = select(rays->media_low, behind->media_low, touching & passing);
  rays->media_high = select(rays->media_high, behind->media_high, touching & passing);
  const MASK changes = interface & MASK_OF(*there != here), missed = waiting & ~hit_anything(hits);
  const REAL3 kept = absorb(scene->media, here, hits->t - rays->since, missed | changes);
  *light = multiply3(*light, kept);
  rays->since = select(rays->since, hits->t, changes);
  return (passing & ~interface) | changes;
}
#endif

// The lanes of `waiting` at their next hits. Returns those that continue to the light, with the rest of it in
// `light`.
static inline MASK pass_filters(const Scene* scene, SceneRays* rays, Hits* hits, MASK waiting, REAL3* light) {
  const MASK hit = waiting & hit_anything(hits);
  const MASK here = current_media(scene->media, rays, waiting);
  Faces faces = hit_faces(scene, rays->d, hits, hit);
  const int kind = (int)(MATERIAL_TRANSMITS | MATERIAL_SHADOW_OPAQUE);
  MASK passing = hit & MASK_OF((faces.flags & kind) == (int)MATERIAL_TRANSMITS);
  HAVING(HAS_MEDIA, SceneRays behind = *rays;)
  HAVING(HAS_MEDIA, const MASK touching = may_touch(scene->instances, hits, passing);)
  HAVING(HAS_TOUCHING, pass_touching(scene, rays, hits, &faces, &behind, touching);)
  passing &= MASK_OF((faces.flags & kind) == (int)MATERIAL_TRANSMITS);
  *light = select3(*light, all3((float3)(0.0f)), hit & ~passing);
  MASK there = here;
  MASK through = passing;
  HAVING(HAS_MEDIA, through = change_media(scene, rays, hits, &faces, &behind, touching, waiting, passing,
                                           here, &there, light);)
  if (!any_lane(passing)) return NO_LANES;
  filter_light(scene, rays, hits, &faces, here, there, through, light);
  continue_behind(scene->info, rays, hits, faces.entering, passing);
  return passing & MASK_OF(greatest3(*light) > 0.0f);
}

// `light` after the media on the ways to the lights, for `arriving`, where nothing blocks it.
static inline REAL3 unblocked_light(const Scene* scene, const SceneRays* rays, REAL3 light, MASK arriving) {
  if (!HAS_MEDIA) return light;
  const MASK here = current_media(scene->media, rays, arriving);
  return multiply3(light, absorb(scene->media, here, rays->t_max, arriving));
}

// The rays that have passed as many filters as they may.
static inline MASK passed_most(const SceneRays* rays) {
  return EITHER(HAS_CROSSINGS, MASK_OF(rays->crossings >= MAX_FILTERS), NO_LANES);
}

// The shadow rays of `lanes` at what they met: what reaches the lights is added to the pixels. Returns those
// that continue.
static inline MASK reach_filters(const Scene* scene, SceneRays* rays, WaitingRays* paths, Hits* hits,
                                 MASK lanes, float4* radiance, u32* counts) {
  if (!HAS_SHADOW_FILTERS) {
    const MASK arriving = lanes & ~hit_anything(hits);
    add_to_pixels(unblocked_light(scene, rays, paths->throughput, arriving), paths->pixel, arriving,
                  radiance);
    return NO_LANES;
  }
  const MASK passing = pass_filters(scene, rays, hits, lanes, &paths->throughput);
  const MASK too_many = passing & passed_most(rays);
  counts[COUNT_SHADOW_LIMIT] += lane_count(too_many);
  add_to_pixels(paths->throughput, paths->pixel, lanes & ~passing, radiance);
  return passing & ~too_many;
}

// The hits of the shadow rays of `lanes`; in scenes where nothing lets light pass, any hit will do.
static inline Hits shadow_hits(const Scene* scene, SceneRays* rays, MASK lanes, bool coherent, u32* counts) {
  Hits hits;
  if (HAS_SHADOW_FILTERS) {
    nearest_to_light(scene, rays, lanes, coherent, &hits, counts);
  } else {
    hits = no_hits(rays->t_max);
    const MASK occluded = any_hits(scene, rays, lanes, coherent, counts);
    hits.instance = select(hits.instance, NO_LANES, occluded);
  }
  return hits;
}

// The part of `light` that arrives at the ends of the shadow rays of `lanes`, taken all the way there.
static inline REAL3 light_arriving(const Scene* scene, SceneRays* rays, REAL3 sent, MASK lanes, u32* counts) {
  if (!HAS_SHADOW_FILTERS) {
    const MASK arriving = lanes & ~any_hits(scene, rays, lanes, false, counts);
    return select3(all3((float3)(0.0f)), unblocked_light(scene, rays, sent, arriving), arriving);
  }
  REAL3 light = sent;
  while (any_lane(lanes)) {
    Hits hits = shadow_hits(scene, rays, lanes, false, counts);
    const MASK passing = pass_filters(scene, rays, &hits, lanes, &light);
    const MASK too_many = passing & passed_most(rays);
    counts[COUNT_SHADOW_LIMIT] += lane_count(too_many);
    light = select3(light, all3((float3)(0.0f)), too_many);
    lanes = passing & ~too_many;
  }
  return light;
}
