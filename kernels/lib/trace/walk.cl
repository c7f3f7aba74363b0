// Traces incoherent rays through the two-level BVH. The next step of a ray is unpredictable, so the walks of
// a batch are listed by kind of step, node or leaf, and processed a list at a time: eight boxes or triangles
// per instruction, few branches that depend on a ray, and while one walk waits for memory or arithmetic, the
// others advance. In: rays and their start nodes. Out: their hits, independent of the other rays.
#pragma once
#include "lib/core/config.h"
#if WALKS_IN_TURN
#include "lib/core/tables.h"
#include "lib/core/transform.cl"
#include "lib/trace/aimed_rays.cl"
#include "lib/trace/hits.cl"
#include "lib/trace/listed_hits.cl"
#include "lib/trace/nodes.cl"
#include "lib/trace/triangles.cl"
#include "lib/trace/walk_solids.cl"

// Words on a walk's stack that are not children: at the bottom, and below those of a mesh.
#define WALK_END 0xFFFFFFFFu
#define WALK_BACK 0xFFFFFFFEu

// Room for waiting nodes, those two words, the rest of a leaf, and places that whole vectors read and
// overwrite.
#define WALK_STACK (BVH_STACK + 3 + (LANES > 8 ? LANES : 8))

typedef struct Walk {
  const PreparedRays* rays;  // in the space of the BVH
  u32 ray;
  u32 instance;   // whose mesh is walked; NO_INSTANCE: the scene BVH
  u32 top, base;  // below base, the scene BVH waits while the walk is in a mesh
  u32 stack[WALK_STACK];
  float stack_t[WALK_STACK];  // entry distances of waiting nodes, never beyond the hit; unset for `any`
} Walk;

static inline void push_word(Walk* walk, u32 word) {
  walk->stack[walk->top] = word;
  walk->stack_t[walk->top++] = -INFINITY;
}

static inline void start_walk(Walk* walk, const PreparedRays* rays, u32 ray, u32 word, u32 instance) {
  walk->rays = rays;
  walk->ray = ray;
  walk->instance = instance;
  walk->top = walk->base = 0;
  push_word(walk, WALK_END);
  push_word(walk, word);
}

// Removes nodes behind t from the stack, from place `from` on.
ALWAYS_INLINE void drop_behind(Walk* walk, u32 from, float t) {
  u32 to = from;
  for (u32 i = from; i < walk->top; i += LANES) {
    const u32 count = min(walk->top - i, (u32)LANES);
    const REAL words = read_lanes((const float*)(walk->stack + i)), entries = read_lanes(walk->stack_t + i);
    const MASK kept = MASK_OF(entries <= t) & lanes_of((1u << count) - 1u);
    write_packed((float*)(walk->stack + to), words, kept);
    write_packed(walk->stack_t + to, entries, kept);
    to += lane_count(kept);
  }
  walk->top = to;
}

// Enters the mesh `index`. Returns whether the ray must be prepared again in its space.
static inline bool enter_mesh(__global const Instance* restrict instances, Walk* walk, u32 index) {
  __global const Instance* instance = instances + index;
  walk->instance = index;
  walk->base = walk->top;
  push_word(walk, WALK_BACK);
  push_word(walk, instance->root);
  return !(instance->flags & INSTANCE_IDENTITY);
}

// Prepares the rays of `entering` in the spaces of the meshes they have entered, together for each mesh.
NEVER_INLINE void aim_in_meshes(__global const Instance* restrict instances, const TraceRays* rays,
                                PreparedRays* turned, Walk* walks, u32 entering) {
  while (entering) {
    const u32 index = walks[lowest_bit(entering)].instance;
    u32 alike = 0;
    for (u32 bits = entering; bits; bits &= bits - 1u) {
      const u32 ray = lowest_bit(bits);
      if (walks[ray].instance == index) alike |= 1u << ray;
      walks[ray].rays = turned;
    }
    entering &= ~alike;
    const REAL3 o = object_points(instances + index, still_origins(rays->hits, index, *rays->o)),
                d = object_vectors(instances + index, still_directions(rays->hits, index, *rays->d));
    aim_rays(turned, &o, &d, alike);
  }
}

// Returns from a mesh to the scene BVH.
static inline void leave_mesh(Walk* walk, const PreparedRays* world) {
  walk->rays = world;
  walk->instance = NO_INSTANCE;
  walk->base = 0;
}

