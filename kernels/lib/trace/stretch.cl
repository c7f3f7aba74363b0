// All hits of a ray in a short interval.
#pragma once
#include "lib/core/config.h"
#if HAS_TOUCHING
#include "lib/core/motion.cl"
#include "lib/core/tables.h"
#include "lib/trace/nodes.cl"
#include "lib/trace/traverse.cl"

// A hit as a GPU's small stack keeps it: of a triangle its place (finish_triangle()), u and v; else the
// normal.
typedef struct ListedFace {
  float t;
  u32 instance;  // NO_INSTANCE: the ray's first hit
  float x, y, z;
} ListedFace;

// A short interval of a ray, and all its hits in (from, to] on what may touch others, unordered. Boxes are
// tested in a longer one, because rounding may place a hit outside its box by more than boxes are widened.
// The faces are not in it, so that it can stay in registers.
typedef struct Stretch {
  float3 o, d;
  float from, to, box_from, box_to;
  u32 count;
  ListedFace* faces;  // MOST_TOUCHING
  Hit first;
  HAVING(HAS_OBJECT_MOTION, float time;)
} Stretch;

static inline float time_of_stretch(const Stretch* stretch) {
  return EITHER(HAS_OBJECT_MOTION, stretch->time, 0.0f);
}

static inline bool same_face(const Hit* a, const Hit* b) {
  return a->instance == b->instance && a->prim == b->prim;
}

static inline void list_face(Stretch* stretch, float t, u32 instance, float x, float y, float z) {
  const ListedFace face = {t, instance, x, y, z};
  if (stretch->count < MOST_TOUCHING) stretch->faces[stretch->count++] = face;
}

static inline void list_hit(Stretch* stretch, const Hit* hit) {
  list_face(stretch, hit->t, hit->instance, hit->ng_x, hit->ng_y, hit->ng_z);
}

// The face `i`; all solids are on the part of the first hit (listed_part()).
static inline Hit listed_hit(const Scene* scene, const Stretch* stretch, u32 i) {
  const ListedFace face = stretch->faces[i];
  Hit hit = {face.t, 0.0f, 0.0f, stretch->first.prim, face.instance, face.x, face.y, face.z};
  if (face.instance == NO_INSTANCE) return stretch->first;
  if (HAS_MESH && scene->instances[face.instance].shape == SHAPE_MESH) {
    hit.prim = as_uint(face.x);
    hit.u = face.y;
    hit.v = face.z;
    finish_triangle(scene->instances, scene->blocks, &hit);
  }
  return hit;
}

// Whether the instance may touch others, and the interval its bounding ball, if it has one.
static inline bool comes_near(__global const Instance* restrict instance, const Stretch* stretch) {
  const float4 ball = instance->world_center;
  const float3 p = stretch->o + stretch->from * stretch->d;
  const float reach = ball.w + (stretch->box_to - stretch->from);
  return instance->touch > 0.0f &&
         (ball.w == 0.0f || !(distance(p, ball.xyz) > reach + 1e-5f * (reach + length(p))));
}

// The first hit of the solid in (from, to]; NO_INSTANCE without one.
static inline Hit next_hit(const Scene* scene, u32 index, const Stretch* stretch, float from, float to) {
  const REAL3 o = all3(stretch->o), d = all3(stretch->d);
  const REAL t_min = (REAL)(from);
  Hits hits = no_hits((REAL)(to));
  prepare_hits(scene, (REAL)(time_of_stretch(stretch)), &hits);
  hit_solids(scene->instances, (uint2)(index, index + 1u), &o, &d, &t_min, lanes_of(1u), TRACE_NEAREST,
             &hits);
  return get_hit(&hits, 0);
}

// A solid that is entered and has no further hit ends where it begins: it is grazed, or thinner there than
// rounding. Its exit is the same hit, seen from behind. Planes are unbounded.
static inline void note_exit(const Scene* scene, u32 index, Stretch* stretch, Hit hit) {
  if (scene->instances[index].shape == SHAPE_PLANE || stretch->count >= MOST_TOUCHING) return;
  const float3 normal = world_normal(scene->instances + index, (float3)(hit.ng_x, hit.ng_y, hit.ng_z));
  const float3 outward = moved_normal(scene, index, normal, time_of_stretch(stretch));
  if (dot(outward, stretch->d) >= 0.0f) return;
  if (next_hit(scene, index, stretch, hit.t, INFINITY).instance != NO_INSTANCE) return;
  Hit behind = hit;
  behind.ng_x = -hit.ng_x;
  behind.ng_y = -hit.ng_y;
  behind.ng_z = -hit.ng_z;
  list_hit(stretch, &behind);
}

static inline void note_solid(const Scene* scene, u32 index, Stretch* stretch) {
  // A thin one may be in several leaves of the tree.
  for (u32 i = 0; i < stretch->count; ++i)
    if (stretch->faces[i].instance == index) return;
  Hit last, hit = next_hit(scene, index, stretch, stretch->from, stretch->to);
  if (hit.instance == NO_INSTANCE) return;
  for (u32 i = 0; i < 4u && hit.instance != NO_INSTANCE; ++i) {
    list_hit(stretch, &hit);
    last = hit;
    hit = next_hit(scene, index, stretch, last.t, stretch->to);
  }
  note_exit(scene, index, stretch, last);
}

// The part of a solid that a listed hit is on; of others their prim.
static inline u32 listed_part(const Scene* scene, const Stretch* stretch, const Hit* hit) {
  const bool solid = HAS_SOLID && hit->instance < scene->info->instance_count &&
                     scene->instances[hit->instance].shape != SHAPE_MESH;
  if (!solid || (hit->instance == stretch->first.instance && hit->t == stretch->first.t)) return hit->prim;
  Hit again = {.t = stretch->from, .instance = hit->instance};
  while (again.t < hit->t && again.instance != NO_INSTANCE)
    again = next_hit(scene, hit->instance, stretch, again.t, stretch->to);
  return again.prim;
}

