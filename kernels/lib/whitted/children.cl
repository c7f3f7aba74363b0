// The reflected and refracted rays that come of surfaces (Whitted 1980), left on a stack.
#ifndef SUNDOG_LIB_CHILDREN_CL
#define SUNDOG_LIB_CHILDREN_CL
#include "lib/path/path_samples.cl"
#include "lib/path/ray_counts.cl"
#include "lib/path/ray_stack.cl"
#include "lib/path/segment.cl"
#include "lib/shade/bsdf.cl"
#include "lib/shade/cones.cl"
#include "lib/shade/layers.cl"
#include "lib/shade/relief_hits.cl"
#include "lib/shade/rough.cl"

// The surfaces of `lanes` cover so many times (1 or -1) the part of the pixels that the rays, those that run
// straight on from the camera, have of the light behind the scene.
#if HAS_MATTES
static inline void add_mattes(const Scene* scene, const TileSamples* tile, const WaitingRays* paths,
                              const SurfaceInteractions* s, MASK lanes, float times) {
  const REAL3 t = paths->throughput;
  const REAL passed = (t.x + t.y + t.z) * (times / 3.0f);
  for (u32 bits = lane_bits(lanes & MASK_OF((paths->depth & TURNED) == 0)); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits), pixel = (u32)MASK_LANE(paths->pixel, i);
    add_matte(scene, tile->sums + (u32)MASK_LANE(tile->place, pixel) * SAMPLE_VECTORS,
              MASK_LANE(s->instance, i), MASK_LANE(s->material, i),
              REAL_LANE(tile->sign, pixel) * REAL_LANE(passed, i));
  }
}
#else
static inline void add_mattes(const Scene* scene, const TileSamples* tile, const WaitingRays* paths,
                              const SurfaceInteractions* s, MASK lanes, float times) {}
#endif

#if HAS_SECONDARY
// Puts children on the stack, those of `lanes` that are not too weak, nor too deep, nor without room; each
// case is counted. Returns those that it put there.
NEVER_INLINE MASK spawn(__global const SceneInfo* restrict info, RayStack* stack, const SceneRays* rays,
                        const WaitingRays* paths, MASK lanes, u32 kind, u32* counts) {
  const REAL weight = greatest3(paths->throughput);
  const MASK some = lanes & MASK_OF(weight > 0.0f);
  const MASK deep = some & MASK_OF(depth_of(paths) > (int)info->max_depth);
  const MASK weak = some & ~deep & MASK_OF(weight < info->cutoff);
  u32 bits = lane_bits(some & ~deep & ~weak);
  counts[COUNT_DEPTH_LIMIT] += lane_count(deep);
  counts[COUNT_CAMERA_DEPTH_LIMIT] += lane_count(deep & MASK_OF((paths->depth & TURNED) == 0));
  counts[COUNT_CUT_OFF] += lane_count(weak);
  while (stack->count + popcount(bits) > RAY_STACK) {
    counts[COUNT_RAY_STACK_OVERFLOW] += 1u;
    bits &= bits - 1u;
  }
  if (!bits) return NO_LANES;
  counts[kind] += popcount(bits);
  note_rays(paths->pixel, lanes_of(bits), counts);
  push_rays(stack, rays, paths, lanes_of(bits));
  return lanes_of(bits);
}

// What rays meet at surfaces: rough ones have facets there, others are their own.
#if HAS_ROUGH
static inline Facets met_facets(const Scene* scene, const TileSamples* tile, const WaitingRays* paths,
                                const Bsdfs* surface, REAL3 wo, MASK lanes) {
  REAL u_x, u_y;
  bounce_numbers(tile, paths, 0u, BOUNCE_DIRECTION, 0u, 1u, lanes, &u_x, &u_y);
  return make_facets(scene, surface, wo, u_x, u_y, lanes);
}
static inline REAL3 reflected_by(const Facets* facets, REAL3 wo) {
  const Bsdfs* bsdf = &facets->bsdf;
  return select3(reflected_direction(bsdf, wo), reflect_direction(negate3(wo), bsdf->ns), facets->rough);
}
static inline REAL3 transmitted_by(const Facets* facets, const SpecularSplits* split, REAL3 wo) {
  const Bsdfs* bsdf = &facets->bsdf;
  const REAL3 bent = refract_direction(negate3(wo), bsdf->ns, split->cos_i, split->cos_t, split->eta);
  return select3(transmitted_direction(bsdf, split, wo), bent, facets->rough & MASK_OF(split->eta != 1.0f));
}
// `share` is what Fresnel's equations make of glass's own `color`.
static inline void weigh_by_facets(const Facets* facets, const Bsdfs* surface, REAL3 wi, float side,
                                   REAL3 color, REAL share, MASK mends, REAL3* throughput) {
  const REAL3 tint = scale3(color, 1.0f / real_max(share, (REAL)(1e-6f)));
  const REAL3 own = select3(color, tint, facets->glass);
  *throughput = multiply3(*throughput, facet_weight(facets, surface, wi, side, own, mends | facets->glass));
}
#else
typedef struct Facets {
  Bsdfs bsdf;
} Facets;
static inline Facets met_facets(const Scene* scene, const TileSamples* tile, const WaitingRays* paths,
                                const Bsdfs* surface, REAL3 wo, MASK lanes) {
  const Facets facets = {*surface};
  return facets;
}
static inline REAL3 reflected_by(const Facets* facets, REAL3 wo) {
  return reflected_direction(&facets->bsdf, wo);
}
static inline REAL3 transmitted_by(const Facets* facets, const SpecularSplits* split, REAL3 wo) {
  return transmitted_direction(&facets->bsdf, split, wo);
}
static inline void weigh_by_facets(const Facets* facets, const Bsdfs* surface, REAL3 wi, float side,
                                   REAL3 color, REAL share, MASK mends, REAL3* throughput) {}
