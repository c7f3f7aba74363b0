// Evaluates textures at surface points, node by node (shared/textures.h). One point per lane.
#pragma once
#include "lib/core/transform.cl"
#include "lib/shade/parametrize.cl"
#include "lib/shade/patterns.cl"
#include "lib/shade/texels.cl"

#if HAS_MAPS
// Inputs of textures at surface points.
typedef struct TexturePoints {
  REAL u, v;       // v up
  REAL uv_length;  // world length of a unit of u and v (geometric mean); 0: unknown
  REAL3 p, n;      // point and normal in object units; n need not be unit
  REAL scale;      // object units per world unit
  REAL footprint;  // width of the ray's footprint on the surface, in the world
  MASK instance, prim;
  REAL b, c;  // barycentric coordinates of a triangle's second and third corner
} TexturePoints;

#if TEXTURE_KINDS
#include "generated/patterns.cl"

#define HAS_KIND(kind) (TEXTURE_KINDS >> (kind) & 1u)
#define HAS_MAPPING(mapping) (TEXTURE_MAPPINGS & (1u << (mapping)))

// Points in a node's coordinates, and node units per world unit.
typedef struct MappedPoints {
  REAL3 q;
  REAL density;
  REAL3 across;  // fraction of the footprint along each axis; it has no extent along the normal
} MappedPoints;

// Offset of lane i from a triangle's first corner in a further set with edges d1 and d2. If u and v of the
// first set have moved along the surface, by a bump's step or by parallax, the others move with them.
static inline float2 moved_corners(const TexturePoints* at, __global const Vertex* v0,
                                   __global const Vertex* v1, __global const Vertex* v2, u32 i, float2 d1,
                                   float2 d2) {
  float b = REAL_LANE(at->b, i), c = REAL_LANE(at->c, i);
  if (HAS_RELIEF) {
    const float2 e1 = (float2)(v1->u - v0->u, v1->v - v0->v), e2 = (float2)(v2->u - v0->u, v2->v - v0->v);
    const float du = REAL_LANE(at->u, i) - (v0->u + b * e1.x + c * e2.x),
                dv = REAL_LANE(at->v, i) - (v0->v + b * e1.y + c * e2.y);
    const float area = e1.x * e2.y - e2.x * e1.y;
    if (area != 0.0f) {
      b += (du * e2.y - dv * e2.x) / area;
      c += (e1.x * dv - e1.y * du) / area;
    }
  }
  return b * d1 + c * d2;
}

// u, v and their unit's length in the set `set` for triangles; solids have only the first set.
static inline REAL3 coordinates_of_set(const Scene* scene, const TexturePoints* at, u32 set, MASK lanes) {
  REAL3 coordinates = real3(at->u, at->v, at->uv_length);
  if (!EXTRA_UVS | !HAS_MESH | (set == 0u)) return coordinates;
  __global const float* uvs = scene->extra_uvs + 2u * (set - 1u);
  EACH_LANE(i, lanes) {
    if (scene->instances[MASK_LANE(at->instance, i)].shape != SHAPE_MESH) continue;
    __global const u32* corner = scene->triangles[MASK_LANE(at->prim, i)].vertex;
    const float2 uv0 = vload2(corner[0] * EXTRA_UVS, uvs), d1 = vload2(corner[1] * EXTRA_UVS, uvs) - uv0,
                 d2 = vload2(corner[2] * EXTRA_UVS, uvs) - uv0;
    __global const Vertex* v0 = scene->vertices + corner[0];
    __global const Vertex* v1 = scene->vertices + corner[1];
    __global const Vertex* v2 = scene->vertices + corner[2];
    // By areas relative to the first set, whose unit's length is known.
    const float known = fabs((v1->u - v0->u) * (v2->v - v0->v) - (v2->u - v0->u) * (v1->v - v0->v));
    const float area = fabs(d1.x * d2.y - d2.x * d1.y);
    const float2 uv = uv0 + moved_corners(at, v0, v1, v2, i, d1, d2);
    set3(&coordinates, i,
         (float3)(uv, area > 0.0f ? REAL_LANE(at->uv_length, i) * sqrt(known / area) : 0.0f));
  }
  return coordinates;
}

