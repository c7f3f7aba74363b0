// Phong's and Blinn's local terms (Phong 1975, Blinn 1977), and perfect reflection and transmission of
// Whitted's model (1980). One surface per lane; wo points to the viewer, wi to the light.
#ifndef SUNDOG_LIB_BSDF_CL
#define SUNDOG_LIB_BSDF_CL
#include "lib/core/directions.cl"
#include "lib/core/optics.cl"
#include "lib/shade/bsdf_terms.cl"

// Replacements for the diffuse term in layered materials (shared/layers.h).
#if HAS_LAYERS
// Sets the frame about ns, with the tangent along `along`, for `lanes` of one material.
static inline void turn_frame(__global const Layers* m, REAL3 along, MASK lanes, Bsdfs* bsdf) {
  const REAL3 flat = along3(along, -dot3(along, bsdf->ns), bsdf->ns);
  const MASK good = MASK_OF(dot3(flat, flat) > 1e-20f * dot3(along, along));
  REAL3 s, t;
  tangent_frame(bsdf->ns, &s, &t);
  const REAL3 first = select3(s, safe_unit3(flat), good);
  const REAL3 second =
      real3(bsdf->ns.y * first.z - bsdf->ns.z * first.y, bsdf->ns.z * first.x - bsdf->ns.x * first.z,
            bsdf->ns.x * first.y - bsdf->ns.y * first.x);
  const REAL x = (REAL)(m->turn_x), y = (REAL)(m->turn_y);
  bsdf->tangent = select3(bsdf->tangent, along3(scale3(first, x), y, second), lanes);
  bsdf->bitangent = select3(bsdf->bitangent, along3(scale3(second, x), -y, first), lanes);
}

#if HAS_UV
static inline REAL3 first_coordinate(const SurfaceInteractions* s) { return s->at.dpdu; }
#else
static inline REAL3 first_coordinate(const SurfaceInteractions* s) { return all3((float3)(0.0f)); }
#endif
static inline void add_layers(const Scene* scene, const SurfaceInteractions* s, MASK lanes, Bsdfs* bsdf) {
  const MASK layered = lanes & MASK_OF((bsdf->flags & (int)MATERIAL_LAYERED) != 0);
  const MASK outside = s->entering | MASK_OF((bsdf->flags & (int)MATERIAL_THIN) != 0);
  const REAL3 none = all3((float3)(0.0f));
  bsdf->base = scale3(bsdf->diffuse, 1.0f / real_max(bsdf->there, (REAL)(1e-6f)));
  bsdf->base = real3(real_min(bsdf->base.x, (REAL)(1.0f)), real_min(bsdf->base.y, (REAL)(1.0f)),
                     real_min(bsdf->base.z, (REAL)(1.0f)));
  bsdf->diffuse = select3(bsdf->diffuse, none, layered);
  bsdf->tangent = bsdf->bitangent = none;
  bsdf->coated = layered & outside;
  bsdf->coated_behind = layered & ~outside;
  u32 index;
  for (u32 left = lane_bits(layered); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    turn_frame(scene->layers + index, first_coordinate(s), mine, bsdf);
  }
}
static inline void start_opaque(Bsdfs* bsdf) { bsdf->there = (REAL)(1.0f); }
// The surfaces' albedo, for metals as for diffuse materials.
static inline REAL3 albedo_of(const Bsdfs* bsdf) {
  const MASK layered = MASK_OF((bsdf->flags & (int)MATERIAL_LAYERED) != 0);
  return select3(bsdf->diffuse, scale3(bsdf->base, bsdf->there), layered);
}
#else
static inline REAL3 albedo_of(const Bsdfs* bsdf) { return bsdf->diffuse; }
static inline void add_layers(const Scene* scene, const SurfaceInteractions* s, MASK lanes, Bsdfs* bsdf) {}
static inline void start_opaque(Bsdfs* bsdf) {}
#endif

