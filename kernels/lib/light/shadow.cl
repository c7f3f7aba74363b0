// The hand-written parts of plain/light/shadow.cl.
#pragma once
#include "lib/path/ray_counts.cl"
#include "lib/path/segment.cl"
#include "lib/shade/bsdf.cl"
#include "lib/shade/relief_hits.cl"

#if HAS_MEDIA
static inline void pass_interface(const Scene* scene, SceneRays* rays, Hits* hits, Faces* faces, MASK lanes) {
  const u32 opaque = MATERIAL_TRANSMITS | MATERIAL_SHADOW_OPAQUE;
  const MASK passing = lanes & MASK_OF((faces->flags & (int)opaque) == (int)MATERIAL_TRANSMITS);
  const MASK touching = may_touch(scene->instances, hits, passing);
#if HAS_TOUCHING
  EACH_LANE(i, touching) {
    Seen seen = {0};
    float apart;
    REAL_LANE(hits->t, i) = meet_touching(scene, rays, i, opaque, hits, faces, &seen, &apart);
    set_media(rays, i, seen.behind);
  }
#endif
  const MASK crossing = passing & ~touching & MASK_OF((faces->flags & (int)MATERIAL_THIN) == 0);
  EACH_LANE(i, crossing) {
    MediaStack stack = get_media(rays, i);
    cross_boundary(&stack, (u32)MASK_LANE(faces->medium, i), MASK_LANE(faces->entering, i));
    set_media(rays, i, stack);
  }
}
#endif

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

#include "plain/light/shadow.cl"
