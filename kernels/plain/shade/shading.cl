// Surfaces where rays meet them.
#include "plain/shade/bsdf.cl"
#include "plain/shade/meet_interfaces.cl"
#include "plain/shade/relief.cl"

// A shading normal may mirror the viewer's direction below the surface, where lobes about that are lost and
// the surface is black. Then it is the one that mirrors it barely above. Perfect mirrors need none of it:
// reflected_direction().
static inline void bend_normal(float3 d, SurfaceInteraction* s) {
  const int mirrors = (int)(MATERIAL_ROUGH | MATERIAL_REFLECTS);
  const bool glossy = (s->flags & mirrors) == mirrors || (s->flags & (int)MATERIAL_LAYERED) != 0;
  const float3 mirrored = reflect_direction(d, s->ns);
  const float height = dot(s->side, mirrored), least = real_min(-0.9f * dot(s->side, d), 0.01f);
  if (!glossy || !(height < least)) return;
  const float3 flat = safe_unit3(along(mirrored, -height, s->side));
  const float3 lifted = along(flat * real_sqrt(1.0f - least * least), least, s->side);
  s->ns = safe_unit3(lifted - d);
}

// The surface that the ray has met, and what it does to light.
static inline void shade_hit(UNIFORM const Scene* scene, const SceneRay* ray, const Encounter* met,
                             OUT SurfaceShading* at) {
  interact(scene, ray->o, ray->d, &met->hit, &met->face, &at->s);
  at->s.offset = offset_beyond(met, at->s.offset);
  note_depth(met, &at->s);
  set_footprints(scene, ray, met->hit.t, &at->s);
  if (HAS_PARALLAX) add_parallax(scene, ray->d, &at->s);
  if (HAS_RELIEF) add_relief(scene, ray->d, &at->s);
  if (HAS_PATHS && (HAS_LAYERS || HAS_ROUGH)) bend_normal(ray->d, &at->s);
  at->bsdf = make_bsdfs(scene, &at->s, met->before, met->after);
}
