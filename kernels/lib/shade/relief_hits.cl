// What stands in the relief of another surface: rays that have met a surface with heights below it continue
// to these heights, and what they meet on the way comes first. A ray a lane.
#ifndef SUNDOG_LIB_RELIEF_HITS_CL
#define SUNDOG_LIB_RELIEF_HITS_CL
#include "lib/path/segment.cl"
#include "lib/shade/parallax.cl"

#if HAS_PARALLAX
#define RELIEF_FACES 4  // of the surface's own object that a ray passes below it

// The depths of the reliefs of `lanes`, in the world; 0 for surfaces without.
static inline REAL relief_depths(const Scene* scene, const SurfaceInteractions* s, MASK lanes) {
  REAL depth = (REAL)(0.0f);
  u32 index;
  for (MASK left = has_parallax(scene, s, lanes); any_lane(left);) {
    const MASK mine = take_alike(s->material, &left, &index);
    depth = select(depth, (REAL)(scene->material_maps[scene->materials[index].maps].parallax), mine);
  }
  for (MASK left = lanes; any_lane(left);) {
    const MASK mine = take_alike(s->instance, &left, &index);
    depth = select(depth, depth / scene->instances[index].pattern_scale.w, mine);
  }
  return depth;
}

// The nearest hits between `hits`, on surfaces with reliefs, and the distances `ends`, of other objects than
// those surfaces'. Returns the lanes that have one.
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
    *others = select_hits(others, &next, lanes & ~same);
    found |= lanes & ~same;
    lanes &= same;
    below.t_min = select(below.t_min, next.t, lanes);
  }
  return found;
}

// Takes the hits of `lanes` on opaque surfaces with reliefs to what rays meet before their heights. `met`
// receives how far below those surfaces that is.
NEVER_INLINE void enter_reliefs(const Scene* scene, const SceneRays* rays, MASK lanes, Encounters* met,
                                u32* counts) {
  met->below = (REAL)(0.0f);
  met->top = all3((float3)(0.0f));
  lanes &= hit_anything(&met->hit);
  const Faces faces = hit_faces(scene, rays->d, &met->hit, lanes);
  lanes &= faces.entering & MASK_OF((faces.flags & (int)MATERIAL_TRANSMITS) == 0);
  if (!any_lane(lanes)) return;
  SurfaceInteractions s;
  s.material = faces.material;
  lanes = has_parallax(scene, &s, lanes);
  if (!any_lane(lanes)) return;
  interact(scene, rays->o, rays->d, &met->hit, &faces, lanes, &s);
  set_footprints(rays, met->hit.t, &s);
  const REAL rise = fabs(dot3(s.ng, rays->d)), slant = real_max(rise, (REAL)(PARALLAX_SLANT));
  const REAL length = relief_depths(scene, &s, lanes) / slant;
  Hits others = met->hit;
  MASK found =
      meet_in_reliefs(scene, rays, &met->hit, faces.entering, met->hit.t + length, lanes, &others, counts);
  if (!any_lane(found)) return;
  add_parallax(scene, rays->d, found, &s);
  const REAL passed = others.t - met->hit.t;
  found &= MASK_OF(passed < s.sunk * length);
  met->below = select(met->below, passed * rise, found);
  met->top = select3(met->top, s.ng, found);
  met->hit = select_hits(&met->hit, &others, found);
}

static inline void note_depth(const Encounters* met, SurfaceInteractions* s) {
  s->below = met->below;
  s->top = met->top;
}

// Where a ray in direction wi leaves the relief in which the surface lies, which holds none: `way` receives
// how far that is.
static inline REAL3 leave_relief(const SurfaceInteractions* s, REAL3 wi, REAL* way) {
  const REAL zero = (REAL)(0.0f), rise = real_max(dot3(s->top, wi), zero);
  *way = select(zero, s->below / real_max(rise, (REAL)(PARALLAX_SLANT)), MASK_OF(rise > 0.0f));
  return along3(along3(s->p, *way, wi), real_max(s->below - *way * rise, zero), s->top);
}
// The side on which it leaves.
static inline REAL3 leaving_normal(const SurfaceInteractions* s) {
  return select3(s->ng, s->top, MASK_OF(s->below > 0.0f));
}
#else
static inline void enter_reliefs(const Scene* scene, const SceneRays* rays, MASK lanes, Encounters* met,
                                 u32* counts) {}
static inline void note_depth(const Encounters* met, SurfaceInteractions* s) {}
static inline REAL3 leave_relief(const SurfaceInteractions* s, REAL3 wi, REAL* way) {
  *way = (REAL)(0.0f);
  return s->p;
}
static inline REAL3 leaving_normal(const SurfaceInteractions* s) { return s->ng; }
#endif

// Takes the lanes of `active` to what they meet next, in reliefs too, as next_interfaces().
static inline MASK meet_interfaces(const Scene* scene, SceneRays* rays, MASK active, bool coherent,
                                   Encounters* met, u32* counts) {
  nearest_hits(scene, rays, active, coherent, &met->hit, counts);
  enter_reliefs(scene, rays, active, met, counts);
  return reach_interfaces(scene, rays, active, met, counts);
}

#endif