static inline REAL row_times(float4 row, REAL3 p) {
  return fma((REAL)(row.x), p.x, fma((REAL)(row.y), p.y, fma((REAL)(row.z), p.z, (REAL)(row.w))));
}
static inline REAL3 rows_times(__global const TextureNode* node, REAL3 p) {
  return real3(row_times(node->rows[0], p), row_times(node->rows[1], p), row_times(node->rows[2], p));
}

// Transforms u and v of a mapping to the texture's.
static inline MappedPoints map_uv(__global const TextureNode* node, REAL u, REAL v, REAL density) {
  const float4 a = node->uv_rows[0], b = node->uv_rows[1];
  const MappedPoints mapped = {real3(fma((REAL)(a.x), u, fma((REAL)(a.y), v, (REAL)(a.z))),
                                     fma((REAL)(b.x), u, fma((REAL)(b.y), v, (REAL)(b.z))), (REAL)(0.0f)),
                               density * node->scale, all3((float3)(1.0f, 1.0f, 0.0f))};
  return mapped;
}

static inline MappedPoints map_points(const Scene* scene, __global const TextureNode* node,
                                      const TexturePoints* at, MASK lanes) {
  const u32 mapping = node->mapping & MAPPING_KIND;
  const REAL zero = (REAL)(0.0f);
  if (mapping == MAPPING_UV) {
    const REAL3 set = coordinates_of_set(scene, at, node->mapping >> MAPPING_SET_SHIFT, lanes);
    return map_uv(node, set.x, set.y, select(zero, 1.0f / nonzero(set.z), MASK_OF(set.z > 0.0f)));
  }
  const REAL3 q = rows_times(node, at->p);
  if ((HAS_MAPPING(2) | HAS_MAPPING(3)) && (mapping == MAPPING_SPHERICAL || mapping == MAPPING_CYLINDRICAL)) {
    const REAL r = radius_about_y(q), u = turns(q.x, -q.z);
    const bool sphere = mapping == MAPPING_SPHERICAL;
    const REAL v = sphere ? 0.5f + 2.0f * copysign(turns(r, fabs(q.y)), q.y) : q.y;
    const REAL area = sphere ? 2.0f * M_PI_F * M_PI_F * r * length3(q) : 2.0f * M_PI_F * r;
    return map_uv(node, u, v, at->scale * real_rsqrt(real_max(area, (REAL)(1e-12f))));
  }
  if (TEXEL_FORMATS && node->kind == TEXTURE_IMAGE) return map_uv(node, q.x, q.y, at->scale);
  // A pattern's placement rotates and scales uniformly, so normals transform like vectors.
  const float4 x = node->rows[0], y = node->rows[1], z = node->rows[2];
  const REAL3 n = unit3(real3(dot3(all3(x.xyz), at->n), dot3(all3(y.xyz), at->n), dot3(all3(z.xyz), at->n)));
  const MappedPoints mapped = {q, node->scale * at->scale, sines_to_axes(n)};
  return mapped;
}

static inline REAL4 mapped_image(const Scene* scene, __global const TextureNode* node,
                                 const TexturePoints* at, MappedPoints mapped, MASK lanes) {
  return sample_image(scene, node, mapped.q.x, mapped.q.y, at->footprint * mapped.density, lanes);
}

// The image on six sides of a box, blended by the normal's components.
static inline REAL4 image_on_box(const Scene* scene, __global const TextureNode* node,
                                 const TexturePoints* at, MASK lanes) {
  const REAL3 q = rows_times(node, at->p), n = unit3(rows_times(node, at->n)), zero = all3((float3)(0.0f));
  const REAL3 n2 = multiply3(n, n), weight = multiply3(n2, n2);
  const REAL sum = real_max(weight.x + weight.y + weight.z, (REAL)(1e-12f)), one = (REAL)(1.0f);
  const REAL u[3] = {-copysign(one, n.x) * q.z, q.x, copysign(one, n.z) * q.x};
  const REAL v[3] = {q.y, -copysign(one, n.y) * q.z, q.y};
  const REAL share[3] = {weight.x / sum, weight.y / sum, weight.z / sum};
  REAL4 mixed = real4(zero.x, zero.x, zero.x, zero.x);
  for (u32 axis = 0; axis < 3u; ++axis) {
    const MASK mine = lanes & MASK_OF(share[axis] > 1e-3f);
    if (!any_lane(mine)) continue;
    const REAL4 side = mapped_image(scene, node, at, map_uv(node, u[axis], v[axis], at->scale), mine);
    const REAL s = select(zero.x, share[axis], mine);
    mixed = real4(fma(s, side.x, mixed.x), fma(s, side.y, mixed.y), fma(s, side.z, mixed.z),
                  fma(s, side.w, mixed.w));
  }
  return mixed;
}

