// Layered materials (shared/layers.h): the light that fuzz and coat transmit is the minimum over both
// directions, which is reciprocal and conserves energy: with a layer's transmission T(w) for the direction w,
// its own light is 1 - T(wo) and that from below at most T(wo). The matte ground uses T(wo) T(wi) over a
// constant instead (Kelemen and Szirmay-Kalos 2001), which is exact for it. One surface per lane; the lanes
// of a call have one material.
#ifndef SUNDOG_LIB_LAYERS_CL
#define SUNDOG_LIB_LAYERS_CL
#include "lib/core/directions.cl"
#include "lib/shade/bsdf.cl"
#include "lib/shade/layer_base.cl"

#if HAS_LAYERS
// The shares of samples of the lobes.
typedef struct LayerShares {
  REAL fuzz, coat, shine, matte;
#if HAS_CAUSTICS
  REAL least;  // narrower facets are excluded; 0: none
#endif
} LayerShares;

// 0 if facets of these widths are excluded, else 1.
#if HAS_CAUSTICS
static inline REAL if_wide(const LayerShares* shares, REAL alpha_x, REAL alpha_y) {
  return select((REAL)(1.0f), (REAL)(0.0f), MASK_OF(alpha_x * alpha_y < shares->least * shares->least));
}
static inline void leave_nothing_out(LayerShares* shares) { shares->least = (REAL)(0.0f); }
#else
static inline void leave_nothing_out(LayerShares* shares) {}
static inline REAL if_wide(const LayerShares* shares, REAL alpha_x, REAL alpha_y) { return (REAL)(1.0f); }
#endif

static inline REAL3 into_frame(const Bsdfs* bsdf, REAL3 w) {
  return real3(dot3(w, bsdf->tangent), dot3(w, bsdf->bitangent), dot3(w, bsdf->ns));
}
static inline REAL3 out_of_frame(const Bsdfs* bsdf, REAL3 w) {
  return along3(along3(scale3(bsdf->tangent, w.x), w.y, bsdf->bitangent), w.z, bsdf->ns);
}

// Transmission of fuzz, and of fuzz and coat, for a direction at the cosine c; 1 without them.
static inline REAL past_fuzz(const Scene* scene, __global const Layers* m, const LayerBase* base, REAL c,
                             MASK lanes) {
  if (m->fuzz.w == 0.0f) return (REAL)(1.0f);
  return past_fibres(base, layer_row(scene, m, LAYER_FUZZ, c, lanes));
}
static inline REAL past_layers(const Scene* scene, __global const Layers* m, const LayerBase* base, REAL c,
                               MASK lanes) {
  const REAL left = past_fuzz(scene, m, base, c, lanes);
  return m->coat.w == 0.0f ? left : left * past_coat(base, layer_row(scene, m, LAYER_COAT, c, lanes));
}

// Transmission of the coat's colour at the cosine c.
#if HAS_COAT_MAPS
static inline REAL coat_tint(__global const Layers* m, const LayerBase* base, float color, REAL way) {
  const REAL straight = real_max(1.0f - coat_weight(m, base) * (1.0f - color), (REAL)(1e-6f));
  return real_exp(real_log(straight) * way);
}
#else
static inline REAL coat_tint(__global const Layers* m, const LayerBase* base, float color, REAL way) {
  const float straight = fmax(1.0f - m->coat.w * (1.0f - color), 1e-6f);
  return straight == 1.0f ? (REAL)(1.0f) : real_exp(log(straight) * way);
}
#endif
static inline REAL3 coat_tints(__global const Layers* m, const LayerBase* base, REAL c) {
  const REAL way = 0.5f / real_max(refracted_cosine(c, (REAL)(m->coat_eta)), (REAL)(0.05f));
  return real3(coat_tint(m, base, m->coat.x, way), coat_tint(m, base, m->coat.y, way),
               coat_tint(m, base, m->coat.z, way));
}

// Attenuation by reflections between the coat and a base of the colour `color` (OpenPBR 1.1, "Coat",
// "Darkening"): (1 - K) / (1 - E K), with the coat's internal reflectance K and the base's normal albedo E,
// which includes transmitted light.
static inline REAL3 coat_darkening(__global const Layers* m, const LayerBase* base, REAL3 color) {
  const REAL3 one = all3((float3)(1.0f));
  if (m->darkening == 0.0f) return one;
  const REAL glassy = (1.0f - base->metal) * base->straight,
             below = (1.0f - base->metal) * past_interface(base, 1.0f - base->straight),
             matte = below * (1.0f - base->glass), through = below * base->glass;
  const REAL3 tint = scale3(interface_tint(m, base), glassy),
              clear = add3(tint, real3(through, through, through));
  const REAL3 back = add3(scale3(color, fma(base->metal, (REAL)(m->metal), matte)), clear);
  const REAL inner = base->inner;
  const REAL3 left = real3((1.0f - inner) / (1.0f - inner * real_min(back.x, one.x)),
                           (1.0f - inner) / (1.0f - inner * real_min(back.y, one.y)),
                           (1.0f - inner) / (1.0f - inner * real_min(back.z, one.z)));
  const REAL darker = darkening(m, base);
  return along3(scale3(one, 1.0f - darker), darker, left);
}

