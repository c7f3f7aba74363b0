// Textures of materials at surfaces, for plain/shade/maps.cl. One surface per lane.
#pragma once
#include "lib/shade/interaction.cl"
#include "lib/shade/texture.cl"
#include "shared/metal_rough.h"

#if HAS_MAPS
// Textures need the position on an object, not only u and v; heights need its size.
#define TEXTURES_PLACED (HAS_RELIEF || (TEXTURE_MAPPINGS & ~1u))

// The texture inputs of the surfaces of `lanes`.
static inline void texture_points(const Scene* scene, const SurfaceInteractions* s, MASK lanes,
                                  TexturePoints* at) {
  at->instance = s->instance;
  at->prim = s->prim;
  at->b = s->b;
  at->c = s->c;
  at->footprint = s->footprint;
#if HAS_UV
  at->u = s->at.u;
  at->v = s->at.v;
  at->uv_length = s->at.length;
#else
  at->u = at->v = at->uv_length = (REAL)(0.0f);
#endif
#if HAS_PARALLAX
  const REAL3 p = add3(s->p, s->shift);
#else
  const REAL3 p = s->p;
#endif
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
#endif
