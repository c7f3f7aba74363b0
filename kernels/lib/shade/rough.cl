// Rough reflection and transmission: GGX microfacets (Walter and others 2007), each a perfect mirror or
// interface. One surface per lane.
#ifndef SUNDOG_LIB_ROUGH_CL
#define SUNDOG_LIB_ROUGH_CL
#include "lib/core/directions.cl"
#include "lib/shade/bsdf.cl"
#include "shared/lobe_energy.h"

#if HAS_ROUGH || HAS_LAYERS
// Position in the tables of host/compile/lobe_energy.h of the width alpha and the cosine c, both from 0 to 1.
static inline float2 lobe_place(float c, float alpha) {
  const float a = clamp(alpha, LEAST_LOBE_ALPHA, 1.0f), x = clamp(c, 0.0f, 1.0f);
  return (float2)(LOBE_COLUMN(x, a), sqrt(a));
}

// Looks up one of these tables by alpha and the cosine c; `first` is its first value's index. 1 outside
// `lanes`.
static inline REAL lobe_energy_at(const Scene* scene, u32 first, REAL c, REAL alpha, MASK lanes) {
  REAL energy = (REAL)(1.0f);
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    const float2 place = lobe_place(REAL_LANE(c, i), REAL_LANE(alpha, i)) * (LOBE_STEPS - 1u);
    const float x = place.x, y = place.y;
    const u32 x0 = min((u32)x, LOBE_STEPS - 2u), y0 = min((u32)y, LOBE_STEPS - 2u);
    __global const float* at = scene->lobe_energy + first + y0 * LOBE_STEPS + x0;
    const float low = mix(at[0], at[1], x - (float)x0),
                high = mix(at[LOBE_STEPS], at[LOBE_STEPS + 1u], x - (float)x0);
    REAL_LANE(energy, i) = mix(low, high, y - (float)y0);
  }
  return energy;
}
#endif

#if HAS_ROUGH
// The facet width of the surfaces of `lanes`: 0 elsewhere.
#if HAS_LAYER_MAPS
static inline REAL mapped_width(const Bsdfs* bsdf, REAL width, MASK lanes) {
  const MASK layered = lanes & MASK_OF((bsdf->flags & (int)MATERIAL_LAYERED) != 0);
  return select(width, bsdf->roughness * bsdf->roughness, layered);
}
#else
static inline REAL mapped_width(const Bsdfs* bsdf, REAL width, MASK lanes) { return width; }
#endif
static inline REAL facet_width(const Scene* scene, const Bsdfs* bsdf, MASK lanes) {
  REAL width = (REAL)(0.0f);
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    width = select(width, (REAL)(scene->materials[index].reflection.w), mine);
  }
  return mapped_width(bsdf, width, lanes);
}

// Samples the normal of a facet seen by wo, by visible area (Dupuy and Benyoub 2023, "Sampling Visible GGX
// Normals with Spherical Caps"). `alpha` is the width.
static inline REAL3 visible_normal(REAL3 n, REAL3 wo, REAL alpha, REAL u_x, REAL u_y) {
  REAL3 s, t;
  tangent_frame(n, &s, &t);
  const REAL3 stretched =
      safe_unit3(real3(alpha * dot3(wo, s), alpha * dot3(wo, t), real_max(dot3(wo, n), (REAL)(1e-6f))));
  const REAL z = fma(1.0f - u_y, 1.0f + stretched.z, -stretched.z), angle = 2.0f * M_PI_F * u_x;
  const REAL side = real_sqrt(real_clamp(1.0f - z * z, (REAL)(0.0f), (REAL)(1.0f)));
  const REAL3 h = add3(real3(side * cos(angle), side * sin(angle), z), stretched);
  const REAL3 facet = real3(alpha * h.x, alpha * h.y, real_max(h.z, (REAL)(1e-6f)));
  return safe_unit3(add3(scale3(n, facet.z), add3(scale3(s, facet.x), scale3(t, facet.y))));
}

