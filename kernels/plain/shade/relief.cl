// Relief that is not in the geometry: shading normals from normal maps (in the tangent space of Mikkelsen
// 2008, which bakers use) and from heights (Blinn 1978, as a surface gradient: Mikkelsen 2010, "Bump Mapping
// Unparametrized Surfaces on the GPU").
#include "plain/shade/maps.cl"

HAVING(HAS_RELIEF);

// A unit direction from 15 and 16 bits (octahedral: Meyer and others 2010); the top bit is the sign of the
// frame.
static inline float3 unpack_tangent(u32 bits) {
  const float x = (float)(bits & 0xFFFFu) * (2.0f / 65535.0f) - 1.0f,
              y = (float)(bits >> 16 & 0x7FFFu) * (2.0f / 32767.0f) - 1.0f;
  const float z = 1.0f - fabs(x) - fabs(y), fold = fmax(-z, 0.0f);
  const float3 t = (float3)(x - copysign(fold, x), y - copysign(fold, y), z);
  return t * rsqrt(fmax(plain_dot(t, t), 1e-20f));
}

#define EVEN_ROUNDING 0.01f  // how much a normal's length may lose to 8-bit rounding

// The surface's frame: outward shading normal, tangent along u and bitangent along v, in the world, as used
// by a normal map's baker.
typedef struct TangentFrame {
  float3 normal, tangent, bitangent;
} TangentFrame;

static inline TangentFrame tangent_frame_of(UNIFORM const Scene* scene, const SurfaceInteraction* s) {
  TangentFrame frame;
  const float3 outward = s->entering ? s->ns : -s->ns;
  frame.normal = outward;
  frame.tangent = safe_unit3(along(s->at.dpdu, -dot(outward, s->at.dpdu), outward));
  const float3 up = cross(outward, frame.tangent);
  frame.bitangent = up * (dot(up, s->at.dpdv) < 0.0f ? -1.0f : 1.0f);
  if (HAS_MESH) EACH_ALIKE(u32, index, (u32)s->instance) {
      __global const Instance* instance = scene->instances + index;
      if (instance->shape == SHAPE_MESH) {
        const u32 at = 3u * (u32)s->prim, first = scene->tangents[at];
        const float3 mean = unpack_tangent(first) * (1.0f - s->b - s->c) +
                            unpack_tangent(scene->tangents[at + 1u]) * s->b +
                            unpack_tangent(scene->tangents[at + 2u]) * s->c;
        frame.tangent = safe_unit3(moved_vectors(scene, index, world_vector(instance, mean), time_of(s)));
        // Mirrored instances reverse the frame.
        const float3 r0 = instance->object_from_world[0].xyz, r1 = instance->object_from_world[1].xyz,
                     r2 = instance->object_from_world[2].xyz;
        const float sign = (first >> 31 != 0u) != (plain_dot(cross(r0, r1), r2) < 0.0f) ? -1.0f : 1.0f;
        frame.bitangent = cross(frame.normal, frame.tangent) * sign;
      }
    }
  return frame;
}

// The normal that the material's normal map gives; `even` receives the length of the mean normal there.
static inline float3 mapped_normal(UNIFORM const Scene* scene, UNIFORM __global const MaterialMaps* maps,
                                   const TexturePoint* at, const TangentFrame* frame, float* even) {
  const float4 value = map_value(scene, maps, MAP_NORMAL, at);
  const float scale = 2.0f * maps->normal_scale, half_scale = maps->normal_scale;
  const float x = fma(value.x, scale, -half_scale), y = fma(value.y, scale, -half_scale),
              z = fma(value.z, 2.0f, -1.0f);
  const float3 mean = (float3)(fma(value.x, 2.0f, -1.0f), fma(value.y, 2.0f, -1.0f), z);
  *even = real_min(length(mean) + EVEN_ROUNDING, 1.0f);
  const float4 turn = maps->normal_turn;
  return frame->tangent * fma(x, turn.x, y * turn.z) + frame->bitangent * fma(x, turn.y, y * turn.w) +
         frame->normal * z;
}

