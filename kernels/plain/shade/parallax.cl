// Parallax: rays continue below a surface until they hit its height map, and heights occlude light (Brawley
// and Tatarchuk 2004, "Parallax Occlusion Mapping: Self-Shadowing, Perspective-Correct Bump Mapping Using
// Reverse Height Map Tracing"). The surface itself is at height 1.
#include "plain/shade/maps.cl"

#define PARALLAX_SLANT 0.05f  // minimum sine of rays along the surface
#define PARALLAX_STEPS 128    // maximum
#define PARALLAX_LEAST 8.0f   // minimum, plus one for each texel crossed
#define PARALLAX_UNKNOWN 48   // for heights without texels
#define PARALLAX_HALVINGS 6   // bisections of the step in which a ray hits the heights

HAVING(HAS_PARALLAX);

// A straight path through the layer of heights, from 0 to 1.
typedef struct ReliefWay {
  float u, v;        // change of the coordinates
  float3 p;          // change of the point in object units, along the surface
  float begin, end;  // depths, 0 at the surface and 1 at height 0
  float3 along;      // its extent along the surface, in the world
  int steps;         // one per texel, or per pixel if those are wider
} ReliefWay;

// The path of direction d (unit) between the depths `begin` and `end`.
static inline ReliefWay relief_ways(UNIFORM const Scene* scene, UNIFORM __global const MaterialMaps* maps,
                                    const SurfaceInteraction* s, const TexturePoint* at, float3 d,
                                    float begin, float end) {
  const float3 n = s->ng;
  const float rise = dot(n, d), slant = real_max(fabs(rise), PARALLAX_SLANT);
  const float depth = maps->parallax / nonzero(at->scale);
  const float3 way = along(d, -rise, n) * (depth * fabs(end - begin) / slant);
  const float area = nonzero(dot(n, cross(s->at.dpdu, s->at.dpdv)));
  ReliefWay ways;
  ways.u = dot(n, cross(way, s->at.dpdv)) / area;
  ways.v = dot(n, cross(s->at.dpdu, way)) / area;
  ways.begin = begin;
  ways.end = end;
  ways.along = way;
  ways.p = way;
  EACH_ALIKE(u32, index, (u32)at->instance)
  ways.p = vectors_at(scene, index, way, time_of(s)) * scene->instances[index].pattern_scale.xyz;
  const float texel = maps->height_texels > 0.0f ? at->uv_length / maps->height_texels : 0.0f;
  const float step = real_max(at->footprint, texel), crossed = length(way) / nonzero(step);
  const float most = (float)(maps->height_texels > 0.0f ? PARALLAX_STEPS : PARALLAX_UNKNOWN);
  ways.steps = (int)(step > 0.0f ? PARALLAX_LEAST + real_min(crossed, most - PARALLAX_LEAST) : most);
  return ways;
}

// Height above the path at t.
static inline float height_above(UNIFORM const Scene* scene, UNIFORM __global const MaterialMaps* maps,
                                 const TexturePoint* at, const ReliefWay* ways, float t) {
  TexturePoint there = *at;
  there.u = fma(t, ways->u, at->u);
  there.v = fma(t, ways->v, at->v);
  there.p = along(at->p, t, ways->p);
  return map_value(scene, maps, MAP_HEIGHT, &there).x - 1.0f + fma(t, ways->end - ways->begin, ways->begin);
}

// Stages of the search: begin, step until one ends below, bisect that step, and evaluate both its ends.
#define PARALLAX_BEGIN 0
#define PARALLAX_STEP 1
#define PARALLAX_HALVE 2
#define PARALLAX_BELOW 3
#define PARALLAX_ABOVE 4

// Where a path from the surface hits the heights: in the first step that ends below them, bisected. Heights
// are looked up in one place, because compilers duplicate a texture's code at each call.
static inline float meet_heights(UNIFORM const Scene* scene, UNIFORM __global const MaterialMaps* maps,
                                 const TexturePoint* at, const ReliefWay* ways) {
  const float inverse = 1.0f / (float)ways->steps;
  float above = 0.0f, below = 1.0f, t = 0.0f, high = 0.0f;
  bool open = true;
  int k = 0;
  for (int stage = PARALLAX_BEGIN; true;) {
    const bool begins = stage == PARALLAX_BEGIN, steps = stage == PARALLAX_STEP,
               halves = stage == PARALLAX_HALVE, is_below = stage == PARALLAX_BELOW,
               is_above = stage == PARALLAX_ABOVE;
    float over = 0.0f;
    if (!steps || open) over = height_above(scene, maps, at, ways, t);
    if (is_above) {
      // Interpolate the heights linearly, unless they have a discontinuity.
      const float share = real_clamp(over / nonzero(over - high), 0.0f, 1.0f);
      if (over < 0.0f && high > 0.0f) below = fma(share, below - above, above);
      break;
    }
    const bool under = over >= 0.0f;
    if (is_below) high = over;
    if (begins) {
      open = !under;
      below = open ? 1.0f : 0.0f;
    }
    if (steps && open) {
      if (under)
        below = t;
      else
        above = t;
      open = !under;
    }
    if (halves) {
      below = under ? t : below;
      above = under ? above : t;
    }
    // Choose the next stage.
    ++k;
    if (begins || steps) {
      open = open && ways->steps >= k;
      stage = PARALLAX_STEP;
      t = inverse * (float)k;
      if (k <= PARALLAX_STEPS && any(open)) continue;
      below = real_max(below, above);
      k = 0;
    }
    stage = k < PARALLAX_HALVINGS ? PARALLAX_HALVE : k == PARALLAX_HALVINGS ? PARALLAX_BELOW : PARALLAX_ABOVE;
    t = stage == PARALLAX_HALVE ? 0.5f * (above + below) : stage == PARALLAX_BELOW ? below : above;
  }
  return below;
}

// The depth of the material's relief, in its object's units; 0 without a relief.
static inline float parallax_of(UNIFORM const Scene* scene, int material) {
  float depth = 0.0f;
  EACH_ALIKE(u32, index, (u32)material) {
    const u32 number = scene->materials[index].maps;
    if (number != NO_MAPS) depth = scene->material_maps[number].parallax;
  }
  return depth;
}
static inline bool has_parallax(UNIFORM const Scene* scene, int material) {
  return parallax_of(scene, material) != 0.0f;
}

// Moves the texture inputs of the surface to where a ray of the direction d hits its heights.
ENTRY static void add_parallax(UNIFORM const Scene* scene, float3 d, SurfaceInteraction* s) {
  if (!(s->entering && has_parallax(scene, s->material))) return;
  const TexturePoint at = texture_points(scene, s);
  EACH_ALIKE(u32, index, (u32)s->material) {
    __global const MaterialMaps* maps = scene->material_maps + scene->materials[index].maps;
    const ReliefWay ways = relief_ways(scene, maps, s, &at, d, 0.0f, 1.0f);
    s->sunk = meet_heights(scene, maps, &at, &ways);
    s->at.u = fma(s->sunk, ways.u, s->at.u);
    s->at.v = fma(s->sunk, ways.v, s->at.v);
    s->shift = along(s->shift, s->sunk, ways.along);
  }
}