// Smith's masking function for a direction at the cosine c to the normal.
static inline REAL smith_lambda(REAL c, REAL alpha) {
  const REAL square = real_max(c * c, (REAL)(1e-12f));
  return 0.5f * (real_sqrt(1.0f + alpha * alpha * (1.0f - square) / square) - 1.0f);
}

// The albedo of single scattering by white facets seen at the cosine c.
static inline REAL lobe_energy(const Scene* scene, REAL c, REAL alpha, MASK lanes) {
  return lobe_energy_at(scene, 0u, c, alpha, lanes);
}

// The surfaces of `lanes` whose facets scatter multiply.
static inline MASK giving_back(const Bsdfs* bsdf, MASK lanes) {
  return lanes & MASK_OF((bsdf->flags & (int)MATERIAL_SCATTERS_ONCE) == 0);
}

// Refracting rough dielectrics among the surfaces of `lanes`, and the value of their table in
// host/compile/lobe_energy.h by eta, the index behind over before; 1 elsewhere.
#if HAS_ROUGH_GLASS
static inline MASK rough_glass(const Scene* scene, const Bsdfs* bsdf, MASK lanes) {
  MASK glass = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    if (scene->materials[index].kind == MATERIAL_DIELECTRIC) glass |= mine;
  }
  return glass;
}
static inline float glass_cell(__global const float* at, float x, float y) {
  const float low = mix(at[0], at[1], x), high = mix(at[GLASS_STEPS], at[GLASS_STEPS + 1u], x);
  return mix(low, high, y);
}
static inline REAL glass_value(const Scene* scene, REAL eta, REAL c, REAL alpha, MASK lanes) {
  REAL value = (REAL)(1.0f);
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    const float e = REAL_LANE(eta, i), less = 1.0f - fmin(e, 1.0f / e);
    const float z = sqrt(clamp(less / GLASS_REACH, 0.0f, 1.0f)) * (GLASS_INDICES - 1u);
    const float2 place = lobe_place(REAL_LANE(c, i), REAL_LANE(alpha, i)) * (GLASS_STEPS - 1u);
    const float x = place.x, y = place.y;
    const u32 x0 = min((u32)x, GLASS_STEPS - 2u), y0 = min((u32)y, GLASS_STEPS - 2u),
              z0 = min((u32)z, GLASS_INDICES - 2u), side = e > 1.0f ? 0u : 1u;
    __global const float* at =
        scene->lobe_energy + LOBE_GLASS + ((z0 * 2u + side) * GLASS_STEPS + y0) * GLASS_STEPS + x0;
    const float near = glass_cell(at, x - (float)x0, y - (float)y0),
                far = glass_cell(at + 2u * GLASS_STEPS * GLASS_STEPS, x - (float)x0, y - (float)y0);
    REAL_LANE(value, i) = mix(near, far, z - (float)z0);
  }
  return value;
}
// Looks up one of the tables by index and alpha that follow; `rows` per index.
static inline REAL glass_row(const Scene* scene, u32 first, u32 rows, REAL thick, REAL alpha, MASK lanes) {
  REAL value = (REAL)(1.0f);
  for (u32 bits = lane_bits(lanes); bits; bits &= bits - 1u) {
    const u32 i = lowest_bit(bits);
    const float less = 1.0f - 1.0f / REAL_LANE(thick, i);
    const float z = sqrt(clamp(less / GLASS_REACH, 0.0f, 1.0f)) * (GLASS_INDICES - 1u);
    const float y = lobe_place(1.0f, REAL_LANE(alpha, i)).y * (GLASS_STEPS - 1u);
    const u32 y0 = min((u32)y, GLASS_STEPS - 2u), z0 = min((u32)z, GLASS_INDICES - 2u);
    __global const float* at = scene->lobe_energy + first + z0 * rows * GLASS_STEPS + y0;
    __global const float* far = at + rows * GLASS_STEPS;
    REAL_LANE(value, i) =
        mix(mix(at[0], at[1], y - (float)y0), mix(far[0], far[1], y - (float)y0), z - (float)z0);
  }
  return value;
}
#else
static inline MASK rough_glass(const Scene* scene, const Bsdfs* bsdf, MASK lanes) { return NO_LANES; }
static inline REAL glass_value(const Scene* scene, REAL eta, REAL c, REAL alpha, MASK lanes) {
  return (REAL)(1.0f);
}
#endif

