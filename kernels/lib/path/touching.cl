// Touching surfaces: a ray crosses coincident faces of several solids (exactly or up to rounding) together,
// from the media before to the media behind, with a single reflection and refraction. Crossed one by one, the
// next ray would start beyond faces that it has not hit yet, or be reflected by a nonexistent gap. The host
// marks the instances that may touch others.
#pragma once
#include "lib/core/motion.cl"
#include "lib/core/transform.cl"
#include "lib/path/fields.cl"
#include "lib/path/scene_ray.cl"
#include "plain/path/face.cl"
#if HAS_TOUCHING
#include "lib/trace/stretch.cl"

static inline float greatest_component(float3 a) { return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z))); }

static inline float3 unit_normal(float3 n) {
  const float size = greatest_component(n);
  return size > 0.0f ? normalize(n / size) : n;
}

static inline float3 normal_of(const Hit* hit) { return (float3)(hit->ng_x, hit->ng_y, hit->ng_z); }

// In world space, not normalised.
static inline float3 outward_of(const Scene* scene, const Hit* hit, float time) {
  const float3 outward = world_normal(scene->instances + hit->instance, normal_of(hit));
  return moved_normal(scene, hit->instance, outward, time);
}

// Bound of a hit's distance from its surface by rounding: at least `least`, or by the size of the surface.
// Twice this separates distinct surfaces.
static inline float rounding_of(const Scene* scene, const Hit* hit, float3 outward, float least) {
  __global const Instance* instance = scene->instances + hit->instance;
  float size = greatest_component(instance->world_center.xyz) + instance->world_center.w;
  if (HAS_MESH && instance->shape == SHAPE_MESH)
    size = scene->triangles[hit->prim].extent * greatest_component(normal_of(hit)) /
           fmax(greatest_component(outward), FLT_MIN);
  return fmax(least, size * 0x1p-21f);
}

// The faces that a ray crosses together.
typedef struct Touching {
  Stretch met;
  float end;    // t of the last one
  float apart;  // how far the faces may be apart
} Touching;

// The faces beyond `t_min` that touch the one at `first`, itself included. Some may be before it by rounding,
// since the tracer skips boxes that begin behind a hit.
static inline void find_touching(const Scene* scene, float3 o, float3 d, float t_min, const Hit* first,
                                 Touching* touching) {
  Stretch* met = &touching->met;
  const float3 outward = outward_of(scene, first, time_of_stretch(met)), p = o + first->t * d;
  const float least = fmax(greatest_component(o), greatest_component(p)) * 0x1p-19f;
  const float own = rounding_of(scene, first, outward, least);
  const float slope = fabs(dot(unit_normal(outward), d));
  met->o = o;
  met->d = d;
  met->first = *first;
  const float reach = fmax(2.0f * own, scene->instances[first->instance].touch) / fmax(slope, 1e-3f);
  met->from = fmax(t_min, first->t - reach);
  met->to = first->t + reach;
  met->box_from = fmax(met->from - reach, 0.0f);
  met->box_to = met->to + reach;
  note_all(scene, met);
  bool found = false;
  for (u32 i = 0; i < met->count; ++i) {
    const Hit hit = listed_hit(scene, met, i);
    if (!same_face(&hit, first)) continue;
    found = true;
    if (HAS_MESH && hit.t == first->t && dot(normal_of(&hit), normal_of(first)) > 0.0f)
      met->faces[i].instance = NO_INSTANCE;  // read at once
  }
  if (!found || met->count == 1u) {  // alone, it is as the ray met it
    met->count = found ? 0u : min(met->count, MOST_TOUCHING - 1u);
    list_face(met, first->t, NO_INSTANCE, 0.0f, 0.0f, 0.0f);
  }
  touching->end = first->t;
  touching->apart = own;
  // First within rounding plus a quarter, then closely behind the last of those, so that the next ray's
  // start, `apart` behind, has a quarter to the faces on either side.
  for (u32 pass = 0; pass < 2u && met->count > 1u; ++pass) {
    const float from = touching->end;
    for (u32 i = 0; i < met->count; ++i) {
      const Hit hit = listed_hit(scene, met, i);
      const float3 other = outward_of(scene, &hit, time_of_stretch(met));
      const float limit = fmax(own, rounding_of(scene, &hit, other, least));
      const float steep = fmax(slope, fabs(dot(unit_normal(other), d)));
      if ((hit.t - from) * steep > (pass ? 0.5f : 1.25f) * limit) continue;
      touching->end = fmax(touching->end, hit.t);
      touching->apart = fmax(touching->apart, fmax(limit, (hit.t - first->t) * steep + 0.25f * limit));
    }
  }
  u32 kept = 0;
  for (u32 i = 0; i < met->count; ++i)
    if (met->faces[i].t <= touching->end) met->faces[kept++] = met->faces[i];
  met->count = kept;
}

