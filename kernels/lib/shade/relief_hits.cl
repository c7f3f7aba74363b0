// Objects in the relief of another surface: rays that have hit a surface with heights below it continue to
// these heights, and hits on the way come first. One ray per lane.
#pragma once
#include "lib/path/segment.cl"
#include "lib/shade/bsdf.cl"

#if HAS_PARALLAX
#define RELIEF_FACES 4  // of the surface's own object that a ray passes below it

// The depths of the reliefs of `lanes`, in the world; 0 without a relief.
static inline REAL relief_depths(const Scene* scene, const SurfaceInteractions* s, MASK lanes) {
  REAL depth = (REAL)(0.0f);
  u32 index;
  for (u32 left = lane_bits(lanes & has_parallax(scene, s->material, lanes)); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    depth = select(depth, (REAL)(scene->material_maps[scene->materials[index].maps].parallax), mine);
  }
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->instance, &left, &index);
    depth = select(depth, depth / scene->instances[index].pattern_scale.w, mine);
  }
  return depth;
}

// The nearest hits between `hits`, on surfaces with reliefs, and the distances `ends`, on other objects.
// Returns the lanes that have one.
static inline MASK meet_in_reliefs(const Scene* scene, const SceneRays* rays, const Hits* hits, MASK entering,
                                   REAL ends, MASK lanes, Hits* others, u32* counts) {
  SceneRays below = *rays;
  Hits next;
  MASK found = NO_LANES;
  continue_behind(scene->info, &below, hits, entering, lanes);
  below.t_max = select(below.t_max, ends, lanes);
  for (int k = 0; k < RELIEF_FACES && any_lane(lanes); ++k) {
    nearest_hits(scene, &below, lanes, false, &next, counts);
    lanes &= hit_anything(&next);
    const MASK same = MASK_OF(next.instance == hits->instance);
    join_hits(others, &next, lanes & ~same);
    found |= lanes & ~same;
    lanes &= same;
    below.t_min = select(below.t_min, next.t, lanes);
  }
  return found;
}

// The length of rays of the directions d through reliefs of the depth `depth`.
static inline REAL ways_through(const SurfaceInteractions* s, REAL3 d, REAL depth) {
  return depth / real_max(fabs(dot3(s->ng, d)), (REAL)(PARALLAX_SLANT));
}

// Moves the hits of `lanes` on surfaces with reliefs to hits before their heights. `met` receives the depth
// below those surfaces. In the relief of a transparent surface only opaque hits count: a ray would not know
// that it is outside the surface's solid in the relief and inside behind it.
NEVER_INLINE void enter_reliefs(const Scene* scene, const SceneRays* rays, MASK lanes, Encounters* met,
                                u32* counts) {
  met->below = (REAL)(0.0f);
  met->top = all3((float3)(0.0f));
  lanes &= hit_anything(&met->hit);
  const Faces faces = hit_faces(scene, rays->d, &met->hit, lanes);
  lanes &= faces.entering;
  if (!any_lane(lanes)) return;
  SurfaceInteractions s;
  s.material = faces.material;
  lanes &= has_parallax(scene, s.material, lanes);
  lanes &= sees_interface(scene, rays, &met->hit, &faces, lanes);
  if (!any_lane(lanes)) return;
  s.instance = met->hit.instance;
  s.ng = safe_unit3(faces.outward);
  const REAL rise = fabs(dot3(s.ng, rays->d));
  const REAL length = ways_through(&s, rays->d, relief_depths(scene, &s, lanes));
  Hits others = met->hit;
  MASK found =
      meet_in_reliefs(scene, rays, &met->hit, faces.entering, met->hit.t + length, lanes, &others, counts);
  if (!any_lane(found)) return;
  const Faces things = hit_faces(scene, rays->d, &others, found);
  found &= MASK_OF(((faces.flags & things.flags) & (int)MATERIAL_TRANSMITS) == 0);
  interact(scene, rays->o, rays->d, &met->hit, &faces, &s, found);
  set_footprints(scene, rays, met->hit.t, &s, found);
  add_parallax(scene, rays->d, &s, found);
  const REAL passed = others.t - met->hit.t;
  found &= MASK_OF(passed < s.sunk * length);
  met->below = select(met->below, passed * rise, found);
  met->top = select3(met->top, s.ng, found);
  join_hits(&met->hit, &others, found);
}
#endif

