// All layers of a material as one lobe. They attenuate the lobes before them.
#include "plain/shade/lobe_set.h"

HAVING(HAS_LAYERS);

static inline float share_layered(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, LobeSet* lobes) {
  return lobes->layers.fuzz + lobes->layers.coat + (lobes->layers.shine + lobes->layers.matte);
}

// The base's colour: of white light, layers return about what they keep from it.
static inline float3 albedo_layered(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                    float3 wo) {
  return is_layered(bsdf) ? bsdf->base * bsdf->there : (float3)(0.0f);
}

static inline void scatter_layered(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                   float3 wo, float3 wi, LobeSum* sum) {
  if (!is_layered(bsdf)) return;
  const float3 o = into_frame(bsdf, wo), i = into_frame(bsdf, wi);
  const bool under = greatest(sum->value) > 0.0f, above = i.z > 0.0f && dot(bsdf->side, wi) > 0.0f;
  EACH_ALIKE(int, index, bsdf->material) {
    __global const Layers* m = scene->layers + index;
    if (under) sum->value *= left_by_layers(scene, m, bsdf, o.z, i.z);
    if (above) {
      float pdf;
      const float3 own = layered_value(scene, m, bsdf, &lobes->layers, o, i, false, &pdf);
      sum->value = along(sum->value, bsdf->there, own);
      sum->pdf += pdf;
    }
  }
}

// u->at chooses the layer.
static inline float3 sample_layered(UNIFORM const Scene* scene, const Bsdf* bsdf, const LobeSet* lobes,
                                    float3 wo, const LobeNumbers* u, bool* below) {
  const LayerShare* shares = &lobes->layers;
  const bool fuzz = u->at < shares->fuzz, coat = u->at < shares->fuzz + shares->coat;
  const bool facets = !fuzz && u->at < shares->fuzz + shares->coat + shares->shine;
  float3 w;
  if (facets) {
    float alpha_x = 1.0f, alpha_y = 1.0f;
    EACH_ALIKE(int, index, bsdf->material) {
      __global const Layers* m = scene->layers + index;
      const LayerBase base = base_of(scene, m, bsdf);
      alpha_x = coat ? m->coat_alpha : base.alpha_x;
      alpha_y = coat ? m->coat_alpha_y : base.alpha_y;
    }
    const float3 o = into_frame(bsdf, wo), h = seen_facet(o, alpha_x, alpha_y, u->x, u->y);
    w = h * (2.0f * dot(h, o)) - o;
  } else {
    const float z = fuzz ? u->x : real_sqrt(u->x), angle = 2.0f * M_PI_F * u->y;
    const float side = real_sqrt(real_max(1.0f - z * z, 0.0f));
    w = (float3)(side * cos(angle), side * sin(angle), z);
  }
  return renormalized3(along(along(bsdf->tangent * w.x, w.y, bsdf->bitangent), w.z, bsdf->ns));
}

// The layers' light in addition to the reflected ray of mirror_layers(), which hits the lights of `met`
// itself.
static inline void local_layered(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, float3 wi, bool met,
                                 float3* light) {
  if (!(is_layered(bsdf) && dot(bsdf->side, wi) > 0.0f)) return;
  const LayerShare none = no_shares();
  EACH_ALIKE(int, index, bsdf->material) {
    float pdf;
    const float3 own = layered_value(scene, scene->layers + index, bsdf, &none, into_frame(bsdf, wo),
                                     into_frame(bsdf, wi), met, &pdf);
    *light = along(*light, bsdf->there, own);
  }
}

// The base below may be narrow.
HAVING(HAS_CAUSTICS)
static inline bool drop_narrow_layered(Bsdf* bsdf, LobeSet* lobes) {
  lobes->layers.least = LEAST_WIDE_ALPHA;
  return lobes->layered > 0.0f;
}

static inline float matte_layered(const LobeSet* lobes) { return lobes->layers.matte; }

HAVING(HAS_LIGHT_PARTS)
static inline void drop_matte_layered(Bsdf* bsdf, LobeSet* lobes) { lobes->layers.only_glossy = true; }
