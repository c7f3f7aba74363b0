// Layered materials (shared/layers.h): the light that fuzz and coat transmit is the minimum over both
// directions, which is reciprocal and conserves energy: with a layer's transmission T(w) for the direction w,
// its own light is 1 - T(wo) and that from below at most T(wo). The matte ground uses T(wo) T(wi) over a
// constant instead (Kelemen and Szirmay-Kalos 2001), which is exact for it.
#include "plain/shade/layer_base.cl"
#include "plain/shade/specular.cl"

HAVING(HAS_LAYERS);

// The shares of samples of the lobes.
typedef struct LayerShare {
  float fuzz, coat, shine, matte;
  HAVING(HAS_CAUSTICS) float least;          // narrower facets are excluded; 0: none
  HAVING(HAS_LIGHT_PARTS) bool only_glossy;  // fuzz and the matte ground are excluded
} LayerShare;

static inline bool is_layered(const Bsdf* bsdf) { return (bsdf->flags & (int)MATERIAL_LAYERED) != 0; }

static inline LayerShare no_shares(void) {
  LayerShare shares;
  shares.fuzz = 0.0f;
  shares.coat = 0.0f;
  shares.shine = 0.0f;
  shares.matte = 0.0f;
  if (HAS_CAUSTICS) shares.least = 0.0f;
  if (HAS_LIGHT_PARTS) shares.only_glossy = false;
  return shares;
}

// 0 if facets of these widths are excluded, else 1; where a mirror ray is sent for the light, the rest of the
// lobe.
static inline float share_left(const LayerShare* shares, float alpha_x, float alpha_y, bool mirrored) {
  const float left = 1.0f - (mirrored ? mirror_share(alpha_x, alpha_y) : 0.0f);
  if (HAS_CAUSTICS) return (alpha_x * alpha_y < shares->least * shares->least ? 0.0f : 1.0f) * left;
  return left;
}

// 0 if fuzz and the matte ground are excluded.
static inline float diffuse_left(const LayerShare* shares) {
  if (HAS_LIGHT_PARTS) return shares->only_glossy ? 0.0f : 1.0f;
  return 1.0f;
}

static inline float3 into_frame(const Bsdf* bsdf, float3 w) {
  return (float3)(dot(w, bsdf->tangent), dot(w, bsdf->bitangent), dot(w, bsdf->ns));
}

// Transmission of fuzz, and of fuzz and coat, for a direction at the cosine c; 1 without them.
static inline float past_fuzz(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                              const LayerBase* base, float c) {
  if (m->fuzz.w == 0.0f) return 1.0f;
  return past_fibres(base, layer_row(scene, m, LAYER_FUZZ, c));
}
static inline float past_layers(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                const LayerBase* base, float c) {
  const float left = past_fuzz(scene, m, base, c);
  if (m->coat.w == 0.0f) return left;
  return left * past_coat(base, layer_row(scene, m, LAYER_COAT, c));
}

// Transmission of the coat's colour at the cosine c.
static inline float coat_tint(UNIFORM __global const Layers* m, const LayerBase* base, UNIFORM float color,
                              float way) {
  if (HAS_COAT_MAPS)
    return real_exp(real_log(real_max(1.0f - coat_weight(m, base) * (1.0f - color), 1e-6f)) * way);
  const float straight = fmax(1.0f - m->coat.w * (1.0f - color), 1e-6f);
  return straight == 1.0f ? 1.0f : real_exp(log(straight) * way);
}
static inline float3 coat_tints(UNIFORM __global const Layers* m, const LayerBase* base, float c) {
  const float way = 0.5f / real_max(refracted_cosine(c, m->coat_eta), 0.05f);
  return (float3)(coat_tint(m, base, m->coat.x, way), coat_tint(m, base, m->coat.y, way),
                  coat_tint(m, base, m->coat.z, way));
}