static inline void note_depth(const Encounters* met, SurfaceInteractions* s) {
  HAVING(HAS_PARALLAX, s->below = met->below; s->top = met->top;)
}

// Where a ray in direction wi leaves the relief that contains the surface, which has none: `way` receives the
// distance.
static inline REAL3 leave_relief(const SurfaceInteractions* s, REAL3 wi, REAL* way) {
  const REAL zero = (REAL)(0.0f);
  *way = zero;
  if (!HAS_PARALLAX) return s->p;
  const REAL below = EITHER(HAS_PARALLAX, s->below, zero);
  const REAL3 top = EITHER(HAS_PARALLAX, s->top, s->ng);
  const REAL rise = real_max(dot3(top, wi), zero);
  *way = select(zero, below / real_max(rise, (REAL)(PARALLAX_SLANT)), MASK_OF(rise > 0.0f));
  return along3(along3(s->p, *way, wi), real_max(below - *way * rise, zero), top);
}
// The normal of the surface through which it leaves.
static inline REAL3 leaving_normal(const SurfaceInteractions* s) {
  return EITHER(HAS_PARALLAX, select3(s->ng, s->top, MASK_OF(s->below > 0.0f)), s->ng);
}

// How far behind the surfaces of `lanes` rays of the directions d have hit their heights.
static inline REAL ways_to_heights(const Scene* scene, const SurfaceInteractions* s, REAL3 d, MASK lanes) {
  const REAL zero = (REAL)(0.0f), sunk = EITHER(HAS_PARALLAX, s->sunk, zero);
  const MASK deep = HAS_PARALLAX ? lanes & MASK_OF(sunk > 0.0f) : NO_LANES;
  if (!any_lane(deep)) return zero;
  return EITHER(HAS_PARALLAX, select(zero, sunk * ways_through(s, d, relief_depths(scene, s, deep)), deep),
                zero);
}

// Where rays of the directions d continue behind the surfaces of `lanes`.
static inline REAL3 points_behind(const Scene* scene, const SurfaceInteractions* s, REAL3 d, MASK lanes) {
  const REAL3 behind = along3(s->p, -s->offset, s->ng);
  return HAS_PARALLAX ? along3(behind, ways_to_heights(scene, s, d, lanes), d) : behind;
}

// Moves the lanes of `active` to what they hit next in (t_min, t_max]. `coherent`: the rays are coherent.
static inline MASK meet_interfaces(const Scene* scene, SceneRays* rays, MASK active, bool coherent,
                                   Encounters* met, u32* counts) {
  nearest_hits(scene, rays, active, coherent, &met->hit, counts);
  HAVING(HAS_PARALLAX, enter_reliefs(scene, rays, active, met, counts);)
  return active & reach_interfaces(scene, rays, met, counts, active);
}

// Moves rays that wait behind surfaces which they do not see to their next visible ones. Those of `camera`
// pass objects that are hidden from them.
static inline void see_behind(const Scene* scene, SceneRays* rays, MASK waiting, MASK camera, Encounters* met,
                              u32* counts) {
  while (any_lane(waiting)) {
    Encounters next;
    nearest_hits(scene, rays, waiting, false, &next.hit, counts);
    HAVING(HAS_PARALLAX, enter_reliefs(scene, rays, waiting, &next, counts);)
    HAVING(HAS_PARALLAX, met->below = select(met->below, next.below, waiting);)
    HAVING(HAS_PARALLAX, met->top = select3(met->top, next.top, waiting);)
    join_hits(&met->hit, &next.hit, waiting);
    const MASK unseen = waiting & cross_unseen(scene, rays, met, counts, waiting);
    const MASK straight = waiting & ~unseen & camera;
    waiting = unseen | (straight & pass_hidden(scene, rays, met, straight));
  }
}

// Moves the lanes of `active` to their next visible surfaces.
static inline void see_surfaces(const Scene* scene, SceneRays* rays, MASK active, MASK camera, bool coherent,
                                Encounters* met, u32* counts) {
  MASK waiting = meet_interfaces(scene, rays, active, coherent, met, counts);
  const MASK straight = active & ~waiting & camera;
  waiting |= straight & pass_hidden(scene, rays, met, straight);
  if (HAS_MEDIA || HAS_EMISSION) see_behind(scene, rays, waiting, camera, met, counts);
}