static inline REAL4 image_values(const Scene* scene, __global const TextureNode* node,
                                 const TexturePoints* at, MASK lanes) {
  if (HAS_MAPPING(4) && (node->mapping & MAPPING_KIND) == MAPPING_BOX)
    return image_on_box(scene, node, at, lanes);
  return mapped_image(scene, node, at, map_points(scene, node, at, lanes), lanes);
}

// The number of a pattern.
static inline REAL pattern_value(__global const TextureNode* node, MappedPoints mapped, REAL w) {
  const REAL3 q = mapped.q;
  const float a = node->parameter[0], b = node->parameter[1], c = node->parameter[2];
  const u32 kind = node->kind;
  if (HAS_KIND(2) && kind == TEXTURE_CHECKER) return checker_pattern(q, scale3(mapped.across, w));
  if (HAS_KIND(3) && kind == TEXTURE_STRIPES) return pulse(q.x, a, w * mapped.across.x);
  if (HAS_KIND(5) && kind == TEXTURE_BRICK) return brick_pattern(q, scale3(mapped.across, w), a, b);
  if (HAS_KIND(6) && kind == TEXTURE_NOISE) return 0.5f + 0.5f * octave_noise(q, w, (u32)a, b, c != 0.0f);
  if (HAS_KIND(7) && kind == TEXTURE_CELLS) return cell_distance(q, w);
  if (HAS_KIND(8) && kind == TEXTURE_MARBLE) return marble_pattern(q, w, (u32)a, b, c);
  if (HAS_KIND(9) && kind == TEXTURE_WOOD) return wood_pattern(q, w, (u32)a, b, c);
  return real_clamp(q.x, (REAL)(0.0f), (REAL)(1.0f));
}

// Vertex colours of meshes.
static inline REAL4 vertex_colors(const Scene* scene, const TexturePoints* at, MASK lanes) {
  const REAL one = (REAL)(1.0f);
  REAL4 colors = real4(one, one, one, one);
  EACH_LANE(i, lanes) {
    if (scene->instances[MASK_LANE(at->instance, i)].shape != SHAPE_MESH) continue;
    __global const u32* corner = scene->triangles[MASK_LANE(at->prim, i)].vertex;
    const float b = REAL_LANE(at->b, i), c = REAL_LANE(at->c, i), share[3] = {1.0f - b - c, b, c};
    float4 sum = (float4)(0.0f);
    for (u32 k = 0; k < 3u; ++k) {
      __global const Vertex* vertex = scene->vertices + corner[k];
      sum += share[k] * (float4)(vertex->r, vertex->g, vertex->b, scene->vertex_alphas[corner[k]]);
    }
    REAL_LANE(colors.x, i) = sum.x;
    REAL_LANE(colors.y, i) = sum.y;
    REAL_LANE(colors.z, i) = sum.z;
    REAL_LANE(colors.w, i) = sum.w;
  }
  return colors;
}

// The value of a node's kind at points.
static inline REAL4 node_values(const Scene* scene, __global const TextureNode* node, const TexturePoints* at,
                                MASK lanes) {
  const REAL zero = (REAL)(0.0f);
  if (node->kind == TEXTURE_COLOR) return real4(zero, zero, zero, zero);
  if (TEXEL_FORMATS && node->kind == TEXTURE_IMAGE) return image_values(scene, node, at, lanes);
  if (HAS_KIND(13) && node->kind == TEXTURE_VERTEX_COLOR) return vertex_colors(scene, at, lanes);
  const MappedPoints mapped = map_points(scene, node, at, lanes);
  const REAL width = at->footprint * mapped.density;
  if (HAS_KIND(12) && node->kind == TEXTURE_FORMULA)
    return pattern_formula(node->count, mapped.q, width, scene->texture_values + node->first);
  const REAL t = pattern_value(node, mapped, width);
  return real4(t, t, t, t);
}

