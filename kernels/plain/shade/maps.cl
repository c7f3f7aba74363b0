// Applies textures to materials: multiplies the surface's terms by texture values. Opacity shows what is
// behind a surface: it attenuates all terms and adds straight transmission.
#include "plain/shade/bsdf.h"
#include "plain/shade/interaction.cl"
#include "plain/shade/texture.cl"

// The values of a material's textures, by MAP_*.
typedef struct LANES(SlotValues) {
  float4 of[20];
} SlotValues;

HAVING(HAS_MAPS);
CONSTANT u32 MAP_SLOTS_USED;

// Where the value of a slot that is used stands.
UNIFORM u32 place_of_slot(UNIFORM u32 slot);

// The texture inputs of a surface. Some need the position on an object, not only u and v; heights need its
// size.
ENTRY static inline TexturePoint texture_points(UNIFORM const Scene* scene, const SurfaceInteraction* s) {
  TexturePoint at;
  at.u = 0.0f;
  at.v = 0.0f;
  at.uv_length = 0.0f;
  if (HAS_UV) {
    at.u = s->at.u;
    at.v = s->at.v;
    at.uv_length = s->at.length;
  }
  at.p = s->p;
  if (HAS_PARALLAX) at.p += s->shift;
  at.n = s->ns;
  at.scale = 1.0f;
  at.footprint = s->footprint;
  at.instance = s->instance;
  at.prim = s->prim;
  at.b = s->b;
  at.c = s->c;
  bool placed = (TEXTURE_MAPPINGS & ~1u) != 0u;
  if (HAS_RELIEF) placed = true;
  if (placed) EACH_ALIKE(u32, index, (u32)s->instance) {
      const float4 scale = scene->instances[index].pattern_scale;
      at.p = points_at(scene, index, at.p, time_of(s)) * scale.xyz;
      at.n = vectors_at(scene, index, s->ng, time_of(s)) * scale.xyz;
      at.scale = scale.w / moved_size(scene, index, time_of(s));
    }
  return at;
}

static inline bool has_slot(UNIFORM __global const MaterialMaps* maps, UNIFORM u32 slot) {
  return (MAP_SLOTS_USED >> slot & 1u) != 0u && maps->slot[slot] != NO_TEXTURE;
}

// The value of one slot, 1 without a texture.
static inline float4 map_value(UNIFORM const Scene* scene, UNIFORM __global const MaterialMaps* maps,
                               UNIFORM u32 slot, const TexturePoint* at) {
  if (HAS_CONES && has_slot(maps, slot)) return value_of_texture(scene, maps->slot[slot], at);
  return (float4)(1.0f);
}

// The values of the slots in the bits of `wanted` that have textures. A single loop, because compilers
// duplicate a texture's code at each call.
ENTRY static inline void read_slots(UNIFORM const Scene* scene, UNIFORM __global const MaterialMaps* maps,
                                    UNIFORM u32 wanted, const TexturePoint* at, SlotValues* values) {
  TexturePoint here = *at;
  if (HAS_CONES)
    for (u32 slot = 0; slot < MAP_COUNT; ++slot)
      if ((wanted >> slot & 1u) != 0u && has_slot(maps, slot)) {
        // A mean of places that are there and others that are not says nothing of either.
        here.footprint = slot == MAP_OPACITY && maps->cutoff > 0.0f ? 0.0f : at->footprint;
        values->of[place_of_slot(slot)] = value_of_texture(scene, maps->slot[slot], &here);
      }
}

static inline float part_of_one(float x) { return real_clamp(x, 0.0f, 1.0f); }
static inline float3 parts_of_one(float4 a) {
  return (float3)(part_of_one(a.x), part_of_one(a.y), part_of_one(a.z));
}

// A slot's value, 1 without a texture.
static inline float4 slot_value(UNIFORM __global const MaterialMaps* maps, const SlotValues* values,
                                UNIFORM u32 slot) {
  if (has_slot(maps, slot)) return values->of[place_of_slot(slot)];
  return (float4)(1.0f);
}
static inline float first_value(UNIFORM __global const MaterialMaps* maps, const SlotValues* values,
                                UNIFORM u32 slot) {
  return slot_value(maps, values, slot).x;
}

// Below 1, what is behind the surface shows through.
static inline float opacity_of(UNIFORM __global const MaterialMaps* maps, const SlotValues* values) {
  const float opacity = part_of_one(maps->opacity * first_value(maps, values, MAP_OPACITY));
  if (maps->cutoff > 0.0f) return opacity >= maps->cutoff ? 1.0f : 0.0f;
  return opacity;
}

static inline void map_term(UNIFORM __global const MaterialMaps* maps, const SlotValues* values,
                            UNIFORM u32 slot, float3* term) {
  if (has_slot(maps, slot)) *term *= values->of[place_of_slot(slot)].xyz;
}

