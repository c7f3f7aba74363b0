// Applies textures to materials: multiplies the surfaces' terms by texture values. Opacity shows what is
// behind a surface: it attenuates all terms and adds straight transmission. One surface per lane.
#ifndef SUNDOG_LIB_MAPS_CL
#define SUNDOG_LIB_MAPS_CL
#include "lib/shade/interaction.cl"
#include "lib/shade/texture.cl"
#include "shared/layers.h"
#include "shared/metal_rough.h"

#if HAS_MAPS
// The terms that textures change.
typedef struct Terms {
  REAL3 ambient, diffuse, specular, reflection, transmission;
  REAL3 emission;  // factor on the material's
  REAL exponent;
#if HAS_LAYERS
  REAL there;  // opacity
#endif
#if HAS_LAYER_MAPS
  REAL metalness, roughness, glass;  // of layered materials
#endif
#if HAS_COAT_MAPS
  REAL coat;  // factor on a layered material's coat weight
#endif
#if HAS_SPECULAR_MAPS
  REAL3 tint;  // factor on the reflectance of a layered material's dielectric
#endif
#if HAS_FUZZ_MAPS
  REAL3 fuzz;  // factor on a layered material's fuzz color
#endif
} Terms;

#if HAS_LAYERS
static inline void make_opaque(Terms* terms) { terms->there = (REAL)(1.0f); }
static inline void set_opacity(REAL opacity, MASK lanes, Terms* terms) {
  terms->there = select(terms->there, opacity, lanes);
}
#else
static inline void make_opaque(Terms* terms) {}
static inline void set_opacity(REAL opacity, MASK lanes, Terms* terms) {}
#endif
#if HAS_LAYER_MAPS
static inline void start_smooth(Terms* terms) {
  terms->metalness = terms->roughness = terms->glass = (REAL)(0.0f);
}
#else
static inline void start_smooth(Terms* terms) {}
#endif

#if HAS_COAT_MAPS
static inline void start_coat(Terms* terms) { terms->coat = (REAL)(1.0f); }
#else
static inline void start_coat(Terms* terms) {}
#endif
#if HAS_SPECULAR_MAPS
static inline void start_tint(Terms* terms) { terms->tint = all3((float3)(1.0f)); }
#else
static inline void start_tint(Terms* terms) {}
#endif

#if HAS_FUZZ_MAPS
static inline void start_fuzz(Terms* terms) { terms->fuzz = all3((float3)(1.0f)); }
#else
static inline void start_fuzz(Terms* terms) {}
#endif

// Initial terms, before the material's own are added.
static inline Terms start_terms(REAL3 ambient, REAL3 diffuse) {
  const REAL3 none = all3((float3)(0.0f));
  Terms terms;
  terms.ambient = ambient;
  terms.diffuse = diffuse;
  terms.specular = terms.reflection = terms.transmission = none;
  terms.emission = all3((float3)(1.0f));
  terms.exponent = (REAL)(0.0f);
  make_opaque(&terms);
  start_smooth(&terms);
  start_coat(&terms);
  start_tint(&terms);
  start_fuzz(&terms);
  return terms;
}

// Textures need the position on an object, not only u and v; heights need its size.
#define TEXTURES_PLACED (HAS_RELIEF || (TEXTURE_MAPPINGS & ~1u))

// Texture inputs that need a feature: coordinates, and the point in a relief.
#if HAS_UV
static inline void take_coordinates(const SurfaceInteractions* s, TexturePoints* at) {
  at->u = s->at.u;
  at->v = s->at.v;
  at->uv_length = s->at.length;
}
#else
static inline void take_coordinates(const SurfaceInteractions* s, TexturePoints* at) {
  at->u = at->v = at->uv_length = (REAL)(0.0f);
}
#endif
#if HAS_PARALLAX
static inline REAL3 shifted_points(const SurfaceInteractions* s) { return add3(s->p, s->shift); }
#else
static inline REAL3 shifted_points(const SurfaceInteractions* s) { return s->p; }
#endif

