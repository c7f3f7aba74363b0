// The hand-written parts of plain/light/shadow.cl.
#pragma once
#include "lib/path/ray_counts.cl"
#include "lib/path/segment.cl"
#include "lib/shade/bsdf.cl"

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