// The Bsdfs of the surfaces of `lanes`, between the media `before` and `after`.
static inline Bsdfs make_bsdfs(const Scene* scene, const SurfaceInteractions* s, MASK before, MASK after,
                               MASK lanes) {
  const REAL3 none = all3((float3)(0.0f));
  Bsdfs bsdf;
  bsdf.ng = s->ng;
  bsdf.ns = s->ns;
  bsdf.ambient = none;
  bsdf.diffuse = none;
  bsdf.material = s->material;
  bsdf.flags = s->flags;
  bsdf.before = before;
  bsdf.after = after;
  set_wavelength_row(&bsdf, (REAL)(0.0f));
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    __global const Material* material = scene->materials + index;
    bsdf.ambient = select3(bsdf.ambient, all3(material->ambient.xyz), mine);
    bsdf.diffuse = select3(bsdf.diffuse, all3(material->diffuse.xyz), mine);
    if (material->flags & MATERIAL_CHECKER) add_checker(scene, material, s, mine, &bsdf);
  }
  bsdf.ambient = multiply3(bsdf.ambient, s->color);
  bsdf.diffuse = multiply3(bsdf.diffuse, s->color);
  start_opaque(&bsdf);
  add_maps(scene, s, lanes, &bsdf);
  add_layers(scene, s, lanes, &bsdf);
  return bsdf;
}

// x^e for x in [0, 1]. Integer exponents, the common case, by squaring.
static inline REAL highlight(REAL x, float e) {
  if (HAS_FRACTIONAL_EXPONENTS && (e != floor(e) || e > GREATEST_WHOLE_EXPONENT))
    return select(real_exp(e * real_log(real_max(x, (REAL)(1e-37f)))), (REAL)(0.0f), MASK_OF(x < 1e-37f));
  REAL result = (REAL)(1.0f);
  for (u32 bits = (u32)e; bits; bits >>= 1) {
    if (bits & 1u) result *= x;
    x *= x;
  }
  return result;
}

// Cosine that a highlight falls off with: between the reflected light and the viewer or, for Blinn, between
// the normal and the half vector.
static inline REAL highlight_cosine(u32 flags, REAL3 ns, REAL3 wo, REAL3 wi) {
  if (flags & MATERIAL_BLINN) return dot3(ns, safe_unit3(add3(wi, wo)));
  return -dot3(subtract3(wi, scale3(ns, 2.0f * dot3(ns, wi))), wo);
}

// The surfaces of `lanes` whose materials have any of the flags.
static inline MASK of_kind(const Bsdfs* bsdf, u32 flags, MASK lanes) {
  return lanes & MASK_OF((bsdf->flags & (int)flags) != 0);
}

// Adds the highlights of the surfaces of `lanes`.
#if HAS_MAPS
// Colour and exponent may come from textures, so the exponent may be fractional.
static inline REAL3 add_highlights(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, REAL3 wi, MASK lanes,
                                   REAL3 light) {
  if (!any_lane(lanes & MASK_OF(greatest3(bsdf->specular) > 0.0f))) return light;
  REAL cosine = (REAL)(0.0f);
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    cosine = select(cosine, highlight_cosine(scene->materials[index].flags, bsdf->ns, wo, wi), mine);
  }
  const REAL x = real_clamp(cosine, (REAL)(0.0f), (REAL)(1.0f));
  const REAL power = real_exp(bsdf->exponent * real_log(real_max(x, (REAL)(1e-37f))));
  const REAL shine = select(power, (REAL)(0.0f), MASK_OF(x < 1e-37f) & MASK_OF(bsdf->exponent > 0.0f));
  return add3(light, scale3(bsdf->specular, shine));
}
#else
static inline REAL3 add_highlights(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, REAL3 wi, MASK lanes,
                                   REAL3 light) {
  REAL3 sum = light;
  u32 index;
  for (u32 left = lane_bits(of_kind(bsdf, MATERIAL_SHINES, lanes)); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    const float4 specular = scene->materials[index].specular;
    const REAL cosine = highlight_cosine(scene->materials[index].flags, bsdf->ns, wo, wi);
    const REAL shine = highlight(real_clamp(cosine, (REAL)(0.0f), (REAL)(1.0f)), specular.w);
    const MASK shines = specular.w == 0.0f ? mine : mine & MASK_OF(cosine > 0.0f);
    sum = select3(sum, along3(sum, shine, all3(specular.xyz)), shines);
  }
  return sum;
}
#endif