// The texture inputs of the surfaces of `lanes`.
static inline void texture_points(const Scene* scene, const SurfaceInteractions* s, MASK lanes,
                                  TexturePoints* at) {
  at->instance = s->instance;
  at->prim = s->prim;
  at->b = s->b;
  at->c = s->c;
  at->footprint = s->footprint;
  take_coordinates(s, at);
  const REAL3 p = shifted_points(s);
  at->p = p;
  at->n = s->ns;
  at->scale = (REAL)(1.0f);
  if (!TEXTURES_PLACED) return;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->instance, &left, &index);
    __global const Instance* instance = scene->instances + index;
    const float4 scale = instance->pattern_scale;
    at->p = select3(at->p, multiply3(points_of(scene, index, s, p), all3(scale.xyz)), mine);
    at->scale = select(at->scale, scale.w / moved_size(scene, index, time_of(s)), mine);
    at->n = select3(at->n, multiply3(vectors_of(scene, index, s, s->ng), all3(scale.xyz)), mine);
  }
}

static inline bool has_slot(__global const MaterialMaps* maps, u32 slot) {
  return TEXTURE_KINDS && maps->slot[slot] != NO_TEXTURE;
}

// The values of a slot, 1 without a texture.
static inline REAL4 slot_values(const Scene* scene, __global const MaterialMaps* maps, u32 slot,
                                const TexturePoints* at, MASK lanes) {
  const REAL one = (REAL)(1.0f);
  if (has_slot(maps, slot)) return value_of_texture(scene, maps->slot[slot], at, lanes);
  return real4(one, one, one, one);
}

// The values of a material's textures.
typedef struct SlotValues {
  REAL4 of[MAP_COUNT];
} SlotValues;

// Reads the slots in the bits of `wanted` that have textures. A single loop, because compilers duplicate a
// texture's code at each call.
static inline void read_slots(const Scene* scene, __global const MaterialMaps* maps, u32 wanted,
                              const TexturePoints* at, MASK lanes, SlotValues* values) {
  for (u32 slot = 0; slot < MAP_COUNT; ++slot)
    if (wanted >> slot & 1u && has_slot(maps, slot))
      values->of[slot] = value_of_texture(scene, maps->slot[slot], at, lanes);
}
static inline REAL first_value(__global const MaterialMaps* maps, const SlotValues* values, u32 slot) {
  return has_slot(maps, slot) ? values->of[slot].x : (REAL)(1.0f);
}

// The opacity of surfaces: below 1, what is behind them shows through.
static inline REAL opacity_of(__global const MaterialMaps* maps, const SlotValues* values) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const REAL opacity = real_clamp(maps->opacity * first_value(maps, values, MAP_OPACITY), zero, one);
  return maps->cutoff > 0.0f ? select(zero, one, MASK_OF(opacity >= maps->cutoff)) : opacity;
}

static inline void scale_term(REAL3* term, REAL4 factor, MASK lanes) {
  *term = select3(*term, multiply3(*term, real3(factor.x, factor.y, factor.z)), lanes);
}
static inline void map_term(__global const MaterialMaps* maps, const SlotValues* values, u32 slot, MASK lanes,
                            REAL3* term) {
  if (has_slot(maps, slot)) scale_term(term, values->of[slot], lanes);
}

