// Sampling of layered materials, for integrators that continue with one ray, and the attenuation by layers of
// the terms below: perfect reflection and transmission, facets of glass. One surface per lane.
#ifndef SUNDOG_LIB_LAYER_SAMPLE_CL
#define SUNDOG_LIB_LAYER_SAMPLE_CL
#include "lib/shade/layers.cl"

#if HAS_LAYERS
// The light that fuzz and coat transmit between the cosines c_o, on the viewer's side, and c_i, which is
// negative behind the surface. Thin walls with an index have the same layers on both sides, so transmitted
// light passes both.
static inline REAL3 left_by_layers(const Scene* scene, __global const Layers* m, const Bsdfs* bsdf, REAL c_o,
                                   REAL c_i, MASK lanes) {
  const REAL3 white = all3((float3)(1.0f));
  if (m->fuzz.w == 0.0f && m->coat.w == 0.0f) return white;
  const MASK through = MASK_OF(c_i < 0.0f);
  const LayerBase base = base_of(scene, m, bsdf, lanes);
  const REAL of_o = past_layers(scene, m, &base, c_o, lanes),
             of_i = past_layers(scene, m, &base, fabs(c_i), lanes);
  const REAL3 darkening = coat_darkening(m, &base, bsdf->base);
  const REAL3 tint_o = multiply3(coat_tints(m, &base, c_o), darkening),
              tint_i = coat_tints(m, &base, fabs(c_i));
  const MASK walls = walls_of(bsdf->flags, lanes);
  const MASK front = lanes & bsdf->coated, back = lanes & bsdf->coated_behind & through;
  REAL3 left = scale3(multiply3(tint_o, tint_i), real_min(of_o, of_i));
  left = select3(left, scale3(tint_o, of_o), through & ~walls);
  left = select3(white, left, front);
  return select3(left, scale3(multiply3(tint_i, darkening), of_i), back);
}

// Attenuates light `through` surfaces by `left`, the layers' transmission. Layers are present as far as the
// surface is opaque: light through its absent part loses nothing.
static inline REAL3 left_where_there(const Bsdfs* bsdf, REAL3 through, REAL3 left) {
  const REAL open = 1.0f - bsdf->there;
  const REAL3 beside = real3(open, open, open);
  return add3(multiply3(left, subtract3(through, beside)), beside);
}

// The shares of samples for the viewer in wo, proportional to the lobes' maximum reflectance; and the layers'
// attenuation of perfect reflection and transmission.
static inline LayerShares make_shares(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, MASK lanes,
                                      SpecularSplits* split) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f), c = dot3(bsdf->ns, wo);
  LayerShares shares;
  shares.fuzz = shares.coat = shares.shine = shares.matte = zero;
  leave_nothing_out(&shares);
  u32 index;
  for (u32 left = lane_bits(layered_lanes(bsdf, lanes)); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    __global const Layers* m = scene->layers + index;
    const MASK coated = mine & bsdf->coated;
    const LayerBase base = base_of(scene, m, bsdf, mine);
    const REAL by_fuzz = select(one, past_fuzz(scene, m, &base, c, mine), coated);
    const REAL by_both = select(one, past_layers(scene, m, &base, c, mine), coated);
    const REAL by_shine = past_shine(scene, m, &base, c, mine);
    const REAL opaque = (1.0f - base.metal) * (1.0f - base.glass);
    const REAL of_metal = base.metal * real_max(greatest3(bsdf->base), (REAL)(0.05f));
    const REAL there = bsdf->there;
    shares.fuzz = select(shares.fuzz, there * (1.0f - by_fuzz), mine);
    shares.coat = select(shares.coat, there * (by_fuzz - by_both), mine);
    shares.shine = select(shares.shine, there * (by_both * fma(opaque, 1.0f - by_shine, of_metal)), mine);
    const REAL matte = by_both * by_shine * opaque * greatest3(bsdf->base);
    shares.matte = select(shares.matte, there * matte, mine);
    const REAL3 kr = multiply3(split->kr, left_by_layers(scene, m, bsdf, c, c, mine));
    const REAL3 kt =
        left_where_there(bsdf, split->kt, left_by_layers(scene, m, bsdf, c, -split->cos_t, mine));
    split->kr = select3(split->kr, kr, mine);
    split->kt = select3(split->kt, kt, mine);
  }
  return shares;
}