// Attenuation by reflections between the coat and a base of the colour `color` (OpenPBR 1.1, "Coat",
// "Darkening"): (1 - K) / (1 - E K), with the coat's internal reflectance K and the base's normal albedo E,
// which includes transmitted light.
static inline float3 coat_darkening(UNIFORM __global const Layers* m, const LayerBase* base, float3 color) {
  if (m->darkening == 0.0f) return (float3)(1.0f);
  const float glassy = (1.0f - base->metal) * base->straight,
              below = (1.0f - base->metal) * past_interface(base, 1.0f - base->straight),
              matte = below * (1.0f - base->glass), through = below * base->glass;
  const float3 clear = interface_tint(m, base) * glassy + (float3)(through, through, through);
  const float3 back = color * fma(base->metal, m->metal, matte) + clear;
  const float inner = base->inner, darker = darkening(m, base);
  const float3 left = (float3)((1.0f - inner) / (1.0f - inner * real_min(back.x, 1.0f)),
                               (1.0f - inner) / (1.0f - inner * real_min(back.y, 1.0f)),
                               (1.0f - inner) / (1.0f - inner * real_min(back.z, 1.0f)));
  return along((float3)(1.0f) * (1.0f - darker), darker, left);
}

// The reflected colour of the base's interface at the cosine c: of the dielectric's opaque share, with
// components of at most `most`, and of the metal. Light scatters again, by `more`, between facets of the same
// kind, so the shares of both count once.
static inline float3 shine_color(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                 const LayerBase* base, float3 color, float c, float most, float more) {
  const float opaque = (1.0f - base->metal) * (1.0f - base->glass);
  const float f = base_reflectance(m, base, c);
  float3 of_glass = (float3)(f, f, f), of_metal = metal_shares(c, color, m->specular);
  if (m->film > 0.0f) {
    of_glass = along(of_glass * (1.0f - m->film), m->film, film_rows(scene, m, base, LAYER_FILM, c));
    of_metal = along(of_metal * (1.0f - m->film), m->film, film_rows(scene, m, base, LAYER_FILM_METAL, c));
  }
  of_glass = (float3)(real_min(of_glass.x, most), real_min(of_glass.y, most), real_min(of_glass.z, most)) *
             interface_tint(m, base);
  return along(mend_shares(of_glass, more) * opaque, base->metal, mend_shares(of_metal * m->metal, more));
}

// The light that fuzz and coat transmit between the cosines c_o, on the viewer's side, and c_i, which is
// negative behind the surface. Thin walls with an index have the same layers on both sides, so transmitted
// light passes both.
static inline float3 left_by_layers(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                    const Bsdf* bsdf, float c_o, float c_i) {
  float3 left = (float3)(1.0f);
  if (m->fuzz.w == 0.0f && m->coat.w == 0.0f) return left;
  const bool through = c_i < 0.0f;
  const LayerBase base = base_of(scene, m, bsdf);
  const float of_o = past_layers(scene, m, &base, c_o), of_i = past_layers(scene, m, &base, fabs(c_i));
  const float3 darker = coat_darkening(m, &base, bsdf->base);
  const float3 tint_o = coat_tints(m, &base, c_o) * darker, tint_i = coat_tints(m, &base, fabs(c_i));
  if (bsdf->coated)
    left = through && !is_wall(bsdf->flags) ? tint_o * of_o : tint_o * tint_i * real_min(of_o, of_i);
  if (bsdf->coated_behind && through) left = tint_i * darker * of_i;
  return left;
}

// Attenuates light `through` surfaces by `left`, the layers' transmission. Layers are present as far as the
// surface is opaque: light through its absent part loses nothing.
static inline float3 left_where_there(const Bsdf* bsdf, float3 through, float3 left) {
  const float open = 1.0f - bsdf->there;
  const float3 beside = (float3)(open, open, open);
  return left * (through - beside) + beside;
}

