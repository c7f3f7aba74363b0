// What textures make of materials: the terms of surfaces, each times the value of its texture. Opacity shows
// what is behind a surface: it takes from all terms and adds to the straight transmission. A surface a lane.
#ifndef SUNDOG_LIB_MAPS_CL
#define SUNDOG_LIB_MAPS_CL
#include "lib/shade/interaction.cl"
#include "lib/shade/texture.cl"
#include "shared/metal_rough.h"

#if HAS_MAPS
// The terms of surfaces that textures change.
typedef struct Terms {
  REAL3 ambient, diffuse, specular, reflection, transmission;
  REAL3 emission;  // a factor on the material's
  REAL exponent;
} Terms;

// The surfaces of `lanes` as textures see them.
static inline void texture_points(const Scene* scene, const SurfaceInteractions* s, MASK lanes,
                                  TexturePoints* at) {
  at->instance = s->instance;
  at->prim = s->prim;
  at->b = s->b;
  at->c = s->c;
  at->footprint = s->footprint;
  at->u = at->v = at->uv_length = (REAL)(0.0f);
#if HAS_UV
  at->u = s->at.u;
  at->v = s->at.v;
  at->uv_length = s->at.length;
#endif
  REAL3 p = s->p;
#if HAS_PARALLAX
  p = add3(p, s->shift);
#endif
  at->p = p;
  at->n = s->ns;
  at->scale = (REAL)(1.0f);
  u32 index;
  while (any_lane(lanes)) {
    const MASK mine = take_alike(s->instance, &lanes, &index);
    __global const Instance* instance = scene->instances + index;
    const float4 scale = instance->pattern_scale;
    at->p = select3(at->p, multiply3(object_points(instance, p), all3(scale.xyz)), mine);
    at->scale = select(at->scale, (REAL)(scale.w), mine);
    at->n = select3(at->n, multiply3(object_vectors(instance, s->ng), all3(scale.xyz)), mine);
  }
}

// The values of a slot, 1 where it has no texture.
static inline REAL4 slot_values(const Scene* scene, __global const MaterialMaps* maps, u32 slot,
                                const TexturePoints* at, MASK lanes) {
  const REAL one = (REAL)(1.0f);
#if TEXTURE_KINDS
  if (maps->slot[slot] != NO_TEXTURE) return value_of_texture(scene, maps->slot[slot], at, lanes);
#endif
  return real4(one, one, one, one);
}

// What of surfaces is there: all below 1 lets what is behind it through.
static inline REAL opacity_at(const Scene* scene, __global const MaterialMaps* maps, const TexturePoints* at,
                              MASK lanes) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const REAL opacity =
      real_clamp(maps->opacity * slot_values(scene, maps, MAP_OPACITY, at, lanes).x, zero, one);
  return maps->cutoff > 0.0f ? select(zero, one, MASK_OF(opacity >= maps->cutoff)) : opacity;
}

static inline void scale_term(REAL3* term, REAL4 factor, MASK lanes) {
  *term = select3(*term, multiply3(*term, real3(factor.x, factor.y, factor.z)), lanes);
}
static inline void map_term(const Scene* scene, __global const MaterialMaps* maps, u32 slot,
                            const TexturePoints* at, MASK lanes, REAL3* term) {
  if (maps->slot[slot] == NO_TEXTURE) return;
  scale_term(term, slot_values(scene, maps, slot, at, lanes), lanes);
}

#if HAS_METAL_ROUGH
// The terms of `lanes`, all of one material by metalness and roughness (shared/metal_rough.h).
static inline void metal_rough_terms(const Scene* scene, __global const MaterialMaps* maps,
                                     const TexturePoints* at, REAL3 tint, MASK lanes, Terms* terms) {
  const REAL4 color = slot_values(scene, maps, MAP_DIFFUSE, at, lanes),
              metal_rough = slot_values(scene, maps, MAP_METAL_ROUGH, at, lanes);
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const REAL metalness = real_clamp(metal_rough.z * maps->base.w, zero, one);
  const REAL roughness = real_clamp(metal_rough.y * maps->roughness, zero, one);
  const REAL mirror = metal_mirror(metalness, roughness);
  const REAL3 base = multiply3(multiply3(real3(color.x, color.y, color.z), all3(maps->base.xyz)), tint);
  const REAL3 diffuse = scale3(base, 1.0f - mirror);
  const REAL plain = maps->reflectance * (1.0f - metalness);
  terms->diffuse = select3(terms->diffuse, diffuse, lanes);
  terms->ambient = select3(terms->ambient, scale3(diffuse, (REAL)(0.1f)), lanes);
  terms->specular = select3(terms->specular, along3(real3(plain, plain, plain), metalness, base), lanes);
  terms->reflection = select3(terms->reflection, scale3(base, mirror), lanes);
  terms->exponent = select(terms->exponent, rough_exponent(roughness), lanes);
}
#endif

