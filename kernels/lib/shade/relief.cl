// Relief that is not in the geometry: shading normals from normal maps (in the tangent space of Mikkelsen
// 2008, which bakers use) and from heights (Blinn 1978, as a surface gradient: Mikkelsen 2010, "Bump Mapping
// Unparametrized Surfaces on the GPU"). One surface per lane.
#pragma once
#include "lib/shade/maps.cl"

#if HAS_RELIEF
// Decodes a unit direction from 15 and 16 bits (octahedral: Meyer and others 2010); the top bit is the sign
// of the frame.
static inline float4 unpack_tangent(u32 bits) {
  const float x = (float)(bits & 0xFFFFu) * (2.0f / 65535.0f) - 1.0f,
              y = (float)(bits >> 16 & 0x7FFFu) * (2.0f / 32767.0f) - 1.0f;
  const float z = 1.0f - fabs(x) - fabs(y), fold = fmax(-z, 0.0f);
  const float3 t = (float3)(x - copysign(fold, x), y - copysign(fold, y), z);
  return (float4)(t * rsqrt(fmax(dot(t, t), 1e-20f)), bits >> 31 ? -1.0f : 1.0f);
}

// Interpolated tangents of the triangle hits of `lanes`, in object space, and their frames' signs.
static inline void mesh_tangents(const Scene* scene, const SurfaceInteractions* s, MASK lanes, REAL3* tangent,
                                 REAL* sign) {
  EACH_LANE(i, lanes) {
    __global const u32* packed = scene->tangents + 3u * (u32)MASK_LANE(s->prim, i);
    const float4 t0 = unpack_tangent(packed[0]), t1 = unpack_tangent(packed[1]),
                 t2 = unpack_tangent(packed[2]);
    const float b = REAL_LANE(s->b, i), c = REAL_LANE(s->c, i);
    set3(tangent, i, (1.0f - b - c) * t0.xyz + b * t1.xyz + c * t2.xyz);
    REAL_LANE(*sign, i) = t0.w;
  }
}

#define EVEN_ROUNDING 0.01f  // how much a normal's length may lose to 8-bit rounding

// The surfaces' frames: outward shading normal, tangent along u and bitangent along v, in the world, as used
// by a normal map's baker.
typedef struct TangentFrames {
  REAL3 normal, tangent, bitangent;
} TangentFrames;

// Frames of `lanes` on meshes from the meshes' tangents.
static inline void mesh_frames(const Scene* scene, const SurfaceInteractions* s, MASK lanes,
                               TangentFrames* frame) {
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->instance, &left, &index);
    __global const Instance* instance = scene->instances + index;
    if (instance->shape != SHAPE_MESH) continue;
    REAL3 tangent = frame->tangent;
    REAL sign = (REAL)(1.0f);
    mesh_tangents(scene, s, mine, &tangent, &sign);
    tangent = moved_vectors(scene, index, world_vectors(instance, tangent), time_of(s));
    // Mirrored instances reverse the frame.
    const float3 r0 = instance->object_from_world[0].xyz, r1 = instance->object_from_world[1].xyz,
                 r2 = instance->object_from_world[2].xyz;
    if (dot(cross(r0, r1), r2) < 0.0f) sign = -sign;
    frame->tangent = select3(frame->tangent, safe_unit3(tangent), mine);
    frame->bitangent = select3(frame->bitangent, scale3(cross3(frame->normal, frame->tangent), sign), mine);
  }
}

static inline TangentFrames tangent_frames(const Scene* scene, const SurfaceInteractions* s, MASK lanes) {
  TangentFrames frame;
  const REAL3 outward = select3(negate3(s->ns), s->ns, s->entering);
  const REAL along = dot3(outward, s->at.dpdu);
  frame.normal = outward;
  frame.tangent = safe_unit3(along3(s->at.dpdu, -along, outward));
  const REAL3 up = cross3(outward, frame.tangent);
  const REAL one = (REAL)(1.0f);
  frame.bitangent = scale3(up, select(one, -one, MASK_OF(dot3(up, s->at.dpdv) < 0.0f)));
  if (HAS_MESH) mesh_frames(scene, s, lanes, &frame);
  return frame;
}

// The normals of `lanes`, all of one material, from its normal map.
static inline REAL3 mapped_normals(const Scene* scene, __global const MaterialMaps* maps,
                                   const TexturePoints* at, const TangentFrames* frame, MASK lanes,
                                   REAL* even) {
  const REAL4 value = map_value(scene, maps, MAP_NORMAL, at, lanes);
  const REAL scale = (REAL)(2.0f * maps->normal_scale), half_scale = (REAL)(maps->normal_scale);
  const REAL x = fma(value.x, scale, -half_scale), y = fma(value.y, scale, -half_scale);
  const REAL z = fma(value.z, (REAL)(2.0f), (REAL)(-1.0f));
  const REAL3 mean =
      real3(fma(value.x, (REAL)(2.0f), (REAL)(-1.0f)), fma(value.y, (REAL)(2.0f), (REAL)(-1.0f)), z);
  *even = select(*even, real_min(length3(mean) + EVEN_ROUNDING, (REAL)(1.0f)), lanes);
  const float4 turn = maps->normal_turn;
  const REAL u = fma(x, (REAL)(turn.x), y * turn.z), v = fma(x, (REAL)(turn.y), y * turn.w);
  return add3(add3(scale3(frame->tangent, u), scale3(frame->bitangent, v)), scale3(frame->normal, z));
}