// Attenuates perfect reflection and transmission by fuzz and coats, for a viewer at the cosine c. Those
// behind the interface, on glass seen from within, reflect the light that they do not transmit.
static inline void cover_interface(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                   const Bsdf* bsdf, float c, Interface* interface) {
  if (greatest(interface->kr) > 0.0f) interface->kr = interface->kr * left_by_layers(scene, m, bsdf, c, c);
  if (!interface->transmits) return;
  const float3 left = left_by_layers(scene, m, bsdf, c, -interface->cos_t);
  if (bsdf->coated_behind && (m->fuzz.w != 0.0f || m->coat.w != 0.0f)) {
    const LayerBase base = above_base(m, bsdf);
    const float open = 1.0f - bsdf->there, back = 1.0f - past_layers(scene, m, &base, interface->cos_t);
    const float3 tint = coat_tints(m, &base, interface->cos_t);
    interface->kr += (interface->kt - (float3)(open, open, open)) * tint * tint * back;
  }
  interface->kt = left_where_there(bsdf, interface->kt, left);
}

// Transmittance of the surface at the cosine c with its fuzz and coats; `through`: without.
static inline float3 passed_by_layers(UNIFORM const Scene* scene, const Bsdf* bsdf, float c, float3 through) {
  float3 passed = through;
  EACH_ALIKE(int, index, bsdf->material)
  passed = left_where_there(bsdf, through, left_by_layers(scene, scene->layers + index, bsdf, c, -c));
  return passed;
}

// Fuzz and coat of layered_value(): `kept` is what they leave of the light of what lies below.
static inline float3 coats_value(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                 const Bsdf* bsdf, const LayerShare* shares, float3 wo, float3 wi, float3 h,
                                 bool mirrored, float* kept, float* chance) {
  const LayerBase base = above_base(m, bsdf);
  float3 value = (float3)(0.0f);
  *kept = 1.0f;
  if (m->fuzz.w > 0.0f && bsdf->coated) {
    value = along(value, diffuse_left(shares) * m->fuzz.w * fuzz_lobe(wo, wi, h, m->fuzz_alpha),
                  fuzz_color(m, &base));
    *kept = real_min(past_fuzz(scene, m, &base, wo.z), past_fuzz(scene, m, &base, wi.z));
    *chance += shares->fuzz * (0.5f / M_PI_F);
  }
  if (m->coat.w > 0.0f && bsdf->coated) {
    const float coat_gains = coat_gain(scene, m, wo) * coat_gain(scene, m, wi);
    const FacetLobe lobe = facet_lobe(wo, wi, h, m->coat_alpha, m->coat_alpha_y, coat_gains);
    const float wo_h = real_clamp(dot(wo, h), 0.0f, 1.0f);
    const float part = mend_share(interface_reflectance(wo_h, m->coat_eta), lobe.more);
    const float coat_left = share_left(shares, m->coat_alpha, m->coat_alpha_y, mirrored);
    const float coat = coat_weight(m, &base) * part * lobe.value * *kept * coat_left;
    value += (float3)(coat, coat, coat);
    *kept = real_min(past_layers(scene, m, &base, wo.z), past_layers(scene, m, &base, wi.z));
    *chance += shares->coat * lobe.pdf;
  }
  return value;
}