#if HAS_SIDES
// Likewise if `first` is on a field: it touches others that the ray, marched for `purpose`, meets up to a
// threshold behind. Returns the bits of those in SceneRays.sides; others are not looked at.
static inline int find_touching_fields(const Scene* scene, const SceneRays* rays, u32 lane, u32 purpose,
                                       const Hit* first, Touching* touching, u32* counts) {
  Stretch* met = &touching->met;
  const MASK only = lanes_of(1u << lane);
  SceneRays again = *rays;
  int crossed = 0;
  met->d = get3(&rays->d, lane);
  met->first = *first;
  met->count = 0;
  list_hit(met, first);
  touching->end = first->t;
  touching->apart = 0.0f;
  const float slope = fabs(dot(unit_normal(outward_of(scene, first, time_of_stretch(met))), met->d));
  const float reach = arrival_distance(scene, first->instance, rays, first->t, lane) / fmax(slope, 0.05f);
  for (u32 index = scene->info->instance_count; index < scene->info->field_end; ++index) {
    const int side = side_of_one(scene->info, (int)index);
    if (index == first->instance || scene->instances[index].touch <= 0.0f || side == 0) continue;
    Hits hits = no_hits((REAL)(first->t + reach));
    march_range(scene, &again, index, index + 1u, only, purpose, &hits, counts);
    if (MASK_LANE(hits.instance, lane) != (int)index || met->count >= MOST_TOUCHING) continue;
    const Hit hit = get_hit(&hits, lane);
    list_hit(met, &hit);
    touching->end = fmax(touching->end, REAL_LANE(hits.t, lane));
    crossed |= side;
  }
  return crossed;
}
#endif

static inline u32 material_of(const Scene* scene, const Hit* hit) {
  const u32 material = scene->instances[hit->instance].material;
  return material != NO_MATERIAL ? material : scene->triangles[hit->prim].material;
}

static inline u32 medium_inside(const Scene* scene, const Hit* hit) {
  return scene->materials[material_of(scene, hit)].medium;
}

// Whether two hits are the same, on an edge shared by two triangles of a mesh.
static inline bool on_shared_edge(__global const Instance* restrict instances, const Hit* a, const Hit* b) {
  if (a->instance != b->instance || instances[a->instance].shape != SHAPE_MESH) return false;
  const float near_a = fmin(fmin(a->u, a->v), 1.0f - a->u - a->v),
              near_b = fmin(fmin(b->u, b->v), 1.0f - b->u - b->v);
  return fmax(near_a, near_b) < 1e-5f && dot(normal_of(a), normal_of(b)) > 0.0f;
}

// Changes of media by the faces of a crossing: bits of `met` whose media are entered and left. A medium left
// and entered again is unchanged, and neither face is seen.
typedef struct Changes {
  u32 entered, left, thin;
} Changes;

static inline Changes faces_of(const Scene* scene, const Stretch* met) {
  Changes changes = {0, 0, 0};
  for (u32 i = 0; i < met->count; ++i) {
    const Hit hit = listed_hit(scene, met, i);
    bool again = false;
    for (u32 k = 0; HAS_MESH && k < i; ++k) {
      const Hit before = listed_hit(scene, met, k);
      again |= on_shared_edge(scene->instances, &before, &hit);
    }
    const u32 flags = scene->materials[material_of(scene, &hit)].flags;
    if (again || !(flags & MATERIAL_TRANSMITS)) continue;
    if (flags & MATERIAL_THIN)
      changes.thin |= 1u << i;
    else if (dot(outward_of(scene, &hit, time_of_stretch(met)), met->d) < 0.0f)
      changes.entered |= 1u << i;
    else
      changes.left |= 1u << i;
  }
  return changes;
}

// Cancels pairs of faces that leave and enter the same medium; first those that face each other, so that the
// right face of a corner remains.
static inline void take_out_pairs(const Scene* scene, const Stretch* met, Changes* changes) {
  for (u32 facing = 2; facing-- > 0;)
    for (u32 entered = changes->entered; entered; entered &= entered - 1u) {
      const u32 i = lowest_bit(entered);
      const Hit hit = listed_hit(scene, met, i);
      const float3 normal = unit_normal(outward_of(scene, &hit, time_of_stretch(met)));
      for (u32 left = changes->left; left; left &= left - 1u) {
        const u32 k = lowest_bit(left);
        const Hit other = listed_hit(scene, met, k);
        if (medium_inside(scene, &other) != medium_inside(scene, &hit)) continue;
        if (facing && dot(normal, unit_normal(outward_of(scene, &other, time_of_stretch(met)))) > -0.9f)
          continue;
        changes->entered &= ~(1u << i);
        changes->left &= ~(1u << k);
        break;
      }
    }
}