static inline REAL sum_of_shares(const LayerShares* shares) {
  return shares->fuzz + shares->coat + (shares->shine + shares->matte);
}

// Attenuates `value` and adds pi times the BSDF times the cosine of the layers of `lanes`; adds the pdf of
// their samples, times the sum of the shares, to `chosen`.
static inline void layer_scatter(const Scene* scene, const Bsdfs* bsdf, const LayerShares* shares, REAL3 wo,
                                 REAL3 wi, MASK lanes, REAL3* value, REAL* chosen) {
  const MASK layered = layered_lanes(bsdf, lanes);
  if (!any_lane(layered)) return;
  const REAL3 o = into_frame(bsdf, wo), i = into_frame(bsdf, wi);
  const MASK above = layered & MASK_OF(i.z > 0.0f) & MASK_OF(dot3(bsdf->ng, wi) > 0.0f);
  const MASK under = layered & MASK_OF(greatest3(*value) > 0.0f);
  u32 index;
  for (u32 left = lane_bits(layered); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    __global const Layers* m = scene->layers + index;
    if (any_lane(mine & under))
      *value = select3(*value, multiply3(*value, left_by_layers(scene, m, bsdf, o.z, i.z, mine & under)),
                       mine & under);
    const MASK lit = mine & above;
    if (!any_lane(lit)) continue;
    REAL pdf;
    const LayerBase base = base_of(scene, m, bsdf, lit);
    const REAL3 own = layered_value(scene, m, bsdf, &base, shares, o, i, NO_LANES, lit, &pdf);
    *value = select3(*value, along3(*value, bsdf->there, own), lit);
    *chosen = select(*chosen, *chosen + pdf, lit);
  }
}

// Samples directions of the layers for wo; `at` in [0, sum of the shares) chooses the lobe.
static inline REAL3 layer_direction(const Scene* scene, const Bsdfs* bsdf, const LayerShares* shares,
                                    REAL3 wo, REAL at, REAL u_x, REAL u_y, MASK lanes) {
  const REAL one = (REAL)(1.0f);
  REAL alpha_x = one, alpha_y = one;
  const MASK fuzz = MASK_OF(at < shares->fuzz), coat = MASK_OF(at < shares->fuzz + shares->coat);
  const MASK shine = MASK_OF(at < shares->fuzz + shares->coat + shares->shine);
  u32 index;
  for (u32 left = lane_bits(layered_lanes(bsdf, lanes)); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    __global const Layers* m = scene->layers + index;
    const LayerBase base = base_of(scene, m, bsdf, mine);
    alpha_x = select(alpha_x, select(base.alpha_x, (REAL)(m->coat_alpha), coat), mine);
    alpha_y = select(alpha_y, select(base.alpha_y, (REAL)(m->coat_alpha_y), coat), mine);
  }
  const REAL3 o = into_frame(bsdf, wo), h = seen_facet(o, alpha_x, alpha_y, u_x, u_y);
  const REAL3 mirrored = subtract3(scale3(h, 2.0f * dot3(h, o)), o);
  const REAL z = select(real_sqrt(u_x), u_x, fuzz), angle = 2.0f * M_PI_F * u_y;
  const REAL side = real_sqrt(real_max(1.0f - z * z, (REAL)(0.0f)));
  const REAL3 wide = real3(side * cos(angle), side * sin(angle), z);
  return renormalized3(out_of_frame(bsdf, select3(wide, mirrored, shine & ~fuzz)));
}
#endif

#endif
