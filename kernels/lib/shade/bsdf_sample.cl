// Random directions for surfaces, for integrators that follow one ray on: one of the four terms is chosen
// (perfect reflection and transmission, diffuse, highlight), then a direction of it. A surface a lane.
#ifndef SUNDOG_LIB_BSDF_SAMPLE_CL
#define SUNDOG_LIB_BSDF_SAMPLE_CL
#include "lib/core/directions.cl"
#include "lib/shade/bsdf.cl"

typedef struct BsdfSamples {
  REAL3 wi;       // unit
  REAL3 weight;   // BSDF times cosine over density: what light from wi counts for
  REAL density;   // of wi, per steradian; of a specular sample the probability of its term
  MASK specular;  // perfect reflection or transmission: bsdf_eval() does not know it
} BsdfSamples;

// Density of directions whose cosine c to an axis is distributed as c^e, on its hemisphere.
static inline REAL lobe_density(REAL c, REAL e) {
  const REAL value = (e + 1.0f) * (0.5f / M_PI_F) * pow(real_max(c, (REAL)(0.0f)), e);
  return select((REAL)(0.0f), value, MASK_OF(c > 0.0f));
}

// Densities of the diffuse and of the highlight's term for the direction wi.
static inline REAL diffuse_density(const Bsdfs* bsdf, REAL3 wi) {
  return real_max(dot3(bsdf->ns, wi), (REAL)(0.0f)) * (1.0f / M_PI_F);
}
static inline REAL highlight_density(const Bsdfs* bsdf, REAL3 wo, REAL3 wi, MASK blinn, REAL exponent) {
  const REAL3 h = safe_unit3(add3(wi, wo)), mirrored = reflect_direction(negate3(wo), bsdf->ns);
  const REAL of_half =
      lobe_density(dot3(bsdf->ns, h), exponent) / (4.0f * real_max(dot3(wo, h), (REAL)(1e-6f)));
  return select(lobe_density(dot3(mirrored, wi), exponent), of_half, blinn);
}

// The greatest part of ks and its exponent of the materials of `lanes`.
static inline void find_highlights(const Scene* scene, const Bsdfs* bsdf, MASK lanes, REAL* size,
                                   REAL* exponent) {
#if HAS_MAPS
  *size = greatest3(bsdf->specular);
  *exponent = bsdf->exponent;
  return;
#endif
  u32 index;
  while (any_lane(lanes)) {
    const MASK mine = take_alike(bsdf->material, &lanes, &index);
    const float4 specular = scene->materials[index].specular;
    *size = select(*size, (REAL)(fmax(specular.x, fmax(specular.y, specular.z))), mine);
    *exponent = select(*exponent, (REAL)(specular.w), mine);
  }
}

// A direction for each surface of `lanes`, by the numbers u in [0, 1): `u_term` chooses the term, u_x and u_y
// the direction. The weights' mean is the light that the surface returns of a white surrounding. A weight of
// 0 ends the path.
static inline BsdfSamples bsdf_sample(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, REAL u_term, REAL u_x,
                                      REAL u_y, MASK lanes) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const SpecularSplits split = bsdf_specular(scene, bsdf, wo, lanes);
  const MASK blinn = MASK_OF((bsdf->flags & (int)MATERIAL_BLINN) != 0);
  REAL shine = zero, exponent = zero;
  find_highlights(scene, bsdf, lanes, &shine, &exponent);
  // Shares of the terms, as large as what they may return.
  const REAL reflects = greatest3(split.kr), transmits = greatest3(split.kt);
  const REAL scatters = greatest3(bsdf->diffuse), all = reflects + transmits + scatters + shine;
  const REAL at = u_term * all;
  const MASK mirror = MASK_OF(at < reflects), through = ~mirror & MASK_OF(at < reflects + transmits);
  const MASK matte = ~mirror & ~through & MASK_OF(at < reflects + transmits + scatters);
  const REAL lobe = pow(real_max(u_x, (REAL)(1e-30f)), 1.0f / (exponent + 1.0f));
  const REAL3 mirrored = reflected_direction(bsdf, wo), half_vector = direction_about(bsdf->ns, lobe, u_y);
  const REAL3 glossy = select3(direction_about(reflect_direction(negate3(wo), bsdf->ns), lobe, u_y),
                               subtract3(scale3(half_vector, 2.0f * dot3(half_vector, wo)), wo), blinn);
  BsdfSamples sample;
  sample.specular = mirror | through;
  sample.wi = select3(glossy, direction_about(bsdf->ns, real_sqrt(u_x), u_y), matte);
  const REAL mixed = (scatters * diffuse_density(bsdf, sample.wi) +
                      shine * highlight_density(bsdf, wo, sample.wi, blinn, exponent)) /
                     all;
  const MASK above = MASK_OF(dot3(bsdf->ns, sample.wi) > 0.0f) & MASK_OF(dot3(bsdf->ng, sample.wi) > 0.0f) &
                     MASK_OF(mixed > 0.0f);
  const REAL3 value = bsdf_eval(scene, bsdf, wo, sample.wi, lanes);
  const REAL3 scattered = scale3(value, 1.0f / (M_PI_F * select(one, mixed, above)));
  sample.weight = select3(all3((float3)(0.0f)), scattered, above);
  sample.density = mixed;
  sample.wi = select3(sample.wi, mirrored, mirror);
  sample.wi = select3(sample.wi, transmitted_direction(bsdf, &split, wo), through);
  const REAL chosen = select(transmits, reflects, mirror) / all;
  const REAL3 part = select3(split.kt, split.kr, mirror);
  sample.density = select(sample.density, chosen, sample.specular);
  sample.weight =
      select3(sample.weight, scale3(part, 1.0f / select(one, chosen, sample.specular)), sample.specular);
  const MASK black = MASK_OF(all <= 0.0f);
  sample.weight = select3(sample.weight, all3((float3)(0.0f)), black);
  sample.density = select(sample.density, zero, black);
  return sample;
}

#endif
