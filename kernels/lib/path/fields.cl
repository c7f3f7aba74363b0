// Distance fields among the scene's other objects: marches a batch of world-space rays through each field, up
// to the nearest known hit. Instances [instance_count, field_end) place the fields.
#pragma once
#include "lib/core/motion.cl"
#include "lib/core/tables.h"
#include "lib/core/transform.cl"
#include "lib/path/scene_ray.cl"

// Why a ray is marched. TO_SEE: full hit. TO_LIGHT: full hit of a shadow ray; fields with soft shadows are
// left to soft_shadows(). TO_BLOCK: likewise, but sets only the instance.
#define MARCH_TO_SEE 0u
#define MARCH_TO_LIGHT 1u
#define MARCH_TO_BLOCK 2u

#if HAS_SDF
#include "lib/sdf/surface.cl"

// A point for marching: in field space; in deep views relative to the world origin's place.
#ifdef SDF_DEEP
#define field_points object_vectors
#else
#define field_points object_points
#endif

// The search for the nearest hit among fields: the batch's rays, and the hit so far.
typedef struct FieldSearch {
  REAL3 o, d;  // world
  REAL t_min, t_best, footprint;
  MASK from;  // SceneRays.from
  HAVING(HAS_SIDES, MASK sides;)
  MASK active;
  // The nearest hit among the fields:
  MASK winner;       // its instance, or -1
  MASK inside, cut;  // MarchRays.inside, MarchHits.cut
  REAL threshold;
  REAL3 glow;
  REAL time;
} FieldSearch;

static inline REAL3 search_origins(const Scene* scene, u32 index, const FieldSearch* search) {
  return still_points(scene, index, search->o, search->time);
}
static inline REAL3 search_directions(const Scene* scene, u32 index, const FieldSearch* search) {
  return still_vectors(scene, index, search->d, search->time);
}

// Light of glowing fields, which rays gather as they pass.
static inline void gather_glow(__global const SdfField* restrict field, const MarchHits* hits,
                               FieldSearch* search) {
  if (!HAS_GLOW || field->glow.w <= 0.0f) return;
  const REAL passed = select(exp(hits->nearest * (-1.0f / field->glow.w)), (REAL)(0.0f), hits->hit);
  search->glow = along3(search->glow, passed, all3(field->glow.xyz));
}

static inline FieldSearch start_search(const SceneRays* rays, REAL t_best, MASK active) {
  FieldSearch search;
  search.o = rays->o;
  search.d = rays->d;
  search.t_min = rays->t_min;
  search.t_best = t_best;
  search.footprint = rays->footprint;
  search.from = rays->from;
  HAVING(HAS_SIDES, search.sides = rays->sides;)
  search.active = active;
  search.winner = ALL_LANES;
  search.inside = NO_LANES;
  search.cut = NO_LANES;
  search.threshold = (REAL)(0.0f);
  search.glow = all3((float3)(0.0f));
  search.time = time_of_rays(rays);
  return search;
}

// Lanes that start inside the interval.
static inline MASK starts_within(__global const SdfField* restrict field, const MarchRays* rays) {
  const REAL3 p = along3(rays->origin, rays->t_min, rays->direction);
  return MASK_OF(p.x >= field->lower.x) & MASK_OF(p.x <= field->upper.x) & MASK_OF(p.y >= field->lower.y) &
         MASK_OF(p.y <= field->upper.y) & MASK_OF(p.z >= field->lower.z) & MASK_OF(p.z <= field->upper.z);
}

// Sets the side of the field's surface on which rays start.
static inline void start_on_side(const Scene* scene, u32 index, const FieldSearch* search, MarchRays* rays) {
  const u32 place = scene->instances[index].root;
  __global const SdfField* restrict field = scene->sdf_fields + place;
  rays->inside = rays->leaving & MASK_OF((search->from & 1) != 0);
  // A ray that starts elsewhere evaluates the field.
  const MASK ask = rays->active & ~rays->leaving & starts_within(field, rays);
  if (!any_lane(ask)) return;
  const REAL3 start = along3(rays->origin, rays->t_min, rays->direction);
  const REAL d = sdf_signed(place, start, ask, scene->sdf_parameters);
  const REAL threshold = march_threshold(field, rays, rays->t_min, length3(rays->direction));
  const int bit =
      HAS_SIDES && scene->instances[index].touch > 0.0f ? side_of_one(scene->info, (int)index) : 0;
  if (bit != 0) {
    // Walls of an estimate are a threshold thick: there the ray remembers its side.
    HAVING(HAS_SIDES, rays->inside |= ask & MASK_OF((search->sides & bit) != 0);)
    rays->leaving |= ask & MASK_OF(fabs(d) < 2.0f * threshold);
    return;
  }
  rays->inside |= ask & MASK_OF(d < 0.0f);
  // A ray that starts on another surface within a threshold of a closed form has not arrived there yet.
  if (field->flags & SDF_FLAGS & SDF_SMOOTH) rays->leaving |= ask & MASK_OF(fabs(d) < threshold);
}