#endif

// The children of the surfaces of `lanes`: kr I(reflected) + kt I(transmitted). Returns the surfaces that are
// not there.
static inline MASK spawn_children(const Scene* scene, const TileSamples* tile, const SurfaceInteractions* s,
                                  const Bsdfs* surface, const Encounters* met, const SceneRays* rays,
                                  const WaitingRays* paths, MASK lanes, RayStack* stack, u32* counts) {
  const REAL3 wo = negate3(rays->d);
  const Facets facets = met_facets(scene, tile, paths, surface, wo, lanes);
  SpecularSplits split = bsdf_specular(scene, &facets.bsdf, wo, lanes);
  mirror_layers(scene, surface, wo, split.branches, &split);
  if (!any_lane(split.branches)) return NO_LANES;
  SceneRays child = *rays;
  child.t_min = (REAL)(0.0f);
  child.t_max = (REAL)(INFINITY);
  WaitingRays state = *paths;
  state.depth = (paths->depth + 1) | TURNED;
  start_on_surfaces(scene->info, &child, &met->hit, ~s->entering, split.branches);
  const REAL curvature = curvatures(scene, s, split.branches);
  spread_reflected(curvature, &child);
  child.d = reflected_by(&facets, wo);
  REAL way;
  child.o = along3(leave_relief(s, child.d, &way), s->offset, leaving_normal(s));
  state.throughput = multiply3(paths->throughput, split.kr);
  const MASK simple = MASK_OF(split.kt.x + split.kt.y + split.kt.z == 0.0f) | ~split.transmits;
  weigh_by_facets(&facets, surface, child.d, 1.0f, split.kr, split.f, simple, &state.throughput);
  start_branch(paths, 0u, &state);
  spawn(scene->info, stack, &child, &state, split.branches, COUNT_REFLECTION, counts);

  if (!any_lane(split.transmits)) return NO_LANES;
  spread_transmitted(curvature, &split, rays, &child);
  child.d = transmitted_by(&facets, &split, wo);
  child.o = points_behind(scene, s, rays->d, split.transmits);
  state.throughput = multiply3(paths->throughput, split.kt);
  weigh_by_facets(&facets, surface, child.d, -1.0f, split.kt, 1.0f - split.f, NO_LANES, &state.throughput);
  start_branch(paths, 1u, &state);
  start_on_hits(scene->info, &child, &met->hit, s->entering, split.transmits);
  enter_behind(met, rays, split.transmits, &child);
  const MASK nothing = cut_away(&facets.bsdf, &split, lanes), free = nothing & may_cross(rays, lanes);
  const MASK bends = MASK_OF(split.eta != 1.0f);
  cross_further(rays, &child, free);
  state.depth = select(paths->depth + 1, (paths->depth + 1) | TURNED, bends) + free;
  const MASK gone = spawn(scene->info, stack, &child, &state, split.transmits, COUNT_REFRACTION, counts);
  add_mattes(scene, tile, &state, s, gone, -1.0f);
  return nothing;
}
#else
static inline MASK spawn_children(const Scene* scene, const TileSamples* tile, const SurfaceInteractions* s,
                                  const Bsdfs* surface, const Encounters* met, const SceneRays* rays,
                                  const WaitingRays* paths, MASK lanes, RayStack* stack, u32* counts) {
  return NO_LANES;
}
#endif

#endif
