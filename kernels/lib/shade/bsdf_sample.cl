// Samples directions for integrators that continue with one ray: chooses a term (perfect reflection and
// transmission, microfacets, diffuse, highlight), then a direction. One surface per lane.
#ifndef SUNDOG_LIB_BSDF_SAMPLE_CL
#define SUNDOG_LIB_BSDF_SAMPLE_CL
#include "lib/core/directions.cl"
#include "lib/shade/bsdf.cl"
#include "lib/shade/layer_sample.cl"
#include "lib/shade/microfacets.cl"

typedef struct BsdfSamples {
  REAL3 wi;       // unit
  REAL3 weight;   // BSDF times cosine over pdf: factor on light from wi
  REAL pdf;       // of wi, per steradian; of a specular sample the probability of its term
  MASK specular;  // perfect reflection or transmission, which bsdf_scatter() excludes
} BsdfSamples;

// The terms of surfaces for a viewer, and their shares of samples, proportional to their maximum reflectance.
typedef struct Lobes {
  SpecularSplits split;
  REAL mirror, through, facets, matte, glossy, all;
  REAL exponent;  // of the highlight
  MASK blinn;
#if HAS_ROUGH
  Microfacets rough;
#endif
#if HAS_LAYERS
  LayerShares layers;
  REAL layered;  // their sum
#endif
} Lobes;

// Density of directions on the hemisphere of an axis, proportional to c^e for the cosine c.
static inline REAL lobe_pdf(REAL c, REAL e) {
  const REAL value = (e + 1.0f) * (0.5f / M_PI_F) * pow(real_max(c, (REAL)(0.0f)), e);
  return select((REAL)(0.0f), value, MASK_OF(c > 0.0f));
}

// Densities of the diffuse and highlight terms for the direction wi.
static inline REAL diffuse_pdf(const Bsdfs* bsdf, REAL3 wi) {
  return real_max(dot3(bsdf->ns, wi), (REAL)(0.0f)) * (1.0f / M_PI_F);
}
static inline REAL highlight_pdf(const Bsdfs* bsdf, REAL3 wo, REAL3 wi, MASK blinn, REAL exponent) {
  const REAL3 h = safe_unit3(add3(wi, wo)), mirrored = reflect_direction(negate3(wo), bsdf->ns);
  const REAL of_half = lobe_pdf(dot3(bsdf->ns, h), exponent) / (4.0f * real_max(dot3(wo, h), (REAL)(1e-6f)));
  return select(lobe_pdf(dot3(mirrored, wi), exponent), of_half, blinn);
}

// The largest component of ks, and the exponent, of the materials of `lanes`.
#if HAS_MAPS
static inline void find_highlights(const Scene* scene, const Bsdfs* bsdf, MASK lanes, REAL* size,
                                   REAL* exponent) {
  *size = greatest3(bsdf->specular);
  *exponent = bsdf->exponent;
}
#else
static inline void find_highlights(const Scene* scene, const Bsdfs* bsdf, MASK lanes, REAL* size,
                                   REAL* exponent) {
  u32 index;
  for (u32 left = lane_bits(of_kind(bsdf, MATERIAL_SHINES, lanes)); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    const float4 specular = scene->materials[index].specular;
    *size = select(*size, (REAL)(fmax(specular.x, fmax(specular.y, specular.z))), mine);
    *exponent = select(*exponent, (REAL)(specular.w), mine);
  }
}
#endif

// Changes of lobes by facets; light scattered by facets, and the pdf of its directions, added to those of the
// others; directions of facet samples of `lanes`, by the number `u_term` in [0, lobes->facets). Returns the
// samples that go through the surface.
#if HAS_ROUGH
static inline void add_facets(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, MASK lanes, Lobes* lobes) {
  const REAL zero = (REAL)(0.0f);
  lobes->rough = make_microfacets(scene, bsdf, &lobes->split, wo, lanes);
  // Unbent and unfrosted transmission goes straight through, whatever the facets.
  const MASK sending = transmitting_facets(&lobes->rough);
  const REAL of_facets = lobes->mirror + select(zero, lobes->through, sending);
  lobes->facets = select(zero, of_facets, lobes->rough.rough);
  lobes->mirror = select(lobes->mirror, zero, lobes->rough.rough);
  lobes->through = select(lobes->through, zero, sending);
}
static inline void add_facet_scatter(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                     REAL3 wi, MASK lanes, REAL3* value, REAL* chosen) {
  if (!any_lane(lanes & lobes->rough.rough)) return;
  REAL of_facets;
  *value =
      add3(*value, facet_scatter(scene, bsdf, &lobes->rough, lobes->split.eta, wo, wi, lanes, &of_facets));
  *chosen += lobes->facets * of_facets;
}
static inline MASK send_by_facets(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                  REAL u_term, REAL u_x, REAL u_y, MASK lanes, REAL3* wi) {
  if (!any_lane(lanes)) return NO_LANES;
  const REAL u_side = u_term / select((REAL)(1.0f), lobes->facets, lanes);
  MASK through;
  *wi =
      select3(*wi, facet_direction(scene, bsdf, &lobes->rough, wo, u_side, u_x, u_y, lanes, &through), lanes);
  return lanes & through;
}
#else
static inline void add_facets(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, MASK lanes, Lobes* lobes) {}
static inline void add_facet_scatter(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                     REAL3 wi, MASK lanes, REAL3* value, REAL* chosen) {}
static inline MASK send_by_facets(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                  REAL u_term, REAL u_x, REAL u_y, MASK lanes, REAL3* wi) {
  return NO_LANES;
}
#endif