// The terms of `lanes`, all of one metal-rough material (shared/metal_rough.h).
static inline void metal_rough_terms(__global const MaterialMaps* maps, const SlotValues* values, REAL3 tint,
                                     MASK lanes, Terms* terms) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const REAL4 white = real4(one, one, one, one);
  const REAL4 color = has_slot(maps, MAP_DIFFUSE) ? values->of[MAP_DIFFUSE] : white,
              metal_rough = has_slot(maps, MAP_METAL_ROUGH) ? values->of[MAP_METAL_ROUGH] : white;
  const REAL metalness = real_clamp(metal_rough.z * maps->base.w, zero, one);
  const REAL roughness = real_clamp(metal_rough.y * maps->roughness, zero, one);
  const REAL mirror = metal_mirror(metalness, roughness);
  const REAL3 base = multiply3(multiply3(real3(color.x, color.y, color.z), all3(maps->base.xyz)), tint);
  const REAL exponent = rough_exponent(roughness), energy = highlight_energy(exponent),
             lobe = metal_highlight(energy, mirror), left = 1.0f - mirror - lobe * metalness;
  // A highlight texture applies to the non-metal part.
  const REAL4 shine = has_slot(maps, MAP_SPECULAR) ? values->of[MAP_SPECULAR] : white;
  const REAL3 plain = scale3(real3(shine.x, shine.y, shine.z), maps->reflectance * (1.0f - metalness));
  const REAL3 diffuse = multiply3(
      base, real3(real_max(fma(-lobe, plain.x, left), zero), real_max(fma(-lobe, plain.y, left), zero),
                  real_max(fma(-lobe, plain.z, left), zero)));
  terms->diffuse = select3(terms->diffuse, diffuse, lanes);
  terms->ambient = select3(terms->ambient, scale3(diffuse, (REAL)(0.1f)), lanes);
  terms->specular = select3(terms->specular, scale3(along3(plain, metalness, base), lobe / energy), lanes);
  terms->reflection = select3(terms->reflection, scale3(base, mirror), lanes);
  terms->exponent = select(terms->exponent, exponent, lanes);
}

// The ambient and diffuse terms, which often share a texture, and those of metal-rough materials.
static inline void map_colors(__global const MaterialMaps* maps, const SlotValues* values, bool metal,
                              bool shared, REAL3 tint, MASK lanes, Terms* terms) {
  if (HAS_METAL_ROUGH && metal) {
    metal_rough_terms(maps, values, tint, lanes, terms);
    return;
  }
  map_term(maps, values, MAP_DIFFUSE, lanes, &terms->diffuse);
  map_term(maps, values, shared ? MAP_DIFFUSE : MAP_AMBIENT, lanes, &terms->ambient);
}

// Metalness, roughness and transmission of a layered material's base. The other terms are those of the
// non-metal part; ray terms those of maximum transmission.
#if HAS_LAYER_MAPS
static inline REAL mapped_share(__global const MaterialMaps* maps, const SlotValues* values, u32 slot,
                                REAL plain) {
  return real_clamp(plain * first_value(maps, values, slot), (REAL)(0.0f), (REAL)(1.0f));
}
static inline void keep_share(REAL3* term, REAL share, MASK lanes) {
  scale_term(term, real4(share, share, share, share), lanes);
}
// The fraction of rays through the surface that metalness and transmission textures leave.
static inline REAL transmitting_part(__global const MaterialMaps* maps, const SlotValues* values,
                                     float metalness) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const REAL left = has_slot(maps, MAP_METALNESS)
                        ? 1.0f - mapped_share(maps, values, MAP_METALNESS, (REAL)(metalness))
                        : one;
  return left * real_clamp(first_value(maps, values, MAP_GLASS), zero, one);
}
static inline void map_base_terms(const Scene* scene, u32 material, __global const MaterialMaps* maps,
                                  const SlotValues* values, MASK lanes, Terms* terms) {
  const REAL metalness = mapped_share(maps, values, MAP_METALNESS, terms->metalness),
             roughness = mapped_share(maps, values, MAP_ROUGHNESS, terms->roughness),
             glass = mapped_share(maps, values, MAP_GLASS, terms->glass);
  terms->metalness = select(terms->metalness, metalness, lanes);
  terms->roughness = select(terms->roughness, roughness, lanes);
  terms->glass = select(terms->glass, glass, lanes);
  if (has_slot(maps, MAP_METALNESS)) keep_share(&terms->ambient, 1.0f - metalness, lanes);
  if (has_slot(maps, MAP_GLASS)) keep_share(&terms->ambient, 1.0f - glass, lanes);
  if (!has_slot(maps, MAP_METALNESS) && !has_slot(maps, MAP_GLASS)) return;
  const REAL part = transmitting_part(maps, values, scene->layers[material].specular.w);
  keep_share(&terms->reflection, part, lanes);
  keep_share(&terms->transmission, part, lanes);
}
// Likewise for shadow rays, for the material of this index.
#define BASE_SLOTS (1u << MAP_METALNESS | 1u << MAP_GLASS)
static inline void stop_at_base(const Scene* scene, u32 material, __global const MaterialMaps* maps,
                                const SlotValues* values, MASK lanes, REAL3* passed) {
  if (has_slot(maps, MAP_METALNESS) || has_slot(maps, MAP_GLASS))
    keep_share(passed, transmitting_part(maps, values, scene->layers[material].specular.w), lanes);
}
#else
#define BASE_SLOTS 0u
static inline void stop_at_base(const Scene* scene, u32 material, __global const MaterialMaps* maps,
                                const SlotValues* values, MASK lanes, REAL3* passed) {}