// Facets of surfaces, which replace the surface.
typedef struct Facets {
  MASK rough, glass;  // glass: the refracting dielectrics among them
  REAL alpha, lambda_o, energy;
  Bsdfs bsdf;  // the surface's, with the facet's normal if rough
} Facets;

// The energy of rough glass instead of a mirror's.
#if HAS_ROUGH_GLASS
static inline void mend_glass(const Scene* scene, const Bsdfs* bsdf, REAL cosine, Facets* facets) {
  const MASK bends = facets->rough & MASK_OF((bsdf->flags & (int)MATERIAL_TRANSMITS) != 0) &
                     MASK_OF((bsdf->flags & (int)MATERIAL_THIN) == 0);
  const MASK glass = rough_glass(scene, bsdf, giving_back(bsdf, bends));
  const REAL eta = index_behind(scene, bsdf, glass);
  facets->glass = glass & MASK_OF(eta != 1.0f);
  facets->energy =
      select(facets->energy, glass_value(scene, eta, cosine, facets->alpha, facets->glass), facets->glass);
}
#else
static inline void mend_glass(const Scene* scene, const Bsdfs* bsdf, REAL cosine, Facets* facets) {}
#endif

static inline Facets make_facets(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, REAL u_x, REAL u_y,
                                 MASK lanes) {
  Facets facets;
  facets.alpha = facet_width(scene, bsdf, lanes);
  facets.glass = NO_LANES;
  facets.rough = lanes & MASK_OF(facets.alpha > 0.0f);
  facets.bsdf = *bsdf;
  if (!any_lane(facets.rough)) return facets;
  const REAL cosine = dot3(bsdf->ns, wo);
  facets.bsdf.ns = select3(bsdf->ns, visible_normal(bsdf->ns, wo, facets.alpha, u_x, u_y), facets.rough);
  facets.lambda_o = smith_lambda(cosine, facets.alpha);
  facets.energy = lobe_energy(scene, cosine, facets.alpha, giving_back(bsdf, facets.rough));
  mend_glass(scene, bsdf, cosine, &facets);
  return facets;
}

// The weight of light from a lobe of the given colour: its unmasked fraction on the way out, scaled for
// losses by multiple scattering (Turquin 2019, "Practical multiple scattering compensation for microfacet
// models"). `side` is 1 for directions before the surface, -1 behind it.
static inline REAL3 facet_weight(const Facets* facets, const Bsdfs* bsdf, REAL3 wi, float side, REAL3 color,
                                 MASK mends) {
  const REAL c = side * dot3(bsdf->ns, wi);
  const REAL lambda_i = smith_lambda(c, facets->alpha);
  const REAL seen = (1.0f + facets->lambda_o) / (1.0f + facets->lambda_o + lambda_i);
  const MASK out = MASK_OF(c > 0.0f) & MASK_OF(side * dot3(bsdf->ng, wi) > 0.0f);
  const REAL kept = select((REAL)(0.0f), seen, out);
  const REAL more = select((REAL)(0.0f), 1.0f / facets->energy - 1.0f, mends);
  const REAL3 weight = real3(kept * fma(color.x, more, (REAL)(1.0f)), kept * fma(color.y, more, (REAL)(1.0f)),
                             kept * fma(color.z, more, (REAL)(1.0f)));
  return select3(all3((float3)(1.0f)), weight, facets->rough);
}
#endif

#endif
