// Balls that surfaces without perfect lobes send half of their paths to, evenly over the cone that each takes
// up, because light comes from there that only scattered rays find: through glass. The density is that of
// both halves, so that directions count the same whichever half they come from (the balance heuristic of
// Veach and Guibas 1995 with one sample). A surface a lane.
#ifndef SUNDOG_LIB_GUIDES_CL
#define SUNDOG_LIB_GUIDES_CL
#include "lib/core/directions.cl"
#include "lib/shade/bsdf_sample.cl"

#if HAS_GUIDES
#define GUIDED_PART 0.5f  // of the paths

// The surfaces of `lanes` that send paths to balls.
static inline MASK guided_surfaces(const Lobes* lobes, MASK lanes) {
  return lanes & (MASK_OF(lobes->matte > 0.0f) | matte_layers(lobes)) &
         MASK_OF(lobes->mirror + lobes->through <= 0.0f);
}

// The unit direction from p to the ball and 1 - the cosine of half the cone's angle; 0 from within.
static inline REAL cone_to_guide(float4 ball, REAL3 p, REAL3* axis) {
  const REAL3 way = subtract3(all3(ball.xyz), p);
  const REAL square = real_max(dot3(way, way), (REAL)(1e-30f));
  const REAL sine2 = ball.w * ball.w / square;
  *axis = scale3(way, 1.0f / real_sqrt(square));
  const REAL cosine = real_sqrt(real_max(1.0f - sine2, (REAL)(0.0f)));
  return select((REAL)(0.0f), sine2 / (1.0f + cosine), MASK_OF(sine2 < 1.0f));
}

// The density of wi for directions to the balls.
static inline REAL guide_pdf(const Scene* scene, REAL3 p, REAL3 wi) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  REAL sum = zero;
  for (u32 i = 0; i < scene->info->guide_count; ++i) {
    REAL3 axis;
    const REAL span = cone_to_guide(scene->guides[i], p, &axis);
    const REAL3 chord = subtract3(wi, axis);  // its square is 2 - 2 cos: exact for narrow cones
    const MASK inside = MASK_OF(span > 0.0f) & MASK_OF(0.5f * dot3(chord, chord) <= span);
    const REAL pdf = 1.0f / (2.0f * M_PI_F * select(one, span, inside));
    sum += select(zero, pdf, inside);
  }
  return sum / (float)scene->info->guide_count;
}

// The density with which the surfaces of `lanes` choose wi, where their lobes choose it with `density`.
static inline REAL guided_pdf(const Scene* scene, const Lobes* lobes, REAL3 p, REAL3 wi, REAL pdf,
                              MASK lanes) {
  const MASK guided = guided_surfaces(lobes, lanes);
  if (!any_lane(guided)) return pdf;
  const REAL mixed = fma(pdf, (REAL)(1.0f - GUIDED_PART), GUIDED_PART * guide_pdf(scene, p, wi));
  return select(pdf, mixed, guided);
}

// sample_lobes() of which part goes to the balls; its number u_term chooses that too. That many paths go
// there makes each worth no less to roulette: `spread` makes up for it.
static inline BsdfSamples sample_guided(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 p,
                                        REAL3 wo, REAL u_term, REAL u_x, REAL u_y, MASK lanes, REAL* spread) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const MASK guided = guided_surfaces(lobes, lanes), aims = guided & MASK_OF(u_term < GUIDED_PART);
  const REAL part = select(zero, (REAL)(GUIDED_PART), ~aims);
  const REAL rest = (u_term - part) / select((REAL)(1.0f - GUIDED_PART), (REAL)(GUIDED_PART), aims);
  BsdfSamples sample =
      sample_lobes(scene, bsdf, lobes, wo, select(u_term, rest, guided), u_x, u_y, lanes & ~aims);
  if (!any_lane(guided)) return sample;
  if (any_lane(aims)) {
    const REAL count = (REAL)((float)scene->info->guide_count);
    const MASK chosen = TO_MASK(real_min(floor(rest * count), count - 1.0f));
    u32 index;
    for (u32 left = lane_bits(aims); left;) {
      const MASK mine = take_alike(chosen, &left, &index);
      REAL3 axis;
      const REAL down = u_x * cone_to_guide(scene->guides[index], p, &axis);
      const REAL sine = real_sqrt(real_max(down * (2.0f - down), zero));
      sample.wi = select3(sample.wi, direction_at(axis, 1.0f - down, sine, u_y), mine);
    }
    sample.specular &= ~aims;
  }
  REAL pdf;
  const REAL3 value = bsdf_scatter(scene, bsdf, lobes, wo, sample.wi, guided, &pdf);
  const REAL alone = pdf;
  pdf = guided_pdf(scene, lobes, p, sample.wi, pdf, guided);
  const MASK some = MASK_OF(pdf > 0.0f), either = guided & MASK_OF(alone > 0.0f);
  *spread = select(*spread, *spread * pdf / select(one, alone, either), either);
  const REAL3 weight = scale3(value, 1.0f / (M_PI_F * select(one, pdf, some)));
  sample.weight = select3(sample.weight, select3(all3((float3)(0.0f)), weight, some), guided);
  sample.pdf = select(sample.pdf, pdf, guided);
  return sample;
}

#else
static inline REAL guided_pdf(const Scene* scene, const Lobes* lobes, REAL3 p, REAL3 wi, REAL pdf,
                              MASK lanes) {
  return pdf;
}
static inline BsdfSamples sample_guided(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 p,
                                        REAL3 wo, REAL u_term, REAL u_x, REAL u_y, MASK lanes, REAL* spread) {
  return sample_lobes(scene, bsdf, lobes, wo, u_term, u_x, u_y, lanes);
}
#endif

#endif
