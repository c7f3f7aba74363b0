// Shadows of reliefs below surfaces: on themselves (Brawley and Tatarchuk 2004, as in shade/parallax.cl), and
// on what stands among them.
#include "plain/shade/meet_interfaces.cl"

#define PARALLAX_BIAS 0.01f  // of the depth: what heights must rise above a way to hold light off
#define RELIEF_START 8.0f    // offsets above a relief at which a way from the light begins

HAVING(HAS_PARALLAX);

// The part of light from wi that reaches the surface past its own heights: 1 or 0.
ENTRY static float relief_visibility(UNIFORM const Scene* scene, const SurfaceInteraction* s, float3 wi) {
  if (!(s->sunk > 0.0f && dot(s->ng, wi) > 0.0f)) return 1.0f;
  const TexturePoint at = texture_points(scene, s);
  bool dark = false;
  EACH_ALIKE(u32, index, (u32)s->material) {
    __global const MaterialMaps* maps = scene->material_maps + scene->materials[index].maps;
    const ReliefWay way = relief_ways(scene, maps, s, &at, wi, s->sunk, 0.0f);
    const float inverse = 1.0f / (float)way.steps;
    for (int k = 1; k < PARALLAX_STEPS; ++k) {
      if (dark || way.steps <= k) break;
      dark = height_above(scene, maps, &at, &way, inverse * (float)k) > PARALLAX_BIAS;
    }
  }
  return dark ? 0.0f : 1.0f;
}

// The part of light from wi that reaches a surface in the relief of another past the heights there: 1 or 0.
// A ray from where the light enters the relief finds it and its heights. What lets light through throws no
// shadow on what stands in it.
static float walls_visibility(UNIFORM const Scene* scene, const SceneRay* ray, const SurfaceInteraction* s,
                              float3 wi, UNIFORM u32* counts) {
  const float rise = dot(s->top, wi);
  if (!(s->below > 0.0f && rise > 0.0f)) return 1.0f;
  float way;
  const float3 leaves = leave_relief(s, wi, &way);
  const float before = RELIEF_START * s->offset / real_max(rise, PARALLAX_SLANT);
  SceneRay from_light = *ray;
  from_light.o = along(leaves, before, wi);
  from_light.d = -wi;
  from_light.t_min = 0.0f;
  from_light.t_max = 2.0f * before;
  SurfaceHit hit;
  nearest_hits(scene, &from_light, false, &hit, counts);
  if (!hit_anything(&hit)) return 1.0f;
  const Face face = hit_faces(scene, from_light.d, &hit);
  if (!face.entering || (face.flags & (int)MATERIAL_TRANSMITS) != 0) return 1.0f;
  if (!has_parallax(scene, face.material)) return 1.0f;
  SurfaceInteraction top;
  interact(scene, from_light.o, from_light.d, &hit, &face, &top);
  top.footprint = s->footprint;
  add_parallax(scene, from_light.d, &top);
  const float depth = relief_depth(scene, top.material, top.instance);
  const float reached = (top.sunk + PARALLAX_BIAS) * way_through(top.ng, wi, depth);
  return reached < way ? 0.0f : 1.0f;
}