// Processes a block's hits: lists unseen ones; the nearest of the others ends the ray.
static inline void list_overruled(const Scene* scene, const TraceRays* rays, Walk* walk, u32 index,
                                  const BlockTest* test) {
  const u32 ray = walk->ray, first = walk->instance;
  const int priority = MASK_LANE(*rays->priorities, ray);
  HitList* list = rays->lists + ray;
  float t[8], u[8], v[8];
  vstore8(test->t, 0, t);
  vstore8(test->u, 0, u);
  vstore8(test->v, 0, v);
  Hit hit = get_hit(rays->hits, ray);
  for (u32 lanes = test->lanes; lanes; lanes &= lanes - 1u) {
    const u32 i = lowest_bit(lanes), place = index * 8u + i;
    const u32 own = instance_of_triangle(scene->instances, first, scene->blocks[index].prim[i]);
    if (is_overruled(scene, own, priority))
      add_listed(list, t[i], u[i], v[i], place, first);
    else
      offer_triangle(scene->blocks, place, t[i], u[i], v[i], first, &hit);
  }
  if (list->full) hit.t = fmin(hit.t, list->t[farthest_listed(list)]);
  set_hit(rays->hits, ray, &hit);
  drop_behind(walk, walk->base, hit.t);
}

// Lists a block's hits, or ends the walk at an opaque one.
NEVER_INLINE void list_hits(const Scene* scene, const TraceRays* rays, Walk* walk, u32 index,
                            const BlockTest* test) {
  const u32 ray = walk->ray, first = walk->instance;
  HitList* list = rays->lists + ray;
  if (rays->priorities) {
    list_overruled(scene, rays, walk, index, test);
    return;
  }
  for (u32 lanes = test->lanes; lanes; lanes &= lanes - 1u) {
    const u32 lane = lowest_bit(lanes);
    const u32 own = instance_of_triangle(scene->instances, first, scene->blocks[index].prim[lane]);
    if (scene->instances[own].flags & INSTANCE_FILTERS) continue;
    // No light passes.
    MASK_LANE(rays->hits->instance, ray) = (int)first;
    MASK_LANE(rays->hits->prim, ray) = (int)(index * 8u + lane);
    clear_list(list);
    walk->top = 1u;
    return;
  }
  const float t = REAL_LANE(rays->hits->t, ray);
  const float end = list_block(index, test, first, t, list);
  if (end == t) return;
  REAL_LANE(rays->hits->t, ray) = end;
  drop_behind(walk, walk->base, end);
}

// Processes the first block of a leaf; the others wait.
ALWAYS_INLINE void walk_block(const Scene* scene, const TraceRays* rays, Walk* walk, u32 word) {
  __global const TriangleBlock* blocks = scene->blocks;
  const REAL* t_min = rays->t_min;
  Hits* hits = rays->hits;
  const u32 index = word & BVH_FIRST_MASK, ray = walk->ray;
  walk->stack[walk->top] = word - (1u << BVH_LEAF_SHIFT) + 1u;
  walk->top += (word >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK) != 0u;
  const ShearRay shear = get_shear(walk->rays, ray);
  const BlockTest test = test_block(blocks + index, &shear, REAL_LANE(*t_min, ray), REAL_LANE(hits->t, ray));
  if (!test.lanes) return;
  if (LISTS_HITS && rays->lists) {
    list_hits(scene, rays, walk, index, &test);
    return;
  }
  Hit hit = get_hit(hits, ray);
  nearest_of_block(blocks, index, &test, walk->instance, &hit);
  set_hit(hits, ray, &hit);
  drop_behind(walk, walk->base, hit.t);
}

// Work that a leaf leaves for all walks of the round at once.
#define LEAF_TURN 1u   // it has entered a mesh: prepare its ray in the mesh's space
#define LEAF_SOLID 2u  // it has reached a solid