// kd (n.l) + ks max(r.v, 0)^beta, or max(n.h, 0)^beta for Blinn, where 0^0 is 1: with beta 0 a highlight is
// uniform. This is pi times the BSDF times the cosine, in the classical units where a white surface that
// faces a light of intensity 1 has radiance 1. Excludes perfect reflection and transmission. For n.l > 0.
static inline REAL3 bsdf_eval(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, REAL3 wi, MASK lanes) {
  return add_highlights(scene, bsdf, wo, wi, lanes, scale3(bsdf->diffuse, dot3(bsdf->ns, wi)));
}

// How surfaces divide light between perfect reflection and transmission.
typedef struct SpecularSplits {
  REAL3 kr, kt;
  MASK branches, transmits;  // has either; transmits
  REAL eta, cos_i, cos_t;    // index behind over index before; cosines to ns, 1 if nothing bends
  REAL f;                    // Fresnel reflectance of a dielectric, else 0
} SpecularSplits;

#if HAS_MAPS
static inline REAL3 reflection_of(const Bsdfs* bsdf, __global const Material* material) {
  return bsdf->reflection;
}
static inline REAL3 transmission_of(const Bsdfs* bsdf, __global const Material* material) {
  return bsdf->transmission;
}
#else
static inline REAL3 reflection_of(const Bsdfs* bsdf, __global const Material* material) {
  return all3(material->reflection.xyz);
}
static inline REAL3 transmission_of(const Bsdfs* bsdf, __global const Material* material) {
  return all3(material->transmission.xyz);
}
#endif

// Reflectance of both faces of a thin wall at the cosine c: 2 R / (1 + R), the sum of all reflections between
// them, with the reflectance R of one face (Stokes 1862, "On the Intensity of the Light Reflected from or
// Transmitted through a Pile of Plates", without polarisation).
#if HAS_THIN_WALLS
static inline REAL wall_reflectance(REAL c, REAL index) {
  const REAL r = fresnel_reflectance(c, refracted_cosine(c, index), index);
  return 2.0f * r / (1.0f + r);
}

// The surfaces of `lanes` that are such walls.
static inline MASK walls_of(MASK flags, MASK lanes) {
  const int kind = (int)(MATERIAL_THIN | MATERIAL_WALL);
  return lanes & MASK_OF((flags & kind) == kind);
}

// The reflectance of those walls; `f` for other surfaces.
static inline REAL reflected_by_walls(const Scene* scene, MASK materials, MASK flags, REAL c, REAL f,
                                      MASK lanes) {
  REAL reflected = f;
  u32 index;
  for (u32 left = lane_bits(walls_of(flags, lanes)); left;) {
    const MASK mine = take_alike(materials, &left, &index);
    const REAL own = wall_reflectance(c, (REAL)(scene->materials[index].transmission.w));
    reflected = select(reflected, own, mine);
  }
  return reflected;
}
#else
static inline MASK walls_of(MASK flags, MASK lanes) { return NO_LANES; }
static inline REAL reflected_by_walls(const Scene* scene, MASK materials, MASK flags, REAL c, REAL f,
                                      MASK lanes) {
  return f;
}
#endif

