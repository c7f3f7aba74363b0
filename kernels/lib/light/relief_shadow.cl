// Shadows of reliefs below surfaces: on themselves (Brawley and Tatarchuk 2004, as in shade/parallax.cl), and
// on what stands among them. A surface a lane.
#pragma once
#include "lib/shade/relief_hits.cl"

#if HAS_PARALLAX
#define PARALLAX_BIAS 0.01f  // of the depth: what heights must rise above a way to hold light off

// The part of light from wi that reaches the surfaces of `lanes` past their own heights: 1 or 0.
NEVER_INLINE REAL relief_visibility(const Scene* scene, const SurfaceInteractions* s, REAL3 wi, MASK lanes) {
  const REAL zero = (REAL)(0.0f);
  const MASK deep = lanes & MASK_OF(s->sunk > 0.0f) & MASK_OF(dot3(s->ng, wi) > 0.0f);
  MASK dark = NO_LANES;
  if (!any_lane(deep)) return (REAL)(1.0f);
  const TexturePoints at = texture_points(scene, s, deep);
  u32 index;
  for (u32 left = lane_bits(deep); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    __global const MaterialMaps* maps = scene->material_maps + scene->materials[index].maps;
    const ReliefWays ways = relief_ways(scene, maps, s, &at, wi, s->sunk, zero, mine);
    const REAL inverse = 1.0f / TO_REAL(ways.steps);
    MASK open = mine;
    for (int k = 1; k < PARALLAX_STEPS && any_lane(open); ++k) {
      open &= MASK_OF(ways.steps > k);
      const REAL above = height_above(scene, maps, &at, &ways, inverse * (float)k, open);
      const MASK held = open & MASK_OF(above > PARALLAX_BIAS);
      dark |= held;
      open &= ~held;
    }
  }
  return select((REAL)(1.0f), zero, dark);
}

#define RELIEF_START 8.0f  // offsets above a relief at which a way from the light begins

// The part of light from wi that reaches those surfaces of `lanes` that lie in the reliefs of others, past
// the heights there: 1 or 0. A ray from where the light enters the relief finds it and its heights. What lets
// light through throws no shadow on what stands in it.
NEVER_INLINE REAL walls_visibility(const Scene* scene, const SceneRays* rays, const SurfaceInteractions* s,
                                   REAL3 wi, MASK lanes, u32* counts) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f), rise = dot3(s->top, wi);
  lanes &= MASK_OF(s->below > 0.0f) & MASK_OF(rise > 0.0f);
  if (!any_lane(lanes)) return one;
  REAL way;
  const REAL3 leaves = leave_relief(s, wi, &way);
  const REAL before = RELIEF_START * s->offset / real_max(rise, (REAL)(PARALLAX_SLANT));
  SceneRays from_light = *rays;
  from_light.o = along3(leaves, before, wi);
  from_light.d = negate3(wi);
  from_light.t_min = zero;
  from_light.t_max = 2.0f * before;
  Hits hits;
  nearest_hits(scene, &from_light, lanes, false, &hits, counts);
  lanes &= hit_anything(&hits);
  if (!any_lane(lanes)) return one;
  const Faces faces = hit_faces(scene, from_light.d, &hits, lanes);
  lanes &= faces.entering & MASK_OF((faces.flags & (int)MATERIAL_TRANSMITS) == 0);
  SurfaceInteractions top;
  top.material = faces.material;
  lanes &= has_parallax(scene, top.material, lanes);
  if (!any_lane(lanes)) return one;
  interact(scene, from_light.o, from_light.d, &hits, &faces, &top, lanes);
  top.footprint = s->footprint;
  add_parallax(scene, from_light.d, &top, lanes);
  const REAL depth = relief_depths(scene, &top, lanes);
  const REAL reached = (top.sunk + PARALLAX_BIAS) * ways_through(&top, wi, depth);
  return select(one, zero, lanes & MASK_OF(reached < way));
}
#endif
