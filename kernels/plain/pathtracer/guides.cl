// Balls that surfaces without perfect lobes send half of their paths to, evenly over the cone that each takes
// up, because light comes from there that only scattered rays find: through glass. The density is that of
// both halves, so that directions count the same whichever half they come from (the balance heuristic of
// Veach and Guibas 1995 with one sample).
#include "plain/pathtracer/interface.h"

#define GUIDED_PART 0.5f  // of the paths

// Whether the surface sends paths to balls.
static inline bool is_guided(const LobeSet* lobes) {
  bool matte = false;
#define IS_MATTE(feature, name, flags) \
  if (feature) matte = matte || matte_##name(lobes) > 0.0f;
  MATTE_LOBES(IS_MATTE)
  return matte && perfect_share(lobes) <= 0.0f;
}

// The unit direction from p to the ball and 1 - the cosine of half the cone's angle; 0 from within.
static inline float cone_to_guide(UNIFORM float4 ball, float3 p, float3* axis) {
  const float3 way = ball.xyz - p;
  const float square = real_max(dot(way, way), 1e-30f), sine2 = ball.w * ball.w / square;
  *axis = way * (1.0f / real_sqrt(square));
  const float cosine = real_sqrt(real_max(1.0f - sine2, 0.0f));
  return sine2 < 1.0f ? sine2 / (1.0f + cosine) : 0.0f;
}

// The density of wi for directions to the balls; a surface within one keeps the direction, and the density
// `pdf`, of its lobes.
static inline float guide_pdf(UNIFORM const Scene* scene, float3 p, float3 wi, float pdf) {
  float sum = 0.0f;
  for (u32 i = 0; i < scene->info->guide_count; ++i) {
    float3 axis;
    const float span = cone_to_guide(scene->guides[i], p, &axis);
    const float3 chord = wi - axis;  // its square is 2 - 2 cos: exact for narrow cones
    if (span <= 0.0f)
      sum += pdf;
    else if (0.5f * dot(chord, chord) <= span)
      sum += 1.0f / (2.0f * M_PI_F * span);
  }
  return sum / (float)scene->info->guide_count;
}

// The density with which the surface chooses wi, where its lobes choose it with `pdf`.
static inline float guided_pdf(UNIFORM const Scene* scene, const LobeSet* lobes, float3 p, float3 wi,
                               float pdf) {
  if (HAS_GUIDES && is_guided(lobes))
    return fma(pdf, 1.0f - GUIDED_PART, GUIDED_PART * guide_pdf(scene, p, wi, pdf));
  return pdf;
}

// sample_lobes() of which part goes to the balls; its number u->z chooses that too. That many paths go there
// makes each worth no less to roulette: `spread` makes up for it.
HAVING(HAS_GUIDES)
static inline BsdfSample sample_to_guides(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                          float3 p, float3 wo, const Numbers* u, float* spread) {
  const bool guided = is_guided(lobes), aims = guided && u->z < GUIDED_PART;
  const float rest = (u->z - (aims ? 0.0f : GUIDED_PART)) / (aims ? GUIDED_PART : 1.0f - GUIDED_PART);
  BsdfSample sample = sample_lobes(scene, bsdf, lobes, wo, guided ? rest : u->z, u->x, u->y);
  if (aims) {
    const float count = (float)scene->info->guide_count;
    EACH_ALIKE(int, index, (int)real_min(floor(rest * count), count - 1.0f)) {
      float3 axis;
      const float span = cone_to_guide(scene->guides[index], p, &axis), down = u->x * span;
      const float sine = real_sqrt(real_max(down * (2.0f - down), 0.0f));
      if (span > 0.0f) sample.wi = direction_at(axis, 1.0f - down, sine, u->y);
    }
    sample.specular = false;
  }
  if (guided) {
    float alone;
    const float3 value = bsdf_scatter(scene, bsdf, lobes, wo, sample.wi, &alone);
    const float pdf = guided_pdf(scene, lobes, p, sample.wi, alone);
    if (alone > 0.0f) *spread = *spread * pdf / alone;
    sample.weight = pdf > 0.0f ? value * (1.0f / (M_PI_F * pdf)) : (float3)(0.0f);
    sample.pdf = pdf;
  }
  return sample;
}
static inline BsdfSample sample_guided(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                       float3 p, float3 wo, const Numbers* u, float* spread) {
  if (HAS_GUIDES)
    return sample_to_guides(scene, bsdf, lobes, p, wo, u, spread);
  else
    return sample_lobes(scene, bsdf, lobes, wo, u->z, u->x, u->y);
}
