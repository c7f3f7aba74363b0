// The reflected and refracted rays that come of surfaces (Whitted 1980), left on a stack.
#ifndef SUNDOG_LIB_CHILDREN_CL
#define SUNDOG_LIB_CHILDREN_CL
#include "lib/path/path_samples.cl"
#include "lib/path/ray_stack.cl"
#include "lib/path/segment.cl"
#include "lib/shade/bsdf.cl"
#include "lib/shade/cones.cl"
#include "lib/shade/rough.cl"

#if HAS_SECONDARY
// Puts children on the stack, those of `lanes` that are not too weak, nor too deep, nor without room; each
// case is counted.
NEVER_INLINE void spawn(__global const SceneInfo* restrict info, RayStack* stack, const SceneRays* rays,
                        const PathStates* paths, MASK lanes, u32 kind, u32* counts) {
  const REAL weight = greatest3(paths->throughput);
  const MASK some = lanes & MASK_OF(weight > 0.0f);
  const MASK deep = some & MASK_OF(paths->depth > (int)info->max_depth);
  const MASK weak = some & ~deep & MASK_OF(weight < info->cutoff);
  u32 bits = lane_bits(some & ~deep & ~weak);
  counts[COUNT_DEPTH_LIMIT] += lane_count(deep);
  counts[COUNT_CUT_OFF] += lane_count(weak);
  while (stack->count + popcount(bits) > RAY_STACK) {
    counts[COUNT_RAY_STACK_OVERFLOW] += 1u;
    bits &= bits - 1u;
  }
  if (!bits) return;
  counts[kind] += popcount(bits);
  push_rays(stack, rays, paths, lanes_of(bits));
}

// The children of the surfaces of `lanes`: kr I(reflected) + kt I(transmitted).
static inline void spawn_children(const Scene* scene, const TileSamples* tile, const SurfaceInteractions* s,
                                  const Bsdfs* surface, const Encounters* met, const SceneRays* rays,
                                  const PathStates* paths, MASK lanes, RayStack* stack, u32* counts) {
  const REAL3 wo = negate3(rays->d);
#if HAS_ROUGH
  REAL u_x, u_y;
  bounce_numbers(tile, paths, 0u, BOUNCE_DIRECTION, 0u, 1u, lanes, &u_x, &u_y);
  const Facets facets = make_facets(scene, surface, wo, u_x, u_y, lanes);
  const Bsdfs* bsdf = &facets.bsdf;
#else
  const Bsdfs* bsdf = surface;
#endif
  const SpecularSplits split = bsdf_specular(scene, bsdf, wo, lanes);
  if (!any_lane(split.branches)) return;
  SceneRays child = *rays;
  child.t_min = (REAL)(0.0f);
  child.t_max = (REAL)(INFINITY);
  PathStates state = *paths;
  state.depth = paths->depth + 1;
  start_on_surfaces(scene->info, &child, &met->hit, ~s->entering, split.branches);
#if HAS_CONES
  const REAL curvature = curvatures(scene, s, split.branches), spread = child.cone_spread;
  spread_reflected(curvature, &child);
#endif
  child.d = reflected_direction(bsdf, wo);
  child.o = along3(s->p, s->offset, s->ng);
  state.throughput = multiply3(paths->throughput, split.kr);
#if HAS_ROUGH
  child.d = select3(child.d, reflect_direction(rays->d, bsdf->ns), facets.rough);
  const MASK simple = MASK_OF(split.kt.x + split.kt.y + split.kt.z == 0.0f) | ~split.transmits;
  state.throughput =
      multiply3(state.throughput, facet_weight(&facets, surface, child.d, 1.0f, split.kr, simple));
#endif
#if HAS_RANDOM
  state.branch = child_branch(paths->branch, 0u);
#endif
  spawn(scene->info, stack, &child, &state, split.branches, COUNT_REFLECTION, counts);

  if (!any_lane(split.transmits)) return;
#if HAS_CONES
  spread_transmitted(curvature, &split, spread, &child);
#endif
  child.d = transmitted_direction(bsdf, &split, wo);
#if HAS_ROUGH
  const REAL3 bent = refract_direction(rays->d, bsdf->ns, split.cos_i, split.cos_t, split.eta);
  child.d = select3(child.d, bent, facets.rough & MASK_OF(split.eta != 1.0f));
#endif
  child.o = along3(s->p, -s->offset, s->ng);
  state.throughput = multiply3(paths->throughput, split.kt);
#if HAS_ROUGH
  state.throughput =
      multiply3(state.throughput, facet_weight(&facets, surface, child.d, -1.0f, split.kt, NO_LANES));
#endif
#if HAS_RANDOM
  state.branch = child_branch(paths->branch, 1u);
#endif
  start_on_hits(scene->info, &child, &met->hit, s->entering, split.transmits);
  enter_behind(met, rays, split.transmits, &child);
  spawn(scene->info, stack, &child, &state, split.transmits, COUNT_REFRACTION, counts);
}
#else
static inline void spawn_children(const Scene* scene, const TileSamples* tile, const SurfaceInteractions* s,
                                  const Bsdfs* surface, const Encounters* met, const SceneRays* rays,
                                  const PathStates* paths, MASK lanes, RayStack* stack, u32* counts) {}
#endif

#endif