// The rays in field space, and the side of its surface on which they start.
static inline MarchRays march_from(const Scene* scene, u32 index, bool two_sided, const FieldSearch* search) {
  __global const Instance* instance = scene->instances + index;
  MarchRays rays;
  rays.origin = field_points(instance, search_origins(scene, index, search));
  rays.direction = object_vectors(instance, search_directions(scene, index, search));
  rays.t_min = search->t_min;
  rays.t_max = search->t_best;
  rays.footprint = search->footprint;
#if HAS_LANDINGS
  const REAL3 from_camera = along3(search->o, -1.0f, all3(scene->info->camera_position.xyz));
  rays.away2 = dot3(from_camera, from_camera);
  rays.slope = dot3(from_camera, search->d);
#endif
  rays.spread = (REAL)(pixel_spread(scene->info));
  rays.active = search->active;
  rays.leaving = MASK_OF((search->from | 1) == (int)(index * 2u + 1u));
  rays.inside = NO_LANES;
  // To where the exit of a wall at the nearest hit is clear (clear_exit).
  if (HAS_SIDES && instance->touch > 0.0f) {
    const REAL speed = length3(rays.direction), far = real_min(rays.t_max, (REAL)(1e30f));
    rays.t_max += 4.0f * march_threshold(scene->sdf_fields + instance->root, &rays, far, speed) / speed;
  }
  if (SDF_TWO_SIDED && two_sided) start_on_side(scene, index, search, &rays);
  return rays;
}

// Limit of a work-item's march cost per sample, in iterations of formulas: far above any practical picture,
// but low enough that no launch runs for long, however hard the fractal. Marches without budget are counted
// and reported.
#define MARCH_WORK 2000000u

// Steps through a field that the sample has left.
static inline u32 steps_left(__global const SdfField* restrict field, const u32* counts) {
  return counts[COUNT_MARCH_LEFT] / field->iterations;
}
static inline void pay_for_steps(__global const SdfField* restrict field, u32 steps, u32* counts) {
  counts[COUNT_MARCH_LEFT] -= min(steps * field->iterations, counts[COUNT_MARCH_LEFT]);
}

// Marches through one field and keeps a nearer hit.
static inline void march_field(const Scene* scene, u32 index, FieldSearch* search, u32* counts) {
  __global const SdfField* restrict field = scene->sdf_fields + scene->instances[index].root;
  const u32 flags = scene->materials[scene->instances[index].material].flags;
  const bool two_sided = flags & (MATERIAL_TRANSMITS | MATERIAL_CATCHER);
  MarchRays rays = march_from(scene, index, two_sided, search);
  rays.step_limit = min(field->step_limit, steps_left(field, counts));
  if (rays.step_limit == 0u) {
    counts[COUNT_MARCH_BUDGET] += 1u;
    return;
  }
  const MarchHits hits = march_rays(scene, scene->instances[index].root, &rays);
  const MASK nearer = hits.hit & MASK_OF(hits.t < search->t_best);
  search->t_best = select(search->t_best, hits.t, nearer);
  search->threshold = select(search->threshold, hits.threshold, nearer);
  search->winner = select(search->winner, (MASK)((int)index), nearer);
  search->inside = select(search->inside, rays.inside, nearer);
  search->cut = select(search->cut, hits.cut, nearer);
  gather_glow(field, &hits, search);
  u32 most = 0;
  for (u32 i = 0; i < LANES; ++i) {
    most = max(most, (u32)MASK_LANE(hits.steps, i));
    counts[COUNT_MARCH_STEPS] += (u32)MASK_LANE(hits.steps, i);
    counts[COUNT_MARCH_BACK] += (u32)MASK_LANE(hits.taken_back, i);
    counts[COUNT_MARCH_LIMIT] += MASK_LANE(hits.limited, i) ? 1u : 0u;
  }
  pay_for_steps(field, most, counts);
}

