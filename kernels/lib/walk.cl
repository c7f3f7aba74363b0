// Rays by themselves through the two-level BVH, a few of them in turn, a step each: while one waits for a
// node, the others' arithmetic goes on. A step tests eight children or eight triangles an instruction and
// takes as few branches as it can, for where an incoherent ray goes next cannot be foretold. In: rays and
// where they begin. Out: their hits, which do not depend on the rays that go along.
#ifndef SUNDOG_LIB_WALK_CL
#define SUNDOG_LIB_WALK_CL
#include "lib/config.h"
#if WALKS_IN_TURN
#include "lib/hits.cl"
#include "lib/nodes.cl"
#include "lib/solid_instance.cl"
#include "lib/tables.h"
#include "lib/transform.cl"
#include "lib/triangles.cl"

// Rays that are walked in turn.
#ifndef WALKS
#define WALKS 4
#endif

// Room for the nodes that wait, for what else waits of a leaf, and for the eight places that push_crossed
// overwrites.
#define WALK_STACK (BVH_STACK + 9)

typedef struct Walk {
  SlabRay slabs;   // in the space of the BVH
  ShearRay shear;  // in a mesh
  Hit hit;         // a triangle's prim is its place (see finish_triangle)
  float t_min;
  u32 ray;        // NO_RAY: the walk rests
  u32 instance;   // in whose mesh the walk is; NO_INSTANCE: in the scene BVH
  u32 word;       // what comes next
  u32 top, base;  // below base waits the scene BVH while the walk is in a mesh
  u32 stack[WALK_STACK];
  float stack_t[WALK_STACK];
} Walk;

#define NO_RAY 0xFFFFFFFFu

// Lanes of rays; hits->t is where they end.
typedef struct WalkRays {
  const REAL3 *o, *d;
  const REAL* t_min;
  Hits* hits;
} WalkRays;

static inline void start_walk(Walk* walk, const WalkRays* rays, u32 ray, u32 word, u32 instance) {
  const float3 o = get3(rays->o, ray), d = get3(rays->d, ray);
  walk->slabs = make_slab_ray(o, d);
  if (instance != NO_INSTANCE) walk->shear = make_shear_ray(o, d);
  walk->hit = get_hit(rays->hits, ray);
  walk->t_min = REAL_LANE(*rays->t_min, ray);
  walk->ray = ray;
  walk->instance = instance;
  walk->word = word;
  walk->top = walk->base = 0;
}

// A leaf of the scene BVH: the first of its instances is tested, or entered when it is a mesh, and the others
// wait. Returns whether walk->word is what comes next.
NEVER_INLINE bool walk_instance(__global const Instance* restrict instances, Walk* walk, float3 o, float3 d) {
  const u32 index = walk->word & BVH_FIRST_MASK;
  if (walk->word >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK) {
    walk->stack[walk->top] = walk->word - (1u << BVH_LEAF_SHIFT) + 1u;
    walk->stack_t[walk->top++] = -INFINITY;
  }
  __global const Instance* instance = instances + index;
  if (instance->shape != SHAPE_MESH) {
    trace_solid(instances, index, o, d, walk->t_min, &walk->hit);
    return false;
  }
  if (!(instance->flags & INSTANCE_IDENTITY)) {
    o = object_point(instance, o);
    d = object_vector(instance, d);
    walk->slabs = make_slab_ray(o, d);
  }
  walk->shear = make_shear_ray(o, d);
  walk->instance = index;
  walk->base = walk->top;
  walk->word = instance->root;
  return true;
}

ALWAYS_INLINE void walk_blocks(__global const TriangleBlock* blocks, Walk* walk) {
  const u32 first = walk->word & BVH_FIRST_MASK,
            last = first + (walk->word >> BVH_LEAF_SHIFT & BVH_LEAF_COUNT_MASK);
  for (u32 i = first; i <= last; ++i)
    closest_in_block(blocks, i, &walk->shear, walk->t_min, walk->instance, &walk->hit);
}

// Sets what comes next to the nearest that waits. Returns false when nothing does.
ALWAYS_INLINE bool next_word(__global const Instance* restrict instances, Walk* walk, const WalkRays* rays) {
  u32 top = walk->top;
  do {
    if (top == walk->base) {
      if (!top) return false;
      // Back from a mesh to the scene BVH.
      if (!(instances[walk->instance].flags & INSTANCE_IDENTITY))
        walk->slabs = make_slab_ray(get3(rays->o, walk->ray), get3(rays->d, walk->ray));
      walk->instance = NO_INSTANCE;
      walk->base = 0;
    }
    --top;
  } while (walk->stack_t[top] > walk->hit.t);
  walk->top = top;
  walk->word = walk->stack[top];
  return true;
}

// One node or leaf. Returns false at the end.
ALWAYS_INLINE bool step_walk(TRACE_PARAMETERS, Walk* walk, const WalkRays* rays, bool any) {
  if (!(walk->word & BVH_LEAF)) {
    walk->top += push_crossed(node_at(nodes, walk->word), &walk->slabs, walk->t_min, walk->hit.t,
                              walk->stack + walk->top, walk->stack_t + walk->top);
  } else {
    if (walk->instance != NO_INSTANCE)
      walk_blocks(blocks, walk);
    else if (walk_instance(instances, walk, get3(rays->o, walk->ray), get3(rays->d, walk->ray)))
      return true;
    if (any && walk->hit.instance != NO_INSTANCE) return false;
  }
  return next_word(instances, walk, rays);
}

// The nearest hits, or with `any` whichever come first, of the lanes of `bits`, from `word` of the scene BVH
// on; or, rays in object space, of the mesh BVH of `instance`.
NEVER_INLINE void walk_rays(TRACE_PARAMETERS, const WalkRays* rays, u32 bits, u32 word, u32 instance,
                            bool any) {
  Walk walks[WALKS];
  for (u32 k = 0; k < WALKS; ++k) walks[k].ray = NO_RAY;
  u32 left = popcount(bits);
  while (left) {
    for (u32 k = 0; k < WALKS; ++k) {
      Walk* walk = &walks[k];
      if (walk->ray == NO_RAY) {
        if (!bits) continue;
        start_walk(walk, rays, lowest_bit(bits), word, instance);
        bits &= bits - 1u;
      }
      if (step_walk(TRACE_ARGUMENTS, walk, rays, any)) continue;
      set_hit(rays->hits, walk->ray, &walk->hit);
      walk->ray = NO_RAY;
      --left;
    }
  }
}

#endif

#endif
