// The reflected and refracted rays that come of a surface (Whitted 1980), left on a stack.
#include "plain/shade/cones.cl"
#include "plain/shade/local_light.cl"
#include "plain/whitted/interface.h"

static inline float mean_of(float3 a) { return (a.x + a.y + a.z) * (1.0f / 3.0f); }

HAVING(HAS_SECONDARY);

// Puts a child on the stack if it is neither too weak nor too deep, and there is room; each case is counted.
static bool spawn(UNIFORM const Scene* scene, UNIFORM const TileSamples* tile, const SceneRay* child,
                  const WaitingRay* path, UNIFORM u32 kind, UNIFORM u32* counts) {
  const float weight = greatest(path->throughput);
  if (!(weight > 0.0f)) return false;
  if (depth_of(path) > (int)scene->info->max_depth) {
    count(counts, COUNT_DEPTH_LIMIT);
    if (is_straight(path)) count(counts, COUNT_CAMERA_DEPTH_LIMIT);
    return false;
  }
  if (weight < scene->info->cutoff) {
    count(counts, COUNT_CUT_OFF);
    return false;
  }
  return push_child(tile, child, path, kind, counts);
}

// Whether a surface that bends light covers what is behind it.
static inline bool covers_behind(const MetFacet* facet, const Interface* interface) {
  bool covers = interface->eta != 1.0f;
  if (HAS_CLEAR_GLASS) covers = false;
  if (HAS_CLEAR_GLASS && HAS_ROUGH) covers = interface->eta != 1.0f && facet->rough;
  return covers;
}

// The children of the surface: kr I(reflected) + kt I(transmitted). Whether the surface is not there.
static inline bool spawn_children(UNIFORM const Scene* scene, UNIFORM const TileSamples* tile,
                                  const SceneRay* ray, const WaitingRay* path, const Encounter* met,
                                  const SurfaceShading* at, UNIFORM u32* counts) {
  const float3 wo = -ray->d;
  float u_x = 0.0f, u_y = 0.0f, way;
  if (HAS_ROUGH) bounce_numbers(tile, path, BOUNCE_DIRECTION, 0u, 1u, &u_x, &u_y);
  const MetFacet facet = meet_facet(scene, &at->bsdf, wo, u_x, u_y);
  Interface interface = make_interface(scene, &facet.bsdf, wo);
  if (!interface.branches) return false;
  mirror_layers(scene, &at->bsdf, wo, &interface);
  float curvature = 0.0f;
  if (HAS_CONES) curvature = curvature_at(scene, &at->s);
  WaitingRay next = *path;
  next.depth = (path->depth + 1) | TURNED;
  SceneRay child = leaving_ray(scene, ray, met, at, reflected_by(&facet, wo), false, &way);
  child.t_max = INFINITY;
  spread_reflected(curvature, &child);
  const bool straight = interface.eta == 1.0f;  // what facets let through, they do not see
  const bool mends = straight || interface.kt.x + interface.kt.y + interface.kt.z == 0.0f;
  next.throughput = path->throughput * interface.kr;
  next.throughput *= facet_weight(&facet, &at->bsdf, child.d, 1.0f, interface.kr, interface.f, mends);
  if (HAS_RANDOM) next.branch = child_branch(path->branch, 0u);
  spawn(scene, tile, &child, &next, COUNT_REFLECTION, counts);

  if (!interface.transmits) return false;
  child = leaving_ray(scene, ray, met, at, transmitted_by(&facet, &interface, wo), true, &way);
  child.t_max = INFINITY;
  spread_transmitted(curvature, &interface, &child);
  next.throughput = path->throughput * interface.kt;
  if (!straight)
    next.throughput *=
        facet_weight(&facet, &at->bsdf, child.d, -1.0f, interface.kt, 1.0f - interface.f, false);
  if (HAS_RANDOM) next.branch = child_branch(path->branch, 1u);
  const bool nothing = cut_away(&facet.bsdf, &interface), free = nothing && may_cross(ray);
  if (free) cross_further(ray, &child);
  next.depth = path->depth + (free ? 0 : 1);
  if (covers_behind(&facet, &interface)) next.depth = (path->depth + 1) | TURNED;
  if (spawn(scene, tile, &child, &next, COUNT_REFRACTION, counts)) {
    if (HAS_MATTES && is_straight(&next))
      cover_by(scene, tile, path->pixel, at->s.instance, at->s.material, -mean_of(next.throughput));
  }
  return nothing;
}
