// GGX microfacets (Walter and others 2007), each a perfect mirror or interface, and rough reflection and
// transmission by one of them, for integrators that send both rays.
#include "plain/shade/lobe_energy.cl"
#include "plain/shade/specular.cl"

// The facet width of the surface, 0: none.
static inline float facet_width(UNIFORM const Scene* scene, const Bsdf* bsdf) {
  float width = 0.0f;
  EACH_ALIKE(int, index, bsdf->material) width = scene->materials[index].reflection.w;
  if (HAS_LAYER_MAPS && (bsdf->flags & (int)MATERIAL_LAYERED) != 0) width = bsdf->roughness * bsdf->roughness;
  return width;
}

// Samples the normal of a facet of width 1 by its area as seen from wo (Dupuy and Benyoub 2023, "Sampling
// Visible GGX Normals with Spherical Caps"). Callers stretch wo before, the normal after.
static inline float3 seen_area(float3 wo, float u_x, float u_y) {
  const float z = fma(1.0f - u_y, 1.0f + wo.z, -wo.z), angle = 2.0f * M_PI_F * u_x;
  const float side = real_sqrt(real_clamp(1.0f - z * z, 0.0f, 1.0f));
  return (float3)(side * cos(angle), side * sin(angle), z) + wo;
}
static inline float3 visible_normal(float3 n, float3 wo, float alpha, float u_x, float u_y) {
  float3 s, t;
  tangent_frame(n, &s, &t);
  const float3 stretched =
      safe_unit3((float3)(alpha * dot(wo, s), alpha * dot(wo, t), real_max(dot(wo, n), 1e-6f)));
  const float3 h = seen_area(stretched, u_x, u_y);
  return safe_unit3(n * real_max(h.z, 1e-6f) + (s * (alpha * h.x) + t * (alpha * h.y)));
}

// Smith's masking function for a direction at the cosine c to the normal.
static inline float smith_lambda(float c, float alpha) {
  const float square = real_max(c * c, 1e-12f);
  return 0.5f * (real_sqrt(1.0f + alpha * alpha * (1.0f - square) / square) - 1.0f);
}

// Whether light scatters multiply between the facets; whether it does so in glass.
static inline bool gives_back(const Bsdf* bsdf) { return (bsdf->flags & (int)MATERIAL_SCATTERS_ONCE) == 0; }
static inline bool is_rough_glass(UNIFORM const Scene* scene, const Bsdf* bsdf, bool bends) {
  bool glass = false;
  if (HAS_ROUGH_GLASS && bends && gives_back(bsdf))
    EACH_ALIKE(int, index, bsdf->material) glass = scene->materials[index].kind == MATERIAL_DIELECTRIC;
  return glass;
}

// The facets of a surface for a viewer, of which rays scatter by all (lobes/ggx.cl).
typedef struct FurtherLight {
  float lost;               // m(wo), also the share of the samples
  float through;            // fraction transmitted
  float mean, mean_behind;  // of m on the viewer's side and behind
} FurtherLight;

typedef struct Microfacet {
  bool rough, bends;  // has facets; they also refract
  bool transmits;     // they refract, or are those of a frosted wall
  bool glass;         // refracting dielectrics with a separate multiple-scattering lobe
  float alpha, lambda_o;
  float gain;  // microfacet_gain() of the viewer's side; 0: the lobe is not scaled by gains
  HAVING(HAS_THIN_WALLS) bool frosted;  // thin walls with transmitting facets
  HAVING(HAS_ROUGH_GLASS) FurtherLight further;
} Microfacet;

// The colour of facets where they are, of which opacity is a factor: that counts each time light meets them.
static inline float3 own_color(const Bsdf* bsdf, float3 color) {
  if (HAS_OPACITY) return color * (1.0f / real_max(bsdf->there, 1e-6f));
  return color;
}

// The surface's facet, or the surface itself.
typedef struct MetFacet {
  Bsdf bsdf;  // with the facet's normal if rough
  HAVING(HAS_ROUGH) bool rough;
  HAVING(HAS_ROUGH) bool glass;  // a refracting dielectric
  HAVING(HAS_ROUGH) float alpha, lambda_o, energy;
} MetFacet;

static inline MetFacet meet_facet(UNIFORM const Scene* scene, const Bsdf* bsdf, float3 wo, float u_x,
                                  float u_y) {
  MetFacet facet;
  facet.bsdf = *bsdf;
  if (HAS_ROUGH) {
    facet.alpha = facet_width(scene, bsdf);
    facet.rough = facet.alpha > 0.0f;
    facet.glass = false;
    if (facet.rough) {
      const float cosine = dot(bsdf->ns, wo);
      facet.bsdf.ns = visible_normal(bsdf->ns, wo, facet.alpha, u_x, u_y);
      facet.lambda_o = smith_lambda(cosine, facet.alpha);
      facet.energy = 1.0f;
      if (gives_back(bsdf)) facet.energy = lobe_energy_at(scene, 0u, cosine, facet.alpha);
      if (HAS_ROUGH_GLASS) {
        const bool bends =
            (bsdf->flags & (int)MATERIAL_TRANSMITS) != 0 && (bsdf->flags & (int)MATERIAL_THIN) == 0;
        if (is_rough_glass(scene, bsdf, bends)) {
          const float eta = index_across(scene, bsdf);
          facet.glass = eta != 1.0f;
          if (facet.glass) facet.energy = glass_value(scene, eta, cosine, facet.alpha);
        }
      }
    }
  }
  return facet;
}

static inline float3 reflected_by(const MetFacet* facet, float3 wo) {
  if (HAS_ROUGH && facet->rough) return reflect_direction(-wo, facet->bsdf.ns);
  return reflected_direction(&facet->bsdf, wo);
}
static inline float3 transmitted_by(const MetFacet* facet, const Interface* interface, float3 wo) {
  if (HAS_ROUGH && facet->rough && interface->eta != 1.0f)
    return refract_direction(-wo, facet->bsdf.ns, interface->cos_i, interface->cos_t, interface->eta);
  return transmitted_direction(&facet->bsdf, interface, wo);
}

// The weight of light from a lobe of the given colour: its unmasked fraction on the way out, scaled for
// losses by multiple scattering (Turquin 2019, "Practical multiple scattering compensation for microfacet
// models"). `side` is 1 for directions before the surface, -1 behind it; `share` is what Fresnel's equations
// make of glass's own colour.
static inline float3 facet_weight(const MetFacet* facet, const Bsdf* surface, float3 wi, UNIFORM float side,
                                  float3 color, float share, bool mends) {
  float3 weight = (float3)(1.0f);
  if (HAS_ROUGH && facet->rough) {
    const float c = side * dot(surface->ns, wi);
    const float seen = (1.0f + facet->lambda_o) / (1.0f + facet->lambda_o + smith_lambda(c, facet->alpha));
    const float kept = c > 0.0f && side * dot(surface->side, wi) > 0.0f ? seen : 0.0f;
    const float more = mends || facet->glass ? 1.0f / facet->energy - 1.0f : 0.0f;
    const float3 own = facet->glass ? color * (1.0f / real_max(share, 1e-6f)) : own_color(surface, color);
    weight =
        (float3)(kept * fma(own.x, more, 1.0f), kept * fma(own.y, more, 1.0f), kept * fma(own.z, more, 1.0f));
  }
  return weight;
}