// Whether the first of two solids entered at one place is the outer one: the larger. Ties are broken by
// medium, so that the order in the file does not matter.
static inline bool is_outer(const Scene* scene, const Hit* a, const Hit* b) {
  const u32 medium_a = medium_inside(scene, a), medium_b = medium_inside(scene, b);
  const float size_a = scene->instances[a->instance].world_center.w,
              size_b = scene->instances[b->instance].world_center.w;
  if (size_a != size_b) return size_a == 0.0f || (size_b != 0.0f && size_a > size_b);
  const float index_a = scene->media[medium_a].absorption.w, index_b = scene->media[medium_b].absorption.w;
  return index_a != index_b ? index_a < index_b : medium_a < medium_b;
}

// Takes the face of *bits, which is not 0, whose solid is outermost or, if not `outermost`, innermost.
// Returns its medium.
static inline u32 take_face(const Scene* scene, const Stretch* met, u32* bits, bool outermost) {
  u32 best = lowest_bit(*bits);
  Hit hit = listed_hit(scene, met, best);
  for (u32 left = *bits & (*bits - 1u); left; left &= left - 1u) {
    const Hit other = listed_hit(scene, met, lowest_bit(left));
    if (is_outer(scene, &other, &hit) != outermost) continue;
    best = lowest_bit(left);
    hit = other;
  }
  *bits &= ~(1u << best);
  return medium_inside(scene, &hit);
}

// Enters the media of the faces `entered`, outer ones first. Returns how many did not fit.
static inline u32 enter_all(const Scene* scene, const Stretch* met, u32 entered, MediaStack* stack) {
  u32 lost = 0;
  while (entered)
    if (!cross_one(stack, (int)take_face(scene, met, &entered, true), true)) ++lost;
  return lost;
}

// The face seen among touching ones.
typedef struct Seen {
  Hit hit;
  u32 material;
  MediaStack behind;  // the media behind all of them
  u32 after;          // the effective one
  u32 overflows, strays;
} Seen;

static inline bool comes_first(const Hit* a, const Hit* b) {
  if (a->t != b->t) return a->t < b->t;
  return a->instance != b->instance ? a->instance < b->instance : a->prim < b->prim;
}

// The priority of a face between two media: the greatest is seen. 0 if it separates neither of them.
static inline u32 say_of(__global const Material* restrict material, u32 before, u32 after) {
  if (material->flags & MATERIAL_THIN) return 3u;
  if (material->medium != before && material->medium != after) return 0u;
  return material->flags & MATERIAL_CLEAR ? 1u : 2u;
}

// Whether face a is seen instead of b. With equal materials, the outer one: the first entered, the last left.
static inline bool is_seen_before(const Scene* scene, const Hit* a, const Hit* b, u32 before, u32 after,
                                  bool left) {
  const u32 material_a = material_of(scene, a), material_b = material_of(scene, b);
  __global const Material *ma = scene->materials + material_a, *mb = scene->materials + material_b;
  const u32 say_a = say_of(ma, before, after), say_b = say_of(mb, before, after);
  if (say_a != say_b) return say_a > say_b;
  __global const Medium *inside_a = scene->media + ma->medium, *inside_b = scene->media + mb->medium;
  if (inside_a->priority != inside_b->priority) return inside_a->priority > inside_b->priority;
  if (inside_a->absorption.w != inside_b->absorption.w)
    return inside_a->absorption.w > inside_b->absorption.w;
  if (material_a != material_b) return material_a < material_b;
  return left ? comes_first(b, a) : comes_first(a, b);
}