// Multiplies the terms of `lanes`, all of one material, by its textures.
static inline void map_material(const Scene* scene, __global const MaterialMaps* maps, u32 flags,
                                const TexturePoints* at, const SurfaceInteractions* s, MASK lanes,
                                Terms* terms) {
  const bool metal = HAS_METAL_ROUGH && flags & MATERIAL_METAL_ROUGH;
#if HAS_METAL_ROUGH
  if (metal) metal_rough_terms(scene, maps, at, s->color, lanes, terms);
#endif
  if (!metal && maps->slot[MAP_DIFFUSE] != NO_TEXTURE) {
    const REAL4 diffuse = slot_values(scene, maps, MAP_DIFFUSE, at, lanes);
    scale_term(&terms->diffuse, diffuse, lanes);
    if (maps->slot[MAP_AMBIENT] == maps->slot[MAP_DIFFUSE]) scale_term(&terms->ambient, diffuse, lanes);
  }
  if (!metal && maps->slot[MAP_AMBIENT] != maps->slot[MAP_DIFFUSE])
    map_term(scene, maps, MAP_AMBIENT, at, lanes, &terms->ambient);
  map_term(scene, maps, MAP_SPECULAR, at, lanes, &terms->specular);
  map_term(scene, maps, MAP_REFLECTION, at, lanes, &terms->reflection);
  map_term(scene, maps, MAP_TRANSMISSION, at, lanes, &terms->transmission);
  map_term(scene, maps, MAP_EMISSION, at, lanes, &terms->emission);
  if (maps->slot[MAP_EXPONENT] != NO_TEXTURE) {
    const REAL exponent = slot_values(scene, maps, MAP_EXPONENT, at, lanes).x;
    terms->exponent = select(terms->exponent, terms->exponent * exponent, lanes);
  }
  if (maps->slot[MAP_OCCLUSION] != NO_TEXTURE) {
    const REAL open = slot_values(scene, maps, MAP_OCCLUSION, at, lanes).x;
    const REAL kept = fma((REAL)(maps->occlusion), open - 1.0f, (REAL)(1.0f));
    terms->ambient = select3(terms->ambient, scale3(terms->ambient, kept), lanes);
  }
  const bool one_sided = flags & MATERIAL_ONE_SIDED;
  if (maps->opacity == 1.0f && maps->slot[MAP_OPACITY] == NO_TEXTURE && !one_sided) return;
  REAL opacity = opacity_at(scene, maps, at, lanes);
  if (one_sided) opacity = select((REAL)(0.0f), opacity, s->entering);
  const REAL4 part = real4(opacity, opacity, opacity, opacity);
  scale_term(&terms->ambient, part, lanes);
  scale_term(&terms->diffuse, part, lanes);
  scale_term(&terms->specular, part, lanes);
  scale_term(&terms->reflection, part, lanes);
  scale_term(&terms->emission, part, lanes);
  scale_term(&terms->transmission, part, lanes);
  const REAL behind = 1.0f - opacity;
  terms->transmission =
      select3(terms->transmission, add3(terms->transmission, real3(behind, behind, behind)), lanes);
}

// The same for all of `lanes`, which have MaterialMaps.
NEVER_INLINE void map_terms(const Scene* scene, const SurfaceInteractions* s, MASK lanes, Terms* terms) {
  TexturePoints at;
  texture_points(scene, s, lanes, &at);
  u32 index;
  while (any_lane(lanes)) {
    const MASK mine = take_alike(s->material, &lanes, &index);
    __global const Material* material = scene->materials + index;
    map_material(scene, scene->material_maps + material->maps, material->flags, &at, s, mine, terms);
  }
}
#endif

#endif