static inline void map_base_terms(const Scene* scene, u32 material, __global const MaterialMaps* maps,
                                  const SlotValues* values, MASK lanes, Terms* terms) {}
#endif

// The coat weight of a layered material.
#if HAS_COAT_MAPS
static inline void map_coat_weight(__global const MaterialMaps* maps, const SlotValues* values, MASK lanes,
                                   Terms* terms) {
  if (has_slot(maps, MAP_COAT))
    terms->coat = select(terms->coat, real_clamp(values->of[MAP_COAT].x, (REAL)(0.0f), (REAL)(1.0f)), lanes);
}
#else
static inline void map_coat_weight(__global const MaterialMaps* maps, const SlotValues* values, MASK lanes,
                                   Terms* terms) {}
#endif

#if HAS_SPECULAR_MAPS || HAS_FUZZ_MAPS
static inline void map_shares(__global const MaterialMaps* maps, const SlotValues* values, u32 slot,
                              MASK lanes, REAL3* shares) {
  if (!has_slot(maps, slot)) return;
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f);
  const REAL4 value = values->of[slot];
  const REAL3 mapped =
      real3(real_clamp(value.x, zero, one), real_clamp(value.y, zero, one), real_clamp(value.z, zero, one));
  *shares = select3(*shares, mapped, lanes);
}
#endif

// The reflectance of a layered material's dielectric, and its fuzz.
#if HAS_SPECULAR_MAPS
static inline void map_tint(__global const MaterialMaps* maps, const SlotValues* values, MASK lanes,
                            Terms* terms) {
  map_shares(maps, values, MAP_SPECULAR, lanes, &terms->tint);
}
#else
static inline void map_tint(__global const MaterialMaps* maps, const SlotValues* values, MASK lanes,
                            Terms* terms) {}
#endif

#if HAS_FUZZ_MAPS
static inline void map_fuzz(__global const MaterialMaps* maps, const SlotValues* values, MASK lanes,
                            Terms* terms) {
  map_shares(maps, values, MAP_FUZZ, lanes, &terms->fuzz);
}
#else
static inline void map_fuzz(__global const MaterialMaps* maps, const SlotValues* values, MASK lanes,
                            Terms* terms) {}
#endif

// Adds the mirror of a clear layer, which attenuates what lies below.
static inline void map_coat(REAL coat, MASK lanes, Terms* terms) {
  const REAL kept = 1.0f - coat;
  const REAL4 below = real4(kept, kept, kept, kept);
  scale_term(&terms->ambient, below, lanes);
  scale_term(&terms->diffuse, below, lanes);
  scale_term(&terms->specular, below, lanes);
  scale_term(&terms->reflection, below, lanes);
  terms->reflection = select3(terms->reflection, add3(terms->reflection, real3(coat, coat, coat)), lanes);
}

// Attenuates the terms of `lanes` by their opacity; the rest shows what lies behind.
static inline void map_opacity(REAL opacity, MASK lanes, Terms* terms) {
  const REAL4 part = real4(opacity, opacity, opacity, opacity);
  scale_term(&terms->ambient, part, lanes);
  scale_term(&terms->diffuse, part, lanes);
  scale_term(&terms->specular, part, lanes);
  scale_term(&terms->reflection, part, lanes);
  scale_term(&terms->emission, part, lanes);
  scale_term(&terms->transmission, part, lanes);
  set_opacity(opacity, lanes, terms);
  const REAL behind = 1.0f - opacity;
  terms->transmission =
      select3(terms->transmission, add3(terms->transmission, real3(behind, behind, behind)), lanes);
}