// The point `part` of dpdu (k = 1) or dpdv (k = 2) away; the same for k = 0.
static inline TexturePoint point_beside(UNIFORM const Scene* scene, const SurfaceInteraction* s,
                                        const TexturePoint* at, UNIFORM u32 k, float3 way, float part) {
  TexturePoint there = *at;
  if (k < 1u) return there;
  if (k < 2u)
    there.u += part;
  else
    there.v += part;
  EACH_ALIKE(u32, index, (u32)at->instance)
  there.p = along(at->p, part,
                  vectors_at(scene, index, way, time_of(s)) * scene->instances[index].pattern_scale.xyz);
  return there;
}

// The normal from heights, by three samples: here, and a step along each of dpdu and dpdv.
static inline float3 bumped_normal(UNIFORM const Scene* scene, UNIFORM __global const MaterialMaps* maps,
                                   const SurfaceInteraction* s, const TexturePoint* at, float3 normal) {
  const float least = maps->height_texels > 0.0f ? at->uv_length / maps->height_texels : 1e-9f;
  const float step = real_max(at->footprint, least);
  float here = 0.0f, slope[2];
  for (u32 k = 0; k < 3u; ++k) {  // a single call, because compilers duplicate a texture's code
    const float3 way = k < 2u ? s->at.dpdu : s->at.dpdv;
    const float part = step / nonzero(length(way));
    const TexturePoint there = point_beside(scene, s, at, k, way, part);
    const float height = map_value(scene, maps, MAP_HEIGHT, &there).x;
    if (k < 1u)
      here = height;
    else
      slope[k - 1u] = (height - here) / nonzero(part);
  }
  const float3 across_u = cross(s->at.dpdv, normal), across_v = cross(normal, s->at.dpdu);
  const float area = dot(normal, cross(s->at.dpdu, s->at.dpdv));
  const float rise = maps->bump / nonzero(at->scale) + maps->bump_uv * at->uv_length;
  const float height = rise / nonzero(area);
  return along(along(normal, -height * slope[0], across_u), -height * slope[1], across_v);
}

// Bends the normal of a surface that a ray of the direction d has hit.
ENTRY static void add_relief(UNIFORM const Scene* scene, float3 d, OUT SurfaceInteraction* s) {
  bool mapped = false;
  EACH_ALIKE(u32, number, (u32)s->material) {
    __global const MaterialMaps* maps = scene->material_maps + scene->materials[number].maps;
    mapped = scene->materials[number].maps != NO_MAPS &&
             (maps->slot[MAP_NORMAL] != NO_TEXTURE || maps->slot[MAP_HEIGHT] != NO_TEXTURE);
  }
  s->bent = mapped;
  s->even = 1.0f;
  if (!mapped) return;
  const TexturePoint at = texture_points(scene, s);
  const TangentFrame frame = tangent_frame_of(scene, s);
  float3 normal = frame.normal;
  float even = 1.0f;
  EACH_ALIKE(u32, index, (u32)s->material) {
    __global const MaterialMaps* maps = scene->material_maps + scene->materials[index].maps;
    if (maps->slot[MAP_NORMAL] != NO_TEXTURE) normal = mapped_normal(scene, maps, &at, &frame, &even);
    if (maps->slot[MAP_HEIGHT] != NO_TEXTURE && (maps->bump != 0.0f || maps->bump_uv != 0.0f))
      normal = bumped_normal(scene, maps, s, &at, normal);
  }
  s->even = even;
  s->ns = facing_normal(safe_unit3(normal), s->ng, s->entering, d);
}

// The fraction of light from wi that a bent normal reflects: none from behind the surface, and less near its
// terminator, as microfacets of the bend's slope occlude each other (Conty Estevez and others 2019, "A
// Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem"; alternatives:
// docs/measurements/textures.md).
ENTRY static inline float terminator(const SurfaceInteraction* s, float3 wi) {
  const float geometric = dot(s->side, wi), between = dot(s->side, s->ns);
  const float g2 = real_max(geometric * geometric, 1e-6f), b2 = real_max(between * between, 1e-6f);
  const float alpha2 = real_min(0.125f * real_max(1.0f - b2, 0.0f) / b2, 1.0f);
  const float soft = 2.0f / (1.0f + real_sqrt(fma(alpha2, real_max(1.0f - g2, 0.0f) / g2, 1.0f)));
  if (!s->bent) return 1.0f;
  return geometric > 0.0f ? soft : 0.0f;
}