// A ramp's colour at t: interpolated between stops, constant beyond the ends.
static inline REAL4 ramp_color(const Scene* scene, __global const TextureNode* node, REAL t) {
  __global const float* stop = scene->texture_values + node->first;
  REAL3 color = all3((float3)(stop[1], stop[2], stop[3]));
  for (u32 i = 1; i < node->count; ++i, stop += 4) {
    const float from = stop[0], width = fmax(stop[4] - from, 1e-9f);
    const REAL s = real_clamp((t - from) / width, (REAL)(0.0f), (REAL)(1.0f));
    const float3 a = (float3)(stop[1], stop[2], stop[3]), b = (float3)(stop[5], stop[6], stop[7]);
    color = select3(color, along3(all3(a), s, all3(b - a)), MASK_OF(t >= from));
  }
  return real4(color.x, color.y, color.z, (REAL)(1.0f));
}

static inline REAL4 one_channel(REAL4 value, u32 channel) {
  const REAL one = channel == 0u ? value.x : channel == 1u ? value.y : channel == 2u ? value.z : value.w;
  return real4(one, one, one, one);
}

static inline REAL4 scale_value(REAL4 value, float4 factor, float4 offset) {
  return real4(
      fma(value.x, (REAL)(factor.x), (REAL)(offset.x)), fma(value.y, (REAL)(factor.y), (REAL)(offset.y)),
      fma(value.z, (REAL)(factor.z), (REAL)(offset.z)), fma(value.w, (REAL)(factor.w), (REAL)(offset.w)));
}

// The operands that wait, and a node's value combined with them.
#define HAS_OPERANDS (TEXTURE_STACK > 1)
typedef struct ValueStack {
  REAL4 value[HAS_OPERANDS ? TEXTURE_STACK : 1];
  u32 count;
} ValueStack;

static inline REAL4 combined_values(const Scene* scene, __global const TextureNode* node,
                                    const TexturePoints* at, MASK lanes, ValueStack* stack) {
  REAL4 value;
  if (HAS_OPERANDS && node->kind == TEXTURE_RAMP) {
    value = ramp_color(scene, node, stack->value[--stack->count].x);
  } else if (HAS_OPERANDS && node->kind == TEXTURE_PRODUCT) {
    stack->count -= 2u;
    const REAL4 a = stack->value[stack->count], b = stack->value[stack->count + 1u];
    value = real4(a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w);
  } else {
    value = node_values(scene, node, at, lanes);
  }
  if (!HAS_OPERANDS || !(node->flags & TEXTURE_MIXES)) return scale_value(value, node->factor, node->offset);
  stack->count -= 2u;
  return mix4(stack->value[stack->count], stack->value[stack->count + 1u], value.x);
}

// A texture's values at the points of `lanes`; `first` is its first node.
NEVER_INLINE REAL4 value_of_texture(const Scene* scene, u32 first, const TexturePoints* at, MASK lanes) {
  ValueStack stack;
  stack.count = 0;
  REAL4 value;
  for (u32 i = first;; ++i) {
    __global const TextureNode* node = scene->texture_nodes + i;
    value = combined_values(scene, node, at, lanes, &stack);
    if (node->flags & TEXTURE_ONE_CHANNEL)
      value = one_channel(value, node->flags >> TEXTURE_CHANNEL_SHIFT & 3u);
    if (node->flags & TEXTURE_LAST) break;
    if (HAS_OPERANDS) stack.value[stack.count++] = value;
  }
  return value;
}
#else
static inline REAL4 value_of_texture(const Scene* scene, u32 first, const TexturePoints* at, MASK lanes) {
  return real4((REAL)(1.0f), (REAL)(1.0f), (REAL)(1.0f), (REAL)(1.0f));
}
#endif
#endif
