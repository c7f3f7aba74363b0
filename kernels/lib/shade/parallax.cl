// Parallax: rays continue below a surface until they hit its height map, and heights occlude light (Brawley
// and Tatarchuk 2004, "Parallax Occlusion Mapping: Self-Shadowing, Perspective-Correct Bump Mapping Using
// Reverse Height Map Tracing"). The surface itself is at height 1. One surface per lane.
#pragma once
#include "lib/shade/maps.cl"

#define PARALLAX_SLANT 0.05f  // minimum sine of rays along the surface

#if HAS_PARALLAX
#define PARALLAX_STEPS 128   // maximum
#define PARALLAX_LEAST 8.0f  // minimum, plus one for each texel crossed
#define PARALLAX_UNKNOWN 48  // for heights without texels
#define PARALLAX_HALVINGS 6  // bisections of the step in which a ray hits the heights
#define PARALLAX_BIAS 0.01f  // relative to the depth: minimum height above a ray to occlude it

// Straight paths through the layer of heights, from 0 to 1.
typedef struct ReliefWays {
  REAL u, v;        // change of the coordinates
  REAL3 p;          // change of the point in object units, along the surface
  REAL begin, end;  // depths, 0 at the surface and 1 at height 0
  MASK steps;       // one per texel, or per pixel if those are wider
} ReliefWays;

// The paths of directions d (unit) between the depths `begin` and `end`. `along` receives their extent along
// the surface, in the world.
static inline ReliefWays relief_ways(const Scene* scene, __global const MaterialMaps* maps,
                                     const SurfaceInteractions* s, const TexturePoints* at, REAL3 d,
                                     REAL begin, REAL end, MASK lanes, REAL3* along) {
  const REAL3 n = s->ng;
  const REAL rise = dot3(n, d), slant = real_max(fabs(rise), (REAL)(PARALLAX_SLANT));
  const REAL depth = maps->parallax / nonzero(at->scale);
  const REAL length = depth * fabs(end - begin) / slant;
  const REAL3 way = scale3(along3(d, -rise, n), length);
  const REAL area = nonzero(dot3(n, cross3(s->at.dpdu, s->at.dpdv)));
  ReliefWays ways;
  ways.u = dot3(n, cross3(way, s->at.dpdv)) / area;
  ways.v = dot3(n, cross3(s->at.dpdu, way)) / area;
  ways.begin = begin;
  ways.end = end;
  ways.p = way;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(at->instance, &left, &index);
    __global const Instance* instance = scene->instances + index;
    const REAL3 own = multiply3(vectors_of(scene, index, s, way), all3(instance->pattern_scale.xyz));
    ways.p = select3(ways.p, own, mine);
  }
  const REAL texel = maps->height_texels > 0.0f ? at->uv_length / maps->height_texels : (REAL)(0.0f);
  const REAL step = real_max(at->footprint, texel), crossed = length3(way) / nonzero(step);
  const REAL most = (REAL)((float)(maps->height_texels > 0.0f ? PARALLAX_STEPS : PARALLAX_UNKNOWN));
  ways.steps =
      TO_MASK(select(most, PARALLAX_LEAST + real_min(crossed, most - PARALLAX_LEAST), MASK_OF(step > 0.0f)));
  *along = way;
  return ways;
}

// Height above the paths at t.
static inline REAL height_above(const Scene* scene, __global const MaterialMaps* maps,
                                const TexturePoints* at, const ReliefWays* ways, REAL t, MASK lanes) {
  TexturePoints there = *at;
  there.u = fma(t, ways->u, at->u);
  there.v = fma(t, ways->v, at->v);
  there.p = along3(at->p, t, ways->p);
  return map_value(scene, maps, MAP_HEIGHT, &there, lanes).x - 1.0f +
         fma(t, ways->end - ways->begin, ways->begin);
}

// Stages of the search: begin, step until one ends below, bisect that step, and evaluate both its ends.
enum { PARALLAX_BEGIN, PARALLAX_STEP, PARALLAX_HALVE, PARALLAX_BELOW, PARALLAX_ABOVE };

// Where paths from the surface hit the heights: in the first step that ends below them, bisected. Heights are
// looked up in one place, because compilers duplicate a texture's code at each call.
static inline REAL meet_heights(const Scene* scene, __global const MaterialMaps* maps,
                                const TexturePoints* at, const ReliefWays* ways, MASK lanes) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f), inverse = 1.0f / TO_REAL(ways->steps);
  REAL above = zero, below = one, t = zero, high = zero;
  MASK open = lanes;
  int k = 0;
  for (u32 stage = PARALLAX_BEGIN;;) {
    const REAL over = height_above(scene, maps, at, ways, t, stage == PARALLAX_STEP ? open : lanes);
    const MASK under = MASK_OF(over >= 0.0f);
    if (stage == PARALLAX_ABOVE) {
      // Interpolate the heights linearly, unless they have a discontinuity.
      const REAL share = real_clamp(over / nonzero(over - high), zero, one);
      below = select(below, fma(share, below - above, above), MASK_OF(over < 0.0f) & MASK_OF(high > 0.0f));
      break;
    }
    if (stage == PARALLAX_BELOW) high = over;
    if (stage == PARALLAX_BEGIN) {
      open = lanes & ~under;
      below = select(zero, one, open);
    }
    if (stage == PARALLAX_STEP) {
      above = select(above, t, open & ~under);
      below = select(below, t, open & under);
      open &= ~under;
    }
    if (stage == PARALLAX_HALVE) {
      below = select(below, t, under);
      above = select(t, above, under);
    }
    // Choose the next stage.
    ++k;
    if (stage <= PARALLAX_STEP) {
      open &= MASK_OF(ways->steps >= k);
      stage = PARALLAX_STEP;
      t = inverse * (float)k;
      if (k <= PARALLAX_STEPS && any_lane(open)) continue;
      below = real_max(below, above);
      k = 0;
    }
    stage = k < PARALLAX_HALVINGS ? PARALLAX_HALVE : k == PARALLAX_HALVINGS ? PARALLAX_BELOW : PARALLAX_ABOVE;
    t = stage == PARALLAX_HALVE ? 0.5f * (above + below) : stage == PARALLAX_BELOW ? below : above;
  }
  return below;
}

static inline MASK has_parallax(const Scene* scene, const SurfaceInteractions* s, MASK lanes) {
  MASK found = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    const u32 number = scene->materials[index].maps;
    if (number != NO_MAPS && scene->material_maps[number].parallax != 0.0f) found |= mine;
  }
  return found;
}

// Moves the texture inputs of the surfaces of `lanes` to where rays of the directions d hit their heights.
NEVER_INLINE void add_parallax(const Scene* scene, REAL3 d, MASK lanes, SurfaceInteractions* s) {
  const MASK deep = has_parallax(scene, s, lanes & s->entering);
  if (!any_lane(deep)) return;
  const TexturePoints at = texture_points(scene, s, deep);
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  u32 index;
  for (u32 left = lane_bits(deep); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    __global const MaterialMaps* maps = scene->material_maps + scene->materials[index].maps;
    REAL3 along;
    const ReliefWays ways = relief_ways(scene, maps, s, &at, d, zero, one, mine, &along);
    const REAL t = select(zero, meet_heights(scene, maps, &at, &ways, mine), mine);
    s->at.u = fma(t, ways.u, s->at.u);
    s->at.v = fma(t, ways.v, s->at.v);
    s->shift = along3(s->shift, t, select3(all3((float3)(0.0f)), along, mine));
    s->sunk = select(s->sunk, t, mine);
  }
}
#endif