// pi times the BSDF times the cosine of the layers between directions in the frame. Where `mirrored`, coat
// and shine lack the share that mirror_layers() sends as a reflected ray.
static inline float3 layered_value(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                   const Bsdf* bsdf, const LayerShare* shares, float3 wo, float3 wi,
                                   bool mirrored, float* pdf) {
  const float3 h = safe_unit3(wo + wi);
  float chance = shares->matte * wi.z * (1.0f / M_PI_F), kept;
  const float3 value = coats_value(scene, m, bsdf, shares, wo, wi, h, mirrored, &kept, &chance);
  const LayerBase base = base_of(scene, m, bsdf);
  const float wo_h = real_clamp(dot(wo, h), 0.0f, 1.0f);
  const float gains = shine_gain(scene, m, &base, wo) * shine_gain(scene, m, &base, wi);
  const FacetLobe shine = facet_lobe(wo, wi, h, base.alpha_x, base.alpha_y, gains);
  chance += shares->shine * shine.pdf;
  const float3 color = shine_color(scene, m, &base, bsdf->base, wo_h, 1.0f, shine.more);
  const float left = share_left(shares, base.alpha_x, base.alpha_y, mirrored);
  float3 own = color * (shine.value * (left * base.shine_scale) * kept);
  const float ground = diffuse_left(shares) * (1.0f - base.metal) * (1.0f - base.glass);
  if (ground > 0.0f) {
    const float3 matte = matte_lobe(wo, wi, bsdf->base, m->matte_roughness);
    const float through = past_shine(scene, m, &base, wo.z) * past_shine(scene, m, &base, wi.z);
    float above = base.matte_scale_bare;
    if (bsdf->coated)
      above = base.matte_scale * past_layers(scene, m, &base, wo.z) * past_layers(scene, m, &base, wi.z);
    own = along(own, through * above * ground, matte);
  }
  if (m->coat.w > 0.0f && bsdf->coated)
    own *= coat_tints(m, &base, wo.z) * coat_tints(m, &base, wi.z) * coat_darkening(m, &base, bsdf->base);
  *pdf = chance;
  return value + own;
}

// The shares of samples for the viewer in wo, proportional to the lobes' maximum reflectance; and the layers'
// attenuation of perfect reflection and transmission.
static inline LayerShare make_shares(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo,
                                     Interface* interface) {
  const float c = dot(bsdf->ns, wo);
  LayerShare shares = no_shares();
  if (is_layered(bsdf)) EACH_ALIKE(int, index, bsdf->material) {
      __global const Layers* m = scene->layers + index;
      const LayerBase base = base_of(scene, m, bsdf);
      const float by_fuzz = bsdf->coated ? past_fuzz(scene, m, &base, c) : 1.0f;
      const float by_both = bsdf->coated ? past_layers(scene, m, &base, c) : 1.0f;
      const float by_shine = past_shine(scene, m, &base, c);
      const float opaque = (1.0f - base.metal) * (1.0f - base.glass);
      const float of_metal = base.metal * real_max(greatest(bsdf->base), 0.05f);
      shares.fuzz = bsdf->there * (1.0f - by_fuzz);
      shares.coat = bsdf->there * (by_fuzz - by_both);
      shares.shine = bsdf->there * (by_both * fma(opaque, 1.0f - by_shine, of_metal));
      shares.matte = bsdf->there * (by_both * by_shine * opaque * greatest(bsdf->base));
      cover_interface(scene, m, bsdf, c, interface);
    }
  return shares;
}

// The reflection of layers for integrators that send a separate reflected ray: larger for smoother surfaces.
// An interface reflects at most what its layer takes from those below, which rough layers take less of at
// grazing angles than Fresnel's equations say.
static inline float3 mirrored_by_layers(UNIFORM const Scene* scene, UNIFORM __global const Layers* m,
                                        const Bsdf* bsdf, float c) {
  const LayerBase base = base_of(scene, m, bsdf);
  const float taken = 1.0f - past_shine(scene, m, &base, c);
  float3 below = shine_color(scene, m, &base, bsdf->base, c, taken, 0.0f);
  float share = mirror_share(base.alpha_x, base.alpha_y), coat = 0.0f;
  if (bsdf->coated) {
    const float by_fuzz = past_fuzz(scene, m, &base, c), by_both = past_layers(scene, m, &base, c);
    const float3 tint = coat_tints(m, &base, c);
    below = tint * tint * below;
    share = by_both * share;
    coat = by_fuzz * coat_weight(m, &base) * interface_reflectance(c, m->coat_eta);
    coat = real_min(coat, by_fuzz - by_both) * mirror_share(m->coat_alpha, m->coat_alpha_y);
  }
  return along((float3)(coat, coat, coat), share, below);
}
