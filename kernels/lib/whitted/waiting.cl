// Keeps in the tile what plain/whitted leaves there: rays that wait, and what pixels show less of; sends the
// shadow rays of surfaces.
#pragma once
#include "lib/path/environment_cells.cl"
#include "lib/path/mattes.cl"
#include "lib/path/path_samples.cl"
#include "lib/path/ray_counts.cl"
#include "lib/shade/bsdf.cl"
#include "lib/trace/shaft.cl"
#if HAS_SDF
#include "lib/sdf/light.cl"
#endif

static inline void wait_again(const TileSamples* tile, const SceneRays* rays, const WaitingRays* paths,
                              MASK lanes) {
  if (BATCH > 1) push_rays(tile->stack, rays, paths, lanes);
}

// Returns the lanes for which there was room.
#if HAS_SECONDARY
NEVER_INLINE MASK push_child(const TileSamples* tile, const SceneRays* rays, const WaitingRays* paths,
                             MASK lanes, u32 kind, u32* counts) {
  u32 bits = lane_bits(lanes);
  while (tile->stack->count + popcount(bits) > RAY_STACK) {
    counts[COUNT_RAY_STACK_OVERFLOW] += 1u;
    bits &= bits - 1u;
  }
  counts[kind] += popcount(bits);
  note_rays(paths->pixel, lanes_of(bits), counts);
  push_rays(tile->stack, rays, paths, lanes_of(bits));
  return lanes_of(bits);
}
#endif

static inline void push_shadow(const TileSamples* tile, const SceneRays* rays, const WaitingRays* paths,
                               MASK lanes) {
  push_shadows(tile->shadows, rays, paths, lanes);
}

static inline void add_light(const TileSamples* tile, MASK pixel, REAL3 light, MASK lanes) {
  add_to_pixels(light, pixel, lanes, tile->radiance);
}

static inline void uncover(const TileSamples* tile, MASK pixel, REAL part, MASK lanes) {
  EACH_LANE(i, lanes) { tile->radiance[MASK_LANE(pixel, i)].w -= REAL_LANE(part, i); }
}

// Adds `part`, which may be negative, to what the surfaces or media of `lanes` cover of their pixels.
#if HAS_MATTES
static inline void cover_by(const Scene* scene, const TileSamples* tile, MASK pixels, MASK instances,
                            MASK materials, MASK lanes, REAL part) {
  EACH_LANE(i, lanes) {
    const u32 pixel = (u32)MASK_LANE(pixels, i);
    add_matte(scene, tile->sums + (u32)MASK_LANE(tile->place, pixel) * SAMPLE_VECTORS,
              MASK_LANE(instances, i), MASK_LANE(materials, i),
              REAL_LANE(tile->sign, pixel) * REAL_LANE(part, i));
  }
}
#endif

#include "plain/whitted/shadow_rays.cl"
#include "plain/whitted/shaft_light.cl"
#include "plain/whitted/steps.cl"

// The shadow ray *index is the next of the surfaces of `lanes`: returns those that send it. If none does,
// since shafts serve its light, *index becomes the first ray to the next one.
static inline MASK sends_ray(const Scene* scene, const TileSamples* tile, const SceneRays* rays,
                             const WaitingRays* paths, MASK lanes, const SurfaceShadings* at, u32* index,
                             u32* counts) {
  if (!HAS_SHAFTS || scene->light_rays[*index].ray) return lanes;
  const MASK casting = lanes & needs_rays(scene, *index, tile, rays, paths, at, counts, lanes);
  if (!any_lane(casting)) *index += scene->light_rays[*index].rays;
  return casting;
}