// A node and the slots of its waiting children, of which the last is the next.
#define WALK_LEVELS (WIDE_VECTORS ? BVH_STACK : BVH_LEVELS)

// Pushes a node if the interval crosses children of it. Returns the new top.
static inline u32 push_node(__global const u32* nodes, u32 word, const SlabRay* slabs, const Stretch* stretch,
                            uint2* stack, u32 top) {
  const u32 bits = cross_children(node_at(nodes, word), slabs, stretch->box_from, stretch->box_to);
  stack[top] = (uint2)(word, bits);
  return bits ? top + 1u : top;
}

// Takes the next child.
static inline u32 pop_child(__global const u32* nodes, uint2* stack, u32* top) {
  const uint2 next = stack[*top - 1u];
  const u32 slot = 31u - clz(next.y), rest = next.y & ~(1u << slot);
  if (rest)
    stack[*top - 1u].y = rest;
  else
    --*top;
  return child_word(node_at(nodes, next.x), slot);
}

// A triangle may be in several leaves of its tree.
static inline void note_triangle(__global const TriangleBlock* restrict blocks, Stretch* stretch, u32 place,
                                 u32 instance, float t, float u, float v) {
  for (u32 i = 0; i < stretch->count; ++i) {
    const ListedFace* face = &stretch->faces[i];
    const u32 other = as_uint(face->x);
    if (face->instance == instance && face->t == t &&
        blocks[other >> 3].prim[other & 7u] == blocks[place >> 3].prim[place & 7u])
      return;
  }
  list_face(stretch, t, instance, as_float(place), u, v);
}

#if WIDE_VECTORS
static inline void note_block(const Scene* scene, u32 index, const ShearRay* shear, u32 instance,
                              Stretch* stretch) {
  const BlockTest test = test_block(scene->blocks + index, shear, stretch->from, stretch->to);
  if (!test.lanes) return;
  float t[8], u[8], v[8];
  vstore8(test.t, 0, t);
  vstore8(test.u, 0, u);
  vstore8(test.v, 0, v);
  for (u32 bits = test.lanes; bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    note_triangle(scene->blocks, stretch, index * 8u + i, instance, t[i], u[i], v[i]);
  }
}
#else
static inline void note_block(const Scene* scene, u32 index, const ShearRay* shear, u32 instance,
                              Stretch* stretch) {
  for (u32 i = 0; i < 8u && scene->blocks[index].prim[i] != NO_PRIM; ++i) {
    Hit hit = {.t = stretch->to, .instance = NO_INSTANCE};
    meet_triangle(scene->blocks, index * 8u + i, shear, stretch->from, instance, &hit);
    if (hit.instance != NO_INSTANCE)
      note_triangle(scene->blocks, stretch, hit.prim, instance, hit.t, hit.u, hit.v);
  }
}
#endif

static inline void note_mesh(const Scene* scene, u32 index, Stretch* stretch, uint2* stack) {
  __global const Instance* instance = scene->instances + index;
  float3 o = stretch->o, d = stretch->d;
  if (!(instance->flags & INSTANCE_IDENTITY)) {
    o = object_point(instance, still_point(scene, index, o, time_of_stretch(stretch)));
    d = object_vector(instance, still_vector(scene, index, d, time_of_stretch(stretch)));
  }
  const SlabRay slabs = make_slab_ray(o, d);
  const ShearRay shear = make_shear_ray(o, d);
  u32 top = 0, word = instance->root;
  for (;; word = pop_child(scene->nodes, stack, &top)) {
    if (word & BVH_LEAF) {
      const u32 first = word & BVH_FIRST_MASK,
                last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
      for (u32 i = first; i <= last; ++i) note_block(scene, i, &shear, index, stretch);
    } else
      top = push_node(scene->nodes, word, &slabs, stretch, stack, top);
    if (!top) break;
  }
}

static inline void note_bounded(const Scene* scene, Stretch* stretch) {
  uint2 stack[WALK_LEVELS];
  u32 top = 0, word = scene->info->tlas_root;
  const SlabRay slabs = make_slab_ray(stretch->o, stretch->d);
  for (;; word = pop_child(scene->nodes, stack, &top)) {
    const u32 first = word & BVH_FIRST_MASK, last = first + ((word >> BVH_LEAF_SHIFT) & BVH_LEAF_COUNT_MASK);
    if (!(word & BVH_LEAF)) top = push_node(scene->nodes, word, &slabs, stretch, stack, top);
    for (u32 i = first; (word & BVH_LEAF) && i <= last; ++i) {
      if (!(scene->instances[i].touch > 0.0f)) continue;
      if (HAS_MESH && scene->instances[i].shape == SHAPE_MESH)
        note_mesh(scene, i, stretch, stack + top);
      else if (HAS_SOLID)
        note_solid(scene, i, stretch);
    }
    if (!top) break;
  }
}

NEVER_INLINE void note_all(const Scene* scene, Stretch* stretch) {
  stretch->count = 0;
  if (HAS_BVH && scene->info->bounded_count) note_bounded(scene, stretch);
  const u32 first = HAS_BVH ? scene->info->bounded_count : 0u;
  for (u32 i = first; HAS_SOLID && i < scene->info->instance_count; ++i)
    if (comes_near(scene->instances + i, stretch)) note_solid(scene, i, stretch);
}
#endif
