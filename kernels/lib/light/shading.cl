// Surfaces where rays meet them.
#pragma once
#include "lib/light/shadow.cl"
#include "lib/path/segment.cl"
#include "lib/shade/bsdf.cl"
#include "lib/shade/relief.cl"
#include "lib/shade/relief_hits.cl"

// Surfaces and the rays that hit them, for shading.
typedef struct Shading {
  SurfaceInteractions s;
  Bsdfs bsdf;
} Shading;

// A shading normal may mirror the viewer's direction below the surface, where lobes about that are lost and
// the surface is black. Then it is the one that mirrors it barely above. Perfect mirrors need none of it:
// reflected_direction().
#define GLOSSY (HAS_ROUGH ? MATERIAL_LAYERED | MATERIAL_REFLECTS : MATERIAL_LAYERED)
static inline void bend_normals(REAL3 d, MASK lanes, SurfaceInteractions* s) {
  const REAL3 mirrored = reflect_direction(d, s->ns);
  const REAL height = dot3(s->side, mirrored), least = real_min(-0.9f * dot3(s->side, d), (REAL)(0.01f));
  const MASK low = lanes & MASK_OF((s->flags & (int)GLOSSY) != 0) & MASK_OF(height < least);
  if (!any_lane(low)) return;
  const REAL3 flat = safe_unit3(along3(mirrored, -height, s->side));
  const REAL3 lifted = along3(scale3(flat, real_sqrt(1.0f - least * least)), least, s->side);
  s->ns = select3(s->ns, safe_unit3(subtract3(lifted, d)), low);
}

// The surfaces of `lanes` and what they do to light.
static inline void shade_hits(const Scene* scene, const SceneRays* rays, const Encounters* met, MASK lanes,
                              Shading* at) {
  interact(scene, rays->o, rays->d, &met->hit, &met->face, lanes, &at->s);
  at->s.offset = offset_beyond(met, at->s.offset);
  note_depth(met, &at->s);
  set_footprints(scene, rays, met->hit.t, &at->s);
  HAVING(HAS_PARALLAX, add_parallax(scene, rays->d, lanes, &at->s);)
  HAVING(HAS_RELIEF, add_relief(scene, rays->d, lanes, &at->s);)
#if SHADOWS_AS_PATHS && (HAS_LAYERS || HAS_ROUGH)
  bend_normals(rays->d, lanes, &at->s);
#endif
  at->bsdf = make_bsdfs(scene, &at->s, met->before, met->after, lanes);
}