// Likewise for layered materials, whose layers also attenuate everything below. Their terms follow the
// facets: past_layers_of() is the end of those that begin at `at`.
#if HAS_LAYERS
static inline void start_layers(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, MASK lanes, Lobes* lobes) {
  lobes->layers = make_shares(scene, bsdf, wo, lanes, &lobes->split);
  lobes->layered = sum_of_shares(&lobes->layers);
}
static inline REAL past_layers_of(const Lobes* lobes, REAL at) { return at + lobes->layered; }
static inline void add_layer_scatter(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                     REAL3 wi, MASK lanes, REAL3* value, REAL* chosen) {
  layer_scatter(scene, bsdf, &lobes->layers, wo, wi, lanes, value, chosen);
}
static inline void send_by_layers(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                  REAL at, REAL u_x, REAL u_y, MASK lanes, REAL3* wi) {
  const MASK mine = lanes & MASK_OF(at >= 0.0f) & MASK_OF(at < lobes->layered);
  if (!any_lane(mine)) return;
  *wi = select3(*wi, layer_direction(scene, bsdf, &lobes->layers, wo, at, u_x, u_y, mine), mine);
}
#else
static inline void start_layers(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, MASK lanes, Lobes* lobes) {}
static inline REAL past_layers_of(const Lobes* lobes, REAL at) { return at; }
static inline void add_layer_scatter(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                     REAL3 wi, MASK lanes, REAL3* value, REAL* chosen) {}
static inline void send_by_layers(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                  REAL at, REAL u_x, REAL u_y, MASK lanes, REAL3* wi) {}
#endif

// The lobes of the surfaces of `lanes`, seen from wo.
static inline Lobes make_lobes(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, MASK lanes) {
  const REAL zero = (REAL)(0.0f);
  Lobes lobes;
  lobes.split = bsdf_specular(scene, bsdf, wo, lanes);
  lobes.blinn = MASK_OF((bsdf->flags & (int)MATERIAL_BLINN) != 0);
  lobes.glossy = lobes.exponent = zero;
  find_highlights(scene, bsdf, lanes, &lobes.glossy, &lobes.exponent);
  start_layers(scene, bsdf, wo, lanes, &lobes);
  lobes.mirror = greatest3(lobes.split.kr);
  lobes.through = greatest3(lobes.split.kt);
  lobes.facets = zero;
  lobes.matte = greatest3(bsdf->diffuse);
  lobes.all = past_layers_of(&lobes, lobes.mirror + lobes.through + lobes.matte + lobes.glossy);
  add_facets(scene, bsdf, wo, lanes, &lobes);
  return lobes;
}

// pi times the BSDF times the cosine of all imperfect terms, for directions wi on either side of the surfaces
// of `lanes`; `pdf`: the density with which sample_lobes() chooses them.
static inline REAL3 bsdf_scatter(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                 REAL3 wi, MASK lanes, REAL* pdf) {
  const REAL zero = (REAL)(0.0f);
  const MASK above = lanes & MASK_OF(dot3(bsdf->ns, wi) > 0.0f) & MASK_OF(dot3(bsdf->ng, wi) > 0.0f);
  REAL chosen = lobes->matte * diffuse_pdf(bsdf, wi);
  if (any_lane(above & MASK_OF(lobes->glossy > 0.0f)))
    chosen += lobes->glossy * highlight_pdf(bsdf, wo, wi, lobes->blinn, lobes->exponent);
  chosen = select(zero, chosen, above);
  REAL3 value = select3(all3((float3)(0.0f)), bsdf_eval(scene, bsdf, wo, wi, above), above);
  add_facet_scatter(scene, bsdf, lobes, wo, wi, lanes, &value, &chosen);
  add_layer_scatter(scene, bsdf, lobes, wo, wi, lanes, &value, &chosen);
  *pdf = chosen / select((REAL)(1.0f), lobes->all, MASK_OF(lobes->all > 0.0f));
  return value;
}