// Processes a walk's next word, a leaf.
ALWAYS_INLINE u32 walk_leaf(const Scene* scene, const TraceRays* rays, const PreparedRays* world, Walk* walk,
                            u32 word, bool any) {
  if (HAS_MESH && word == WALK_BACK) {
    leave_mesh(walk, world);
    if (!any) drop_behind(walk, 1u, REAL_LANE(rays->hits->t, walk->ray));
    return 0u;
  }
  if (HAS_MESH && walk->instance != NO_INSTANCE) {
    walk_block(scene, rays, walk, word);
    return 0u;
  }
  // The first of the leaf's instances; the others wait.
  const u32 index = word & BVH_FIRST_MASK;
  if (word >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK) push_word(walk, word - (1u << BVH_LEAF_SHIFT) + 1u);
  if (!HAS_MESH || scene->instances[index].shape != SHAPE_MESH) return LEAF_SOLID;
  return enter_mesh(scene->instances, walk, index) ? LEAF_TURN : 0u;
}

// Ends the walks of `bits` that have hit something opaque, and returns them.
static inline u32 end_at_opaque(__global const Instance* restrict instances, const TraceRays* rays,
                                u32 bits) {
  const u32 ended = lane_bits(opaque_hits(instances, rays->hits, lanes_of(bits)));
  for (u32 left = ended; left; left &= left - 1u) clear_list(rays->lists + lowest_bit(left));
  return ended;
}

// Tests the walks of `bits`, which is not 0, against solids[ray]. Returns those that continue.
NEVER_INLINE u32 walk_solids(__global const Instance* restrict instances, const u32* solids, u32 bits,
                             const TraceRays* rays, Walk* walks, bool any) {
  const REAL before = rays->hits->t;
  hit_solids_by_lane(instances, solids, bits, rays->o, rays->d, rays->t_min, rays->hits);
  if (any) return bits & ~lane_bits(hit_anything(rays->hits));
  if (LISTS_HITS && rays->lists && !rays->priorities) bits &= ~end_at_opaque(instances, rays, bits);
  for (u32 nearer = bits & lane_bits(MASK_OF(rays->hits->t < before)); nearer; nearer &= nearer - 1u) {
    const u32 ray = lowest_bit(nearer);
    drop_behind(&walks[ray], 1u, REAL_LANE(rays->hits->t, ray));
  }
  return bits;
}

// Processes a walk's next word, a node.
ALWAYS_INLINE void walk_node(__global const u32* nodes, const REAL* t_min, const Hits* hits, Walk* walk,
                             u32 word, bool any) {
  const u32 ray = walk->ray, top = walk->top - 1u;
  const SlabRay slabs = get_slabs(walk->rays, ray);
  __global const BvhNode* node = node_at(nodes, word);
  const float from = REAL_LANE(*t_min, ray), to = REAL_LANE(hits->t, ray);
  u32* stack = walk->stack + top;
  float* stack_t = walk->stack_t + top;
  walk->top = top + (any ? push_in_any_order(node, &slabs, from, to, stack, stack_t)
                         : push_crossed(node, &slabs, from, to, stack, stack_t));
}

// Appends a walk to the list of its next word; an ended one joins none. Branchless, with the counts in
// registers: a list selected by index would be written and read too close together.
ALWAYS_INLINE void list_walk(Walk* walk, Walk** at_node, u32* node_words, u32* node_count, Walk** at_leaf,
                             u32* leaf_count) {
  const u32 word = walk->stack[walk->top - 1u], leaf = word >> 31;
  at_node[*node_count] = walk;
  node_words[*node_count] = word;
  at_leaf[*leaf_count] = walk;
  *node_count += 1u - leaf;
  *leaf_count += leaf - (word == WALK_END ? 1u : 0u);
}
#define LIST_WALK(walk) list_walk(walk, at_node, node_words, &node_count, at_leaf, &leaf_count)

// A root with this few children is tested for all rays of a batch at once, so that most need no walk: a lamp,
// or a mesh far from the rays.
#define FEW_CHILDREN 2