// The terms of a metal-rough material (plain/shade/lowering.h).
HAVING(HAS_METAL_ROUGH)
ENTRY static inline void metal_rough_terms(UNIFORM __global const MaterialMaps* maps,
                                           const SlotValues* values, float3 tint, Bsdf* bsdf) {
  const float4 metal_rough = slot_value(maps, values, MAP_METAL_ROUGH);
  const float metalness = part_of_one(metal_rough.z * maps->base.w);
  const float roughness = part_of_one(metal_rough.y * maps->roughness);
  const float mirror = metal_mirror(metalness, roughness);
  const float3 base = slot_value(maps, values, MAP_DIFFUSE).xyz * maps->base.xyz * tint;
  const float exponent = rough_exponent(roughness), energy = highlight_energy(exponent),
              lobe = metal_highlight(energy, mirror), left = 1.0f - mirror - lobe * metalness;
  // A highlight texture applies to the non-metal part.
  const float3 dull = slot_value(maps, values, MAP_SPECULAR).xyz * (maps->reflectance * (1.0f - metalness));
  bsdf->diffuse =
      base * (float3)(real_max(fma(-lobe, dull.x, left), 0.0f), real_max(fma(-lobe, dull.y, left), 0.0f),
                      real_max(fma(-lobe, dull.z, left), 0.0f));
  bsdf->ambient = bsdf->diffuse * 0.1f;
  bsdf->specular = along(dull, metalness, base) * (lobe / energy);
  bsdf->reflection = base * mirror;
  bsdf->exponent = exponent;
}

// Metalness, roughness and transmission of a layered material's base. The other terms are those of the
// non-metal part; ray terms those of maximum transmission.
static inline float mapped_share(UNIFORM __global const MaterialMaps* maps, const SlotValues* values,
                                 UNIFORM u32 slot, float own) {
  return part_of_one(own * first_value(maps, values, slot));
}
static inline bool maps_base(UNIFORM __global const MaterialMaps* maps) {
  return has_slot(maps, MAP_METALNESS) || has_slot(maps, MAP_GLASS);
}
// The fraction of rays through the surface that metalness and transmission textures leave.
static inline float transmitting_part(UNIFORM const Scene* scene, UNIFORM u32 material,
                                      UNIFORM __global const MaterialMaps* maps, const SlotValues* values) {
  const float metalness = scene->layers[material].specular.w;
  const float glass = part_of_one(first_value(maps, values, MAP_GLASS));
  if (has_slot(maps, MAP_METALNESS))
    return (1.0f - mapped_share(maps, values, MAP_METALNESS, metalness)) * glass;
  return glass;
}
HAVING(HAS_LAYER_MAPS)
static inline void map_base_terms(UNIFORM const Scene* scene, UNIFORM u32 material,
                                  UNIFORM __global const MaterialMaps* maps, const SlotValues* values,
                                  Bsdf* bsdf) {
  bsdf->metalness = mapped_share(maps, values, MAP_METALNESS, bsdf->metalness);
  bsdf->roughness = mapped_share(maps, values, MAP_ROUGHNESS, bsdf->roughness);
  bsdf->glass = mapped_share(maps, values, MAP_GLASS, bsdf->glass);
  if (has_slot(maps, MAP_METALNESS)) bsdf->ambient *= 1.0f - bsdf->metalness;
  if (has_slot(maps, MAP_GLASS)) bsdf->ambient *= 1.0f - bsdf->glass;
  if (!maps_base(maps)) return;
  const float part = transmitting_part(scene, material, maps, values);
  bsdf->reflection *= part;
  bsdf->transmission *= part;
}

// The mirror of a clear layer, which attenuates what lies below.
ENTRY static inline void map_coat(float coat, Bsdf* bsdf) {
  const float kept = 1.0f - coat;
  bsdf->ambient *= kept;
  bsdf->diffuse *= kept;
  bsdf->specular *= kept;
  bsdf->reflection = bsdf->reflection * kept + (float3)(coat, coat, coat);
}

// Attenuates the terms by the opacity; the rest shows what lies behind.
static inline float3 with_open(float3 through, float opacity) {
  const float open = 1.0f - opacity;
  return through * opacity + (float3)(open, open, open);
}
static inline void map_opacity(float opacity, Bsdf* bsdf) {
  bsdf->ambient *= opacity;
  bsdf->diffuse *= opacity;
  bsdf->specular *= opacity;
  bsdf->reflection *= opacity;
  bsdf->emission *= opacity;
  bsdf->transmission = with_open(bsdf->transmission, opacity);
  if (HAS_OPACITY) bsdf->there = opacity;
}