// The reflected colour of the base's interface at the cosine c: of the dielectric's opaque share, with
// components of at most `most`, and of the metal.
static inline REAL3 shine_color(const Scene* scene, __global const Layers* m, const LayerBase* base,
                                REAL3 color, REAL c, REAL most, MASK lanes) {
  const REAL opaque = (1.0f - base->metal) * (1.0f - base->glass);
  const REAL f = base_reflectance(m, base, c);
  REAL3 of_glass = real3(f, f, f), of_metal = metal_shares(c, color, m->specular);
  if (m->film > 0.0f) {
    const REAL left = (REAL)(1.0f - m->film);
    of_glass =
        along3(scale3(of_glass, left), (REAL)(m->film), film_rows(scene, m, base, LAYER_FILM, c, lanes));
    of_metal = along3(scale3(of_metal, left), (REAL)(m->film),
                      film_rows(scene, m, base, LAYER_FILM_METAL, c, lanes));
  }
  of_glass = real3(real_min(of_glass.x, most), real_min(of_glass.y, most), real_min(of_glass.z, most));
  of_glass = multiply3(of_glass, interface_tint(m, base));
  return along3(scale3(of_glass, opaque), base->metal * m->metal, of_metal);
}

// pi times the BSDF times the cosine of the layers of `lanes`, between directions in the frame. Where
// `mirrored`, coat and shine lack the share that mirror_layers() sends as a reflected ray.
static inline REAL3 layered_value(const Scene* scene, __global const Layers* m, const Bsdfs* bsdf,
                                  const LayerBase* base, const LayerShares* shares, REAL3 wo, REAL3 wi,
                                  MASK mirrored, MASK lanes, REAL* pdf) {
  const REAL one = (REAL)(1.0f);
  const MASK coated = lanes & bsdf->coated;
  const REAL3 h = safe_unit3(add3(wo, wi));
  const REAL wo_h = real_clamp(dot3(wo, h), (REAL)(0.0f), one);
  REAL3 value = all3((float3)(0.0f)), tint = all3((float3)(1.0f));
  REAL chance = shares->matte * wi.z * (1.0f / M_PI_F), kept = one;
  if (m->fuzz.w > 0.0f && any_lane(coated)) {
    const REAL fuzz = select((REAL)(0.0f), m->fuzz.w * fuzz_lobe(wo, wi, h, m->fuzz_alpha), coated);
    value = along3(value, fuzz, fuzz_color(m, base));
    kept = real_min(past_fuzz(scene, m, base, wo.z, coated), past_fuzz(scene, m, base, wi.z, coated));
    chance += shares->fuzz * (0.5f / M_PI_F);
  }
  if (m->coat.w > 0.0f && any_lane(coated)) {
    const REAL gains = coat_gain(scene, m, wo, coated) * coat_gain(scene, m, wi, coated);
    const FacetLobe lobe = facet_lobe(wo, wi, h, (REAL)(m->coat_alpha), (REAL)(m->coat_alpha_y), gains);
    const REAL part = mend_share(interface_reflectance(wo_h, (REAL)(m->coat_eta)), lobe.more);
    const REAL left = if_wide(shares, (REAL)(m->coat_alpha), (REAL)(m->coat_alpha_y)) *
                      share_left((REAL)(m->coat_alpha), (REAL)(m->coat_alpha_y), mirrored);
    const REAL coat = select((REAL)(0.0f), coat_weight(m, base) * part * lobe.value * kept * left, coated);
    value = add3(value, real3(coat, coat, coat));
    kept = real_min(past_layers(scene, m, base, wo.z, coated), past_layers(scene, m, base, wi.z, coated));
    tint = multiply3(coat_tints(m, base, wo.z), coat_tints(m, base, wi.z));
    tint = multiply3(tint, coat_darkening(m, base, bsdf->base));
    chance += shares->coat * lobe.pdf;
  }
  const REAL gains = shine_gain(scene, m, base, wo, lanes) * shine_gain(scene, m, base, wi, lanes);
  const FacetLobe shine = facet_lobe(wo, wi, h, base->alpha_x, base->alpha_y, gains);
  chance += shares->shine * shine.pdf;
  const REAL3 color = mend_shares(shine_color(scene, m, base, bsdf->base, wo_h, one, lanes), shine.more);
  const REAL left =
      if_wide(shares, base->alpha_x, base->alpha_y) * share_left(base->alpha_x, base->alpha_y, mirrored);
  REAL3 own = scale3(color, shine.value * (left * base->shine_scale) * select(one, kept, coated));
  const REAL ground = (1.0f - base->metal) * (1.0f - base->glass);
  if (any_lane(lanes & MASK_OF(ground > 0.0f))) {
    const REAL3 matte = matte_lobe(wo, wi, bsdf->base, m->matte_roughness);
    const REAL through = past_shine(scene, m, base, wo.z, lanes) * past_shine(scene, m, base, wi.z, lanes);
    REAL above = base->matte_scale_bare;
    if (any_lane(coated))
      above = select(above,
                     base->matte_scale * past_layers(scene, m, base, wo.z, coated) *
                         past_layers(scene, m, base, wi.z, coated),
                     coated);
    own = along3(own, through * above * ground, matte);
  }
  *pdf = chance;
  return add3(value, multiply3(own, select3(all3((float3)(1.0f)), tint, coated)));
}