static inline SpecularSplits bsdf_specular(const Scene* scene, const Bsdfs* bsdf, REAL3 wo, MASK lanes) {
  const REAL3 none = all3((float3)(0.0f));
  const REAL one = (REAL)(1.0f), zero = (REAL)(0.0f);
  SpecularSplits split = {none, none, NO_LANES, NO_LANES, one, one, one, zero};
  MASK dielectric = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(of_kind(bsdf, MATERIAL_REFLECTS | MATERIAL_TRANSMITS, lanes)); left;) {
    const MASK mine = take_alike(bsdf->material, &left, &index);
    __global const Material* material = scene->materials + index;
    split.kr = select3(split.kr, reflection_of(bsdf, material), mine);
    split.kt = select3(split.kt, transmission_of(bsdf, material), mine);
    split.branches |= mine;
    if (material->kind == MATERIAL_DIELECTRIC) dielectric |= mine;
  }
  split.transmits = split.branches & MASK_OF((bsdf->flags & (int)MATERIAL_TRANSMITS) != 0);
  if (!any_lane(split.transmits | dielectric)) return split;
  const MASK bends = split.transmits & MASK_OF((bsdf->flags & (int)MATERIAL_THIN) == 0);
  split.cos_i = real_clamp(dot3(bsdf->ns, wo), zero, one);
  split.eta = index_behind(scene, bsdf, bends);
  split.cos_t = refracted_cosine(split.cos_i, split.eta);
  const REAL bent = select(zero, fresnel_reflectance(split.cos_i, split.cos_t, split.eta), bends);
  const REAL f = reflected_by_walls(scene, bsdf->material, bsdf->flags, split.cos_i, bent, split.branches);
  split.f = select(zero, f, dielectric);
  // Total internal reflection reflects everything.
  const MASK total = split.transmits & ~dielectric & MASK_OF(split.cos_t <= 0.0f);
  split.kr = select3(split.kr, add3(split.kr, split.kt), total);
  split.kt = select3(split.kt, none, total);
  split.kr = select3(split.kr, scale3(split.kr, f), dielectric);
  split.kt = select3(split.kt, scale3(split.kt, 1.0f - f), dielectric);
  return split;
}

// The surfaces of `lanes` that are absent, because their material is cut away or seen from its missing side:
// light goes straight on. Rays pass as many of them as unseen interfaces.
#if HAS_MAPS
static inline MASK has_highlights(const Bsdfs* bsdf) { return MASK_OF(greatest3(bsdf->specular) > 0.0f); }
#else
static inline MASK has_highlights(const Bsdfs* bsdf) {
  return MASK_OF((bsdf->flags & (int)MATERIAL_SHINES) != 0);
}
#endif
static inline MASK cut_away(const Bsdfs* bsdf, const SpecularSplits* split, MASK lanes) {
  if (!HAS_SHADOW_FILTERS) return NO_LANES;
  const MASK thin = split->transmits & MASK_OF((bsdf->flags & (int)MATERIAL_THIN) != 0);
  const MASK open =
      MASK_OF(split->kt.x == 1.0f) & MASK_OF(split->kt.y == 1.0f) & MASK_OF(split->kt.z == 1.0f);
  const REAL3 rest = add3(split->kr, bsdf->diffuse);
  return lanes & thin & open & MASK_OF(rest.x + rest.y + rest.z == 0.0f) & ~has_highlights(bsdf);
}

// Direction of perfect reflection; a shading normal must not send it inside.
static inline REAL3 reflected_direction(const Bsdfs* bsdf, REAL3 wo) {
  const REAL3 d = negate3(wo), by_shading = reflect_direction(d, bsdf->ns);
  const MASK good = MASK_OF(dot3(by_shading, bsdf->ng) > 0.0f);
  return select3(reflect_direction(d, bsdf->ng), by_shading, good);
}

// Direction of transmission; a shading normal must not send it outside again.
static inline REAL3 transmitted_direction(const Bsdfs* bsdf, const SpecularSplits* split, REAL3 wo) {
  const REAL3 d = negate3(wo);
  const REAL3 by_shading = refract_direction(d, bsdf->ns, split->cos_i, split->cos_t, split->eta);
  const MASK good = MASK_OF(dot3(by_shading, bsdf->ng) < 0.0f), straight = MASK_OF(split->eta == 1.0f);
  const REAL cos_g = real_clamp(dot3(bsdf->ng, wo), (REAL)(0.0f), (REAL)(1.0f));
  const REAL3 by_face =
      refract_direction(d, bsdf->ng, cos_g, refracted_cosine(cos_g, split->eta), split->eta);
  return select3(select3(by_face, by_shading, good), d, straight);
}

#endif