// Multiplies the terms of `lanes`, all of one material, by its textures.
static inline void map_material(const Scene* scene, u32 index, const TexturePoints* at,
                                const SurfaceInteractions* s, MASK lanes, Terms* terms) {
  __global const MaterialMaps* maps = scene->material_maps + scene->materials[index].maps;
  const u32 flags = scene->materials[index].flags;
  const bool metal = HAS_METAL_ROUGH && flags & MATERIAL_METAL_ROUGH;
  const bool shared = maps->slot[MAP_AMBIENT] == maps->slot[MAP_DIFFUSE];
  u32 wanted = ~(1u << MAP_NORMAL | 1u << MAP_HEIGHT);
  if (metal || shared) wanted &= ~(1u << MAP_AMBIENT);
  SlotValues values;
  read_slots(scene, maps, wanted, at, lanes, &values);
  map_colors(maps, &values, metal, shared, s->color, lanes, terms);
  if (!metal) map_term(maps, &values, MAP_SPECULAR, lanes, &terms->specular);
  map_term(maps, &values, MAP_REFLECTION, lanes, &terms->reflection);
  map_term(maps, &values, MAP_TRANSMISSION, lanes, &terms->transmission);
  map_term(maps, &values, MAP_EMISSION, lanes, &terms->emission);
  map_base_terms(scene, index, maps, &values, lanes, terms);
  map_coat_weight(maps, &values, lanes, terms);
  map_tint(maps, &values, lanes, terms);
  map_fuzz(maps, &values, lanes, terms);
  if (has_slot(maps, MAP_EXPONENT))
    terms->exponent = select(terms->exponent, terms->exponent * values.of[MAP_EXPONENT].x, lanes);
  if (has_slot(maps, MAP_OCCLUSION)) {
    const REAL open = values.of[MAP_OCCLUSION].x;
    const REAL kept = fma((REAL)(maps->occlusion), open - 1.0f, (REAL)(1.0f));
    terms->ambient = select3(terms->ambient, scale3(terms->ambient, kept), lanes);
  }
  if (maps->coat > 0.0f) map_coat(maps->coat * first_value(maps, &values, MAP_COAT), lanes, terms);
  const bool one_sided = flags & MATERIAL_ONE_SIDED;
  if (maps->opacity == 1.0f && !has_slot(maps, MAP_OPACITY) && !one_sided) return;
  const REAL opacity = opacity_of(maps, &values);
  map_opacity(one_sided ? select((REAL)(0.0f), opacity, s->entering) : opacity, lanes, terms);
}

#if HAS_RELIEF
// Widens a highlight on normals that vary within the footprint, and weakens it accordingly (Toksvig 2005,
// "Mipmapping Normal Maps").
static inline void widen_highlights(REAL even, REAL* exponent, REAL3* specular) {
  const REAL e = *exponent, wide = e * even / nonzero(fma(e, 1.0f - even, even));
  const MASK uneven = MASK_OF(even < 1.0f);
  *specular = select3(*specular, scale3(*specular, (1.0f + wide) / (1.0f + e)), uneven);
  *exponent = select(e, wide, uneven);
}
static inline void even_highlights(const SurfaceInteractions* s, Terms* terms) {
  widen_highlights(s->even, &terms->exponent, &terms->specular);
}
#else
static inline void even_highlights(const SurfaceInteractions* s, Terms* terms) {}
#endif

// Applies textures to all of `lanes`, which have MaterialMaps.
NEVER_INLINE void map_terms(const Scene* scene, const SurfaceInteractions* s, MASK lanes, Terms* terms) {
  TexturePoints at;
  texture_points(scene, s, lanes, &at);
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    map_material(scene, index, &at, s, mine, terms);
  }
}
#endif

#endif