// The layered surfaces of `lanes`, seen from the side that shows their layers or from inside.
static inline MASK layered_lanes(const Bsdfs* bsdf, MASK lanes) {
  return lanes & MASK_OF((bsdf->flags & (int)MATERIAL_LAYERED) != 0);
}

// pi times the BSDF times the cosine of the layers of `lanes`, in addition to the reflected ray of
// mirror_layers(), which hits the lights of `met` itself.
static inline REAL3 layered_light(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, REAL3 wi, MASK met,
                                  MASK lanes, REAL3 light) {
  MASK layered = layered_lanes(bsdf, lanes & MASK_OF(dot3(bsdf->ng, wi) > 0.0f));
  LayerShares none;
  none.fuzz = none.coat = none.shine = none.matte = (REAL)(0.0f);
  leave_nothing_out(&none);
  const REAL3 o = into_frame(bsdf, wo), i = into_frame(bsdf, wi);
  REAL3 sum = light;
  u32 index;
  for (u32 left = lane_bits(layered); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    __global const Layers* m = scene->layers + index;
    REAL pdf;
    const LayerBase base = base_of(scene, m, bsdf, mine);
    const REAL3 own = layered_value(scene, m, bsdf, &base, &none, o, i, met, mine, &pdf);
    sum = select3(sum, along3(sum, bsdf->there, own), mine);
  }
  return sum;
}

// The reflection of `lanes` for integrators that send a separate reflected ray: larger for smoother surfaces.
// An interface reflects at most what its layer takes from those below, which rough layers take less of at
// grazing angles than Fresnel's equations say.
static inline void mirror_layers(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, MASK lanes,
                                 SpecularSplits* split) {
  const REAL c = dot3(bsdf->ns, wo), one = (REAL)(1.0f);
  u32 index;
  for (u32 left = lane_bits(layered_lanes(bsdf, lanes)); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    __global const Layers* m = scene->layers + index;
    const MASK coated = mine & bsdf->coated;
    const LayerBase base = base_of(scene, m, bsdf, mine);
    const REAL by_fuzz = past_fuzz(scene, m, &base, c, mine), by_both = past_layers(scene, m, &base, c, mine);
    const REAL past = select(one, by_both, coated);
    const REAL3 tint = select3(all3((float3)(1.0f)), coat_tints(m, &base, c), coated);
    const REAL taken = 1.0f - past_shine(scene, m, &base, c, mine);
    const REAL3 color = shine_color(scene, m, &base, bsdf->base, c, taken, mine);
    const REAL3 below = multiply3(multiply3(tint, tint), color);
    REAL coat = by_fuzz * coat_weight(m, &base) * interface_reflectance(c, (REAL)(m->coat_eta));
    coat = real_min(coat, by_fuzz - by_both);
    coat *= mirror_share((REAL)(m->coat_alpha), (REAL)(m->coat_alpha_y));
    coat = select((REAL)(0.0f), coat, coated);
    const REAL share = past * mirror_share(base.alpha_x, base.alpha_y);
    const REAL3 own = along3(real3(coat, coat, coat), share, below);
    split->kr = select3(split->kr, along3(split->kr, bsdf->there, own), mine);
  }
}
#else
static inline REAL3 layered_light(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, REAL3 wi, MASK met,
                                  MASK lanes, REAL3 light) {
  return light;
}
static inline void mirror_layers(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, MASK lanes,
                                 SpecularSplits* split) {}
#endif

#endif