// Sets normals of the lanes that hit instance `index`.
static inline void shade_lanes(const Scene* scene, u32 index, const FieldSearch* search, Hits* hits) {
  const MASK mine = MASK_OF(search->winner == (int)index);
  if (!any_lane(mine)) return;
  const REAL3 o = field_points(scene->instances + index, search_origins(scene, index, search)),
              d = object_vectors(scene->instances + index, search_directions(scene, index, search));
  REAL3 normal = sdf_normal(scene, scene->instances[index].root, along3(o, search->t_best, d),
                            search->threshold, mine, search->cut);
  // A normal must not contradict the ray's side: it is bent to the silhouette. For a closed form it belongs
  // to the other side of a wall without thickness.
  const REAL speed = length3(d), towards = dot3(normal, d) / speed;
  const MASK inside = search->inside;
  const REAL limit = select((REAL)(-1e-3f), (REAL)(1e-3f), inside);
  const MASK wrong = select(MASK_OF(towards > limit), MASK_OF(towards < limit), inside);
  const bool smooth = scene->sdf_fields[scene->instances[index].root].flags & SDF_FLAGS & SDF_SMOOTH;
  const MASK other = smooth ? wrong & MASK_OF(fabs(towards) > 0.1f) : NO_LANES;
  const REAL3 bent = along3(normal, select((REAL)(0.0f), (limit - towards) / speed, wrong), d);
  normal = select3(bent, negate3(normal), other);
  hits->t = select(hits->t, search->t_best, mine);
  hits->instance = select(hits->instance, (MASK)((int)index), mine);
  hits->ng = select3(hits->ng, normal, mine);
  hits->u = select(hits->u, (REAL)(0.0f), mine);
  hits->v = select(hits->v, (REAL)(0.0f), mine);
  hits->prim = select(hits->prim, NO_LANES, mine);
}

#if HAS_SIDES
// Sets the sides of new rays: they start inside fields that are negative there.
static inline void find_sides(const Scene* scene, SceneRays* rays, MASK active) {
  const MASK unknown = active & MASK_OF(rays->sides < 0);
  if (!any_lane(unknown)) return;
  FieldSearch search = start_search(rays, rays->t_max, unknown);
  rays->sides = select(rays->sides, NO_LANES, unknown);
  for (u32 index = scene->info->instance_count; index < scene->info->field_end; ++index) {
    if (scene->instances[index].touch <= 0.0f) continue;
    const u32 place = scene->instances[index].root;
    const MarchRays start = march_from(scene, index, false, &search);
    const MASK within = unknown & starts_within(scene->sdf_fields + place, &start);
    if (!any_lane(within)) continue;
    const REAL d =
        sdf_signed(place, along3(start.origin, start.t_min, start.direction), within, scene->sdf_parameters);
    rays->sides |= within & MASK_OF(d < 0.0f) & side_of_one(scene->info, (int)index);
  }
}

// How far from the surface of field `index` a ray at t has arrived, in the world.
static inline float arrival_distance(const Scene* scene, u32 index, const SceneRays* rays, float t,
                                     u32 lane) {
  const FieldSearch search = start_search(rays, (REAL)(t), ALL_LANES);
  const MarchRays start = march_from(scene, index, false, &search);
  const REAL speed = length3(start.direction);
  const REAL threshold =
      march_threshold(scene->sdf_fields + scene->instances[index].root, &start, (REAL)(t), speed);
  return REAL_LANE(threshold, lane) / REAL_LANE(speed, lane);
}
#endif

// Replaces `hits`, the nearest so far, by nearer hits on the fields of [first, end), for the lanes of
// `active`. Adds to the rays' glow.
NEVER_INLINE void march_range(const Scene* scene, SceneRays* rays, u32 first, u32 end, MASK active,
                              u32 purpose, Hits* hits, u32* counts) {
  HAVING(HAS_SIDES, find_sides(scene, rays, active);)
  const bool to_light = purpose != MARCH_TO_SEE;
  FieldSearch search = start_search(rays, hits->t, active);
  for (u32 index = first; index < end; ++index)
    if (!(to_light && scene->sdf_fields[scene->instances[index].root].shadow_hardness > 0.0f))
      march_field(scene, index, &search, counts);
  if (purpose == MARCH_TO_BLOCK) {
    hits->instance = select(hits->instance, search.winner, MASK_OF(search.winner >= 0));
    return;
  }
  for (u32 index = first; index < end; ++index) shade_lanes(scene, index, &search, hits);
  HAVING(HAS_GLOW, if (!to_light) rays->glow = select3(rays->glow, add3(rays->glow, search.glow), active);)
}

static inline void march_fields(const Scene* scene, SceneRays* rays, MASK active, u32 purpose, Hits* hits,
                                u32* counts) {
  march_range(scene, rays, scene->info->instance_count, scene->info->field_end, active, purpose, hits,
              counts);
}
#endif

// Sets the march budget of a sample.
static inline void start_marching(u32* counts) { HAVING(HAS_SDF, counts[COUNT_MARCH_LEFT] = MARCH_WORK;) }