// The result of touching faces for a ray in the media `before`. An opaque face among them, whose flags are
// not `passable` under `mask`, is seen from the media before, because light does not enter it.
static inline void join_faces(const Scene* scene, const Touching* touching, u32 mask, MediaStack before,
                              Seen* seen) {
  const Stretch* met = &touching->met;
  const u32 current = (u32)current_of_one(scene->media, &before);
  seen->behind = before;
  seen->after = current;
  seen->overflows = 0;
  seen->strays = 0;
  bool opaque = false;
  for (u32 i = 0; i < met->count; ++i) {
    const Hit hit = listed_hit(scene, met, i);
    const u32 material = material_of(scene, &hit);
    if ((scene->materials[material].flags & mask) == MATERIAL_TRANSMITS) continue;
    if (opaque && comes_first(&seen->hit, &hit)) continue;
    opaque = true;
    seen->hit = hit;
    seen->material = material;
  }
  if (opaque) return;
  Changes changes = faces_of(scene, met);
  take_out_pairs(scene, met, &changes);
  for (u32 left = changes.left; left; left &= left - 1u) {
    const Hit hit = listed_hit(scene, met, lowest_bit(left));
    if (!cross_one(&seen->behind, (int)medium_inside(scene, &hit), false)) ++seen->strays;
  }
  seen->overflows = enter_all(scene, met, changes.entered, &seen->behind);
  seen->after = (u32)current_of_one(scene->media, &seen->behind);
  const u32 some = changes.thin | changes.entered | changes.left;
  seen->hit = listed_hit(scene, met, some ? lowest_bit(some) : 0u);
  for (u32 bits = some; bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    const Hit hit = listed_hit(scene, met, i);
    if (is_seen_before(scene, &hit, &seen->hit, current, seen->after, changes.left >> i & 1u))
      seen->hit = hit;
  }
  seen->material = material_of(scene, &seen->hit);
}

// The passages of a ray that has hit faces which touch each other: the media behind them all, the distance of
// the last, how far apart they may be; media for which the stack has no room, and exits from media not
// entered.
typedef struct Passages {
  MediaStacks behind;
  REAL end, apart;
  MASK overflows, strays, crossed;
} Passages;

// Resolves the lanes of `lanes`, which have hit instances that may touch others: hit and face become those of
// the face seen, but the hit's distance remains that of the first. `mask`: as above.
static inline void meet_touching_lane(const Scene* scene, const SceneRays* rays, u32 i, u32 mask, Hits* hits,
                                      Faces* faces, Passages* passages, u32* counts) {
  ListedFace listed[MOST_TOUCHING];
  Touching touching;
  touching.met.faces = listed;
  Seen seen CLEARED_ON_GPUS;
  const Hit first = get_hit(hits, i);
  const REAL time = time_of_rays(rays);
  const MediaStack before = {MASK_LANE(rays->media.low, i), MASK_LANE(rays->media.high, i)};
  HAVING(HAS_OBJECT_MOTION, touching.met.time = REAL_LANE(time, i);)
  HAVING(HAS_SIDES, int crossed = 0;)
  if (HAS_SIDES && first.instance >= scene->info->instance_count) {
    HAVING(HAS_SIDES, const u32 purpose = mask & MATERIAL_SHADOW_OPAQUE ? MARCH_TO_LIGHT : MARCH_TO_SEE;
           crossed = find_touching_fields(scene, rays, i, purpose, &first, &touching, counts);)
  } else
    find_touching(scene, get3(&rays->o, i), get3(&rays->d, i), REAL_LANE(rays->t_min, i), &first, &touching);
  join_faces(scene, &touching, mask, before, &seen);
  seen.hit.prim = listed_part(scene, &touching.met, &seen.hit);
  seen.hit.t = first.t;
  set_hit(hits, i, &seen.hit);
  const float3 outward = outward_of(scene, &seen.hit, REAL_LANE(time, i));
  set3(&faces->outward, i, outward);
  MASK_LANE(faces->entering, i) = dot(outward, get3(&rays->d, i)) < 0.0f ? -1 : 0;
  MASK_LANE(faces->material, i) = (int)seen.material;
  u32 flags = scene->materials[seen.material].flags;
  // A thin surface on an interface refracts like it.
  if (seen.after != (u32)current_of_one(scene->media, &before)) flags &= ~MATERIAL_THIN;
  MASK_LANE(faces->flags, i) = (int)flags;
  MASK_LANE(faces->medium, i) = (int)scene->materials[seen.material].medium;
  MASK_LANE(passages->behind.low, i) = seen.behind.low;
  MASK_LANE(passages->behind.high, i) = seen.behind.high;
  REAL_LANE(passages->end, i) = touching.end;
  REAL_LANE(passages->apart, i) = touching.apart;
  MASK_LANE(passages->overflows, i) = (int)seen.overflows;
  MASK_LANE(passages->strays, i) = (int)seen.strays;
  HAVING(HAS_SIDES, crossed |= side_of_one(scene->info, (int)first.instance);)
  HAVING(HAS_SIDES,
         MASK_LANE(passages->crossed, i) = crossed & ~side_of_one(scene->info, (int)seen.hit.instance);)
}
NEVER_INLINE Passages meet_touching(const Scene* scene, const SceneRays* rays, u32 mask, Hits* hits,
                                    Faces* faces, MASK lanes, u32* counts) {
  Passages passages = {0};
  EACH_LANE(i, lanes) meet_touching_lane(scene, rays, i, mask, hits, faces, &passages, counts);
  return passages;
}
#endif