// The lanes whose rays cross a child's box, by the test of slab_distances().
static inline MASK crossing_child(__global const BvhNode* node, u32 slot, const PreparedRays* rays,
                                  const REAL* t_min, const REAL* t_max) {
  const MASK back_x = MASK_OF(rays->near_x != 0), back_y = MASK_OF(rays->near_y != 8),
             back_z = MASK_OF(rays->near_z != 16);
  const REAL x = (REAL)(node->lower_x[slot]), y = (REAL)(node->lower_y[slot]),
             z = (REAL)(node->lower_z[slot]), far_x = (REAL)(node->upper_x[slot]),
             far_y = (REAL)(node->upper_y[slot]), far_z = (REAL)(node->upper_z[slot]);
  const MASK in_x = AS_MASK(fma(select(x, far_x, back_x), rays->rcp_near.x, rays->shift_near.x)),
             in_y = AS_MASK(fma(select(y, far_y, back_y), rays->rcp_near.y, rays->shift_near.y)),
             in_z = AS_MASK(fma(select(z, far_z, back_z), rays->rcp_near.z, rays->shift_near.z)),
             out_x = AS_MASK(fma(select(far_x, x, back_x), rays->rcp_far.x, rays->shift_far.x)),
             out_y = AS_MASK(fma(select(far_y, y, back_y), rays->rcp_far.y, rays->shift_far.y)),
             out_z = AS_MASK(fma(select(far_z, z, back_z), rays->rcp_far.z, rays->shift_far.z));
  return MASK_OF(max(max(in_x, in_y), max(in_z, AS_MASK(*t_min))) <=
                 min(min(out_x, out_y), min(out_z, AS_MASK(*t_max))));
}

// The lanes of `bits` that cross a child of the node `word`, if it has few; else all.
static inline u32 crossing_few(const Scene* scene, u32 word, const TraceRays* traced,
                               const PreparedRays* rays, u32 bits) {
  if (word & BVH_LEAF) return bits;
  __global const BvhNode* node = node_at(scene->nodes, word);
  const u32 count = popcount(node->valid);
  if (count > FEW_CHILDREN) return bits;
  MASK crossing = NO_LANES;
  for (u32 slot = 0; slot < count; ++slot)
    crossing |= crossing_child(node, slot, rays, traced->t_min, &traced->hits->t);
  return bits & lane_bits(crossing);
}

// Finds the nearest hits, or with `any` the first found, of the lanes of `bits`, which is not 0, from `word`
// of the scene BVH on or, for rays in object space, of the mesh BVH of `instance`.
NEVER_INLINE void walk_rays(const Scene* scene, const TraceRays* rays, u32 bits, u32 word, u32 instance,
                            bool any) {
  const REAL* t_min = rays->t_min;
  Hits* hits = rays->hits;
  PreparedRays world, turned;
  aim_rays(&world, rays->o, rays->d, bits);
  if (bits & (bits - 1u)) bits = crossing_few(scene, word, rays, &world, bits);
  if (!bits) return;
  Walk walks[LANES];
  Walk *at_node[LANES + 1], *at_leaf[LANES + 1];
  u32 node_words[LANES + 1], node_count = 0, leaf_count = 0;
  u32 solids[LANES];  // reached by the rays
  for (; bits; bits &= bits - 1u) {
    const u32 ray = lowest_bit(bits);
    start_walk(&walks[ray], &world, ray, word, instance);
    LIST_WALK(&walks[ray]);
  }
  while (node_count | leaf_count) {
    // The longer list, so that much work overlaps.
    if (node_count > leaf_count) {
      const u32 count = node_count;
      for (u32 k = 0; k < count; ++k) walk_node(scene->nodes, t_min, hits, at_node[k], node_words[k], any);
      // Only now, when the pushed words have arrived in memory.
      node_count = 0;
      for (u32 k = 0; k < count; ++k) LIST_WALK(at_node[k]);
    } else {
      const u32 count = leaf_count;
      u32 entering = 0, at_solid = 0;
      leaf_count = 0;
      for (u32 k = 0; k < count; ++k) {
        Walk* walk = at_leaf[k];
        const u32 word = walk->stack[--walk->top], ray = walk->ray;
        const u32 left = walk_leaf(scene, rays, &world, walk, word, any);
        solids[ray] = word & BVH_FIRST_MASK;
        entering |= (left & LEAF_TURN) << ray;
        at_solid |= (left / LEAF_SOLID) << ray;
        if (left == LEAF_SOLID || (any && MASK_LANE(hits->instance, ray) != (int)NO_INSTANCE)) continue;
        LIST_WALK(walk);
      }
      if (entering) aim_in_meshes(scene->instances, rays, &turned, walks, entering);
      if (!HAS_SOLID || !at_solid) continue;
      for (u32 on = walk_solids(scene->instances, solids, at_solid, rays, walks, any); on; on &= on - 1u)
        LIST_WALK(&walks[lowest_bit(on)]);
    }
  }
}

#endif