// Directions of the highlight, or of the diffuse term where `matte`.
static inline REAL3 local_direction(const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo, REAL u_x, REAL u_y,
                                    MASK matte) {
  const REAL3 diffuse = direction_about(bsdf->ns, real_sqrt(u_x), u_y);
  if (!any_lane(~matte)) return diffuse;
  const REAL cosine = pow(real_max(u_x, (REAL)(1e-30f)), 1.0f / (lobes->exponent + 1.0f));
  const REAL3 half_vector = direction_about(bsdf->ns, cosine, u_y);
  const REAL3 glossy =
      select3(direction_about(reflect_direction(negate3(wo), bsdf->ns), cosine, u_y),
              subtract3(scale3(half_vector, 2.0f * dot3(half_vector, wo)), wo), lobes->blinn);
  return select3(glossy, diffuse, matte);
}

// Samples of `specular` are reflected where `mirror`, else transmitted.
static inline void send_perfectly(const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo, MASK mirror, MASK specular,
                                  BsdfSamples* sample) {
  const REAL one = (REAL)(1.0f);
  sample->wi = select3(sample->wi, reflected_direction(bsdf, wo), mirror);
  sample->wi = select3(sample->wi, transmitted_direction(bsdf, &lobes->split, wo), specular & ~mirror);
  const REAL chosen = select(lobes->through, lobes->mirror, mirror) / select(one, lobes->all, specular);
  const REAL3 part = select3(lobes->split.kt, lobes->split.kr, mirror);
  sample->pdf = select(sample->pdf, chosen, specular);
  sample->weight = select3(sample->weight, scale3(part, 1.0f / select(one, chosen, specular)), specular);
}

// Samples a direction for each surface of `lanes` with numbers in [0, 1): `u_term` chooses the term, u_x and
// u_y the direction. The mean weight is the surface's reflectance of a white surrounding. A weight of 0 ends
// the path.
static inline BsdfSamples sample_lobes(const Scene* scene, const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo,
                                       REAL u_term, REAL u_x, REAL u_y, MASK lanes) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const REAL perfect = lobes->mirror + lobes->through, at = u_term * lobes->all;
  const MASK mirror = MASK_OF(at < lobes->mirror), specular = MASK_OF(at < perfect);
  const REAL scattered = perfect + lobes->facets;
  const MASK black = MASK_OF(lobes->all <= 0.0f);
  const MASK matte = black | MASK_OF(at < past_layers_of(lobes, scattered) + lobes->matte);
  BsdfSamples sample;
  sample.specular = specular;
  sample.wi = local_direction(bsdf, lobes, wo, u_x, u_y, matte | ~lanes);
  // Lanes whose term transmits; a direction on the wrong side of its term is rejected.
  const MASK facets = lanes & ~specular & MASK_OF(at < scattered);
  const MASK below = send_by_facets(scene, bsdf, lobes, wo, at - perfect, u_x, u_y, facets, &sample.wi);
  send_by_layers(scene, bsdf, lobes, wo, at - scattered, u_x, u_y, lanes & ~specular, &sample.wi);
  const REAL3 value = bsdf_scatter(scene, bsdf, lobes, wo, sample.wi, lanes & ~specular, &sample.pdf);
  const MASK strays = below ^ MASK_OF(dot3(bsdf->ns, sample.wi) <= 0.0f);
  sample.pdf = select(sample.pdf, zero, strays);
  const MASK some = MASK_OF(sample.pdf > 0.0f);
  sample.weight =
      select3(all3((float3)(0.0f)), scale3(value, 1.0f / (M_PI_F * select(one, sample.pdf, some))), some);
  if (any_lane(lanes & specular)) send_perfectly(bsdf, lobes, wo, mirror, specular, &sample);
  sample.weight = select3(sample.weight, all3((float3)(0.0f)), black);
  sample.pdf = select(sample.pdf, zero, black);
  return sample;
}

// The specular samples of sample_lobes(); the others' weights are 0.
static inline BsdfSamples sample_perfect_lobes(const Bsdfs* bsdf, const Lobes* lobes, REAL3 wo, REAL u_term,
                                               MASK lanes) {
  const REAL at = u_term * lobes->all;
  BsdfSamples sample;
  sample.specular = MASK_OF(at < lobes->mirror + lobes->through);
  sample.wi = sample.weight = all3((float3)(0.0f));
  sample.pdf = (REAL)(0.0f);
  if (any_lane(lanes & sample.specular))
    send_perfectly(bsdf, lobes, wo, MASK_OF(at < lobes->mirror), sample.specular, &sample);
  return sample;
}

// The share of lobes that are not perfectly specular.
static inline REAL scattered_share(const Lobes* lobes) {
  return past_layers_of(lobes, lobes->matte + lobes->glossy + lobes->facets);
}
static inline MASK scatters(const Lobes* lobes) { return MASK_OF(scattered_share(lobes) > 0.0f); }

static inline BsdfSamples bsdf_sample(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, REAL u_term, REAL u_x,
                                      REAL u_y, MASK lanes) {
  const Lobes lobes = make_lobes(scene, bsdf, wo, lanes);
  return sample_lobes(scene, bsdf, &lobes, wo, u_term, u_x, u_y, lanes);
}

#endif