// Normals from heights, by three samples: here, and a step along each of dpdu and dpdv.
static inline REAL3 bumped_normals(const Scene* scene, __global const MaterialMaps* maps,
                                   const SurfaceInteractions* s, const TexturePoints* at, REAL3 normal,
                                   MASK lanes) {
  const REAL least = maps->height_texels > 0.0f ? at->uv_length / maps->height_texels : (REAL)(1e-9f);
  const REAL step = real_max(at->footprint, least);
  REAL here = (REAL)(0.0f), slope[2];
  for (u32 k = 0; k < 3u; ++k) {  // a single call, because compilers duplicate a texture's code
    const REAL3 along = k < 2u ? s->at.dpdu : s->at.dpdv;
    const REAL part = step / nonzero(length3(along));
    TexturePoints there = *at;
    if (k == 1u) there.u += part;
    if (k == 2u) there.v += part;
    u32 index;
    for (u32 left = k > 0u ? lane_bits(lanes) : 0u; left;) {
      const MASK mine = take_alike(at->instance, &left, &index);
      __global const Instance* instance = scene->instances + index;
      const REAL3 way = multiply3(vectors_of(scene, index, s, along), all3(instance->pattern_scale.xyz));
      there.p = select3(there.p, along3(at->p, part, way), mine);
    }
    const REAL height = map_value(scene, maps, MAP_HEIGHT, &there, lanes).x;
    if (k == 0u)
      here = height;
    else
      slope[k - 1u] = (height - here) / nonzero(part);
  }
  const REAL3 across_u = cross3(s->at.dpdv, normal), across_v = cross3(normal, s->at.dpdu);
  const REAL area = dot3(normal, cross3(s->at.dpdu, s->at.dpdv));
  const REAL rise = maps->bump / nonzero(at->scale) + maps->bump_uv * at->uv_length;
  const REAL height = rise / nonzero(area);
  return along3(along3(normal, -height * slope[0], across_u), -height * slope[1], across_v);
}

// Bends the normals of the surfaces of `lanes` hit by rays of the directions d. `bent` receives the changed
// lanes.
NEVER_INLINE void add_relief(const Scene* scene, REAL3 d, MASK lanes, SurfaceInteractions* s) {
  s->bent = NO_LANES;
  s->even = (REAL)(1.0f);
  MASK mapped = NO_LANES;
  u32 index;
  for (u32 left = lane_bits(lanes); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    const u32 number = scene->materials[index].maps;
    __global const MaterialMaps* maps = scene->material_maps + number;
    if (number != NO_MAPS && (maps->slot[MAP_NORMAL] != NO_TEXTURE || maps->slot[MAP_HEIGHT] != NO_TEXTURE))
      mapped |= mine;
  }
  if (!any_lane(mapped)) return;
  const TexturePoints at = texture_points(scene, s, mapped);
  const TangentFrames frame = tangent_frames(scene, s, mapped);
  REAL3 normal = frame.normal;
  for (u32 left = lane_bits(mapped); left;) {
    const MASK mine = take_alike(s->material, &left, &index);
    __global const MaterialMaps* maps = scene->material_maps + scene->materials[index].maps;
    if (maps->slot[MAP_NORMAL] != NO_TEXTURE)
      normal = select3(normal, mapped_normals(scene, maps, &at, &frame, mine, &s->even), mine);
    if (maps->slot[MAP_HEIGHT] != NO_TEXTURE && (maps->bump != 0.0f || maps->bump_uv != 0.0f))
      normal = select3(normal, bumped_normals(scene, maps, s, &at, normal, mine), mine);
  }
  s->ns = select3(s->ns, facing_normals(safe_unit3(normal), s->ng, s->entering, d), mapped);
  s->bent = mapped;
}

// The fraction of light from wi that bent normals of `lanes` reflect: none from behind the surface, and less
// near its terminator, as microfacets of the bend's slope occlude each other (Conty Estevez and others 2019,
// "A Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem"; alternatives:
// docs/measurements/textures.md).
static inline REAL terminator(const SurfaceInteractions* s, REAL3 wi) {
  const REAL zero = (REAL)(0.0f), one = (REAL)(1.0f), least = (REAL)(1e-6f);
  const REAL geometric = dot3(s->side, wi), between = dot3(s->side, s->ns);
  const REAL g2 = real_max(geometric * geometric, least), b2 = real_max(between * between, least);
  const REAL alpha2 = real_min(0.125f * real_max(1.0f - b2, zero) / b2, one);
  const REAL soft = 2.0f / (1.0f + real_sqrt(fma(alpha2, real_max(1.0f - g2, zero) / g2, one)));
  return select(one, select(zero, soft, MASK_OF(geometric > 0.0f)), s->bent);
}
#endif