// The textures of the surface's material.
static inline void map_material(UNIFORM const Scene* scene, UNIFORM u32 index, const TexturePoint* at,
                                const SurfaceInteraction* s, Bsdf* bsdf) {
  __global const MaterialMaps* maps = scene->material_maps + scene->materials[index].maps;
  const u32 flags = scene->materials[index].flags;
  bool metal = false;
  if (HAS_METAL_ROUGH) metal = (flags & MATERIAL_METAL_ROUGH) != 0u;
  const bool alike = maps->slot[MAP_AMBIENT] == maps->slot[MAP_DIFFUSE];
  u32 wanted = ~(1u << MAP_NORMAL | 1u << MAP_HEIGHT);
  if (metal || alike) wanted &= ~(1u << MAP_AMBIENT);
  SlotValues values;
  read_slots(scene, maps, wanted, at, &values);
  if (HAS_METAL_ROUGH && metal) metal_rough_terms(maps, &values, s->color, bsdf);
  if (!metal) {
    map_term(maps, &values, MAP_DIFFUSE, &bsdf->diffuse);
    map_term(maps, &values, alike ? (u32)MAP_DIFFUSE : (u32)MAP_AMBIENT, &bsdf->ambient);
    map_term(maps, &values, MAP_SPECULAR, &bsdf->specular);
  }
  map_term(maps, &values, MAP_REFLECTION, &bsdf->reflection);
  map_term(maps, &values, MAP_TRANSMISSION, &bsdf->transmission);
  map_term(maps, &values, MAP_EMISSION, &bsdf->emission);
  if (HAS_LAYER_MAPS) map_base_terms(scene, index, maps, &values, bsdf);
  if (HAS_COAT_MAPS && has_slot(maps, MAP_COAT))
    bsdf->coat = part_of_one(first_value(maps, &values, MAP_COAT));
  if (HAS_SPECULAR_MAPS && has_slot(maps, MAP_SPECULAR))
    bsdf->tint = parts_of_one(slot_value(maps, &values, MAP_SPECULAR));
  if (HAS_FUZZ_MAPS && has_slot(maps, MAP_FUZZ))
    bsdf->fuzz = parts_of_one(slot_value(maps, &values, MAP_FUZZ));
  if (has_slot(maps, MAP_EXPONENT)) bsdf->exponent *= first_value(maps, &values, MAP_EXPONENT);
  if (has_slot(maps, MAP_OCCLUSION))
    bsdf->ambient *= fma(maps->occlusion, first_value(maps, &values, MAP_OCCLUSION) - 1.0f, 1.0f);
  if (maps->coat > 0.0f) map_coat(maps->coat * first_value(maps, &values, MAP_COAT), bsdf);
  const bool one_sided = (flags & MATERIAL_ONE_SIDED) != 0u;
  if (maps->opacity == 1.0f && !has_slot(maps, MAP_OPACITY) && !one_sided) return;
  map_opacity(one_sided && !s->entering ? 0.0f : opacity_of(maps, &values), bsdf);
}
static void map_bsdf(UNIFORM const Scene* scene, const SurfaceInteraction* s, Bsdf* bsdf) {
  const TexturePoint at = texture_points(scene, s);
  EACH_ALIKE(u32, index, (u32)s->material) map_material(scene, index, &at, s, bsdf);
}

// Widens a highlight on normals that vary within the footprint, and weakens it accordingly (Toksvig 2005,
// "Mipmapping Normal Maps").
ENTRY static inline void widen_highlight(float even, float* exponent, float3* specular) {
  const float e = *exponent, wide = e * even / nonzero(fma(e, 1.0f - even, even));
  if (even < 1.0f) {
    *specular = *specular * ((1.0f + wide) / (1.0f + e));
    *exponent = wide;
  }
}

// The surface's transmittance for a shadow ray; `own`: without its textures.
static inline float3 mapped_filter(UNIFORM const Scene* scene, const SurfaceInteraction* s, bool hidden,
                                   float3 own) {
  const TexturePoint at = texture_points(scene, s);
  float3 passed = own;
  EACH_ALIKE(u32, index, (u32)s->material) {
    __global const MaterialMaps* maps = scene->material_maps + scene->materials[index].maps;
    u32 wanted = 1u << MAP_TRANSMISSION | 1u << MAP_OPACITY;
    if (HAS_LAYER_MAPS) wanted |= 1u << MAP_METALNESS | 1u << MAP_GLASS;
    SlotValues values;
    read_slots(scene, maps, wanted, &at, &values);
    map_term(maps, &values, MAP_TRANSMISSION, &passed);
    if (HAS_LAYER_MAPS && maps_base(maps)) passed *= transmitting_part(scene, index, maps, &values);
    const bool absent = (scene->materials[index].flags & MATERIAL_ONE_SIDED) != 0u && hidden;
    passed = with_open(passed, absent ? 0.0f : opacity_of(maps, &values));
  }
  return passed;
}
