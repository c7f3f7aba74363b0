// Evaluates textures at surface points, node by node (shared/textures.h).
#include "plain/shade/interface.h"
#include "plain/shade/patterns.cl"

// Inputs of textures at a surface point.
typedef struct TexturePoint {
  float u, v;       // v up
  float uv_length;  // world length of a unit of u and v (geometric mean); 0: unknown
  float3 p, n;      // point and normal in object units; n need not be unit
  float scale;      // object units per world unit
  float footprint;  // width of the ray's footprint on the surface, in the world
  int instance, prim;
  float b, c;  // barycentric coordinates of a triangle's second and third corner
} TexturePoint;

// The operands of a texture's nodes that wait.
typedef struct LANES(ValueStack) {
  float4 value[16];
} ValueStack;

CONSTANT u32 TEXTURE_KINDS;
CONSTANT u32 TEXTURE_MAPPINGS;
CONSTANT u32 TEXTURE_STACK;
CONSTANT u32 EXTRA_UVS;
float radius_about_y(float3 p);
float turns(float x, float y);
CALLED(mix4) float4 blend(float4 a, float4 b, float t);
float4 sample_image(UNIFORM const Scene* scene, UNIFORM __global const TextureNode* node, float u, float v,
                    float footprint, HERE);
float4 pattern_formula(UNIFORM u32 number, float3 p, float width, UNIFORM __global const float* numbers);

HAVING(HAS_CONES);

// Whether a node has a kind, and a mapping, of those that the scene has at all.
static inline bool is_kind(UNIFORM __global const TextureNode* node, UNIFORM u32 kind) {
  return (TEXTURE_KINDS >> kind & 1u) != 0u && node->kind == kind;
}
static inline bool is_mapped(UNIFORM __global const TextureNode* node, UNIFORM u32 mapping) {
  return (TEXTURE_MAPPINGS >> mapping & 1u) != 0u && (node->mapping & MAPPING_KIND) == mapping;
}

// A point in a node's coordinates, and node units per world unit.
typedef struct MappedPoint {
  float3 q;
  float density;
  float3 across;  // fraction of the footprint along each axis; it has no extent along the normal
} MappedPoint;

// u, v and their unit's length in the further set `set` of a triangle's corners, by areas relative to the
// first set, whose unit's length is known. If u and v of the first set have moved along the surface, by a
// bump's step or by parallax, the others move with them.
static inline float3 corners_of_set(UNIFORM const Scene* scene, const TexturePoint* at, UNIFORM u32 set) {
  __global const float* uvs = scene->extra_uvs + 2u * (set - 1u);
  __global const TriangleShading* triangle = scene->triangles + at->prim;
  const u32 i0 = triangle->vertex[0], i1 = triangle->vertex[1], i2 = triangle->vertex[2];
  __global const Vertex* v0 = scene->vertices + i0;
  __global const Vertex* v1 = scene->vertices + i1;
  __global const Vertex* v2 = scene->vertices + i2;
  const float e1_u = v1->u - v0->u, e1_v = v1->v - v0->v, e2_u = v2->u - v0->u, e2_v = v2->v - v0->v;
  const u32 k0 = 2u * EXTRA_UVS * i0, k1 = 2u * EXTRA_UVS * i1, k2 = 2u * EXTRA_UVS * i2;
  const float u0 = uvs[k0], v00 = uvs[k0 + 1u];
  const float d1_u = uvs[k1] - u0, d1_v = uvs[k1 + 1u] - v00, d2_u = uvs[k2] - u0, d2_v = uvs[k2 + 1u] - v00;
  float b = at->b, c = at->c;
  const float area = e1_u * e2_v - e2_u * e1_v, own = fabs(d1_u * d2_v - d2_u * d1_v);
  if (HAS_RELIEF && area != 0.0f) {
    const float du = at->u - (v0->u + b * e1_u + c * e2_u), dv = at->v - (v0->v + b * e1_v + c * e2_v);
    b += (du * e2_v - dv * e2_u) / area;
    c += (e1_u * dv - e1_v * du) / area;
  }
  return (float3)(u0 + (b * d1_u + c * d2_u), v00 + (b * d1_v + c * d2_v),
                  own > 0.0f ? at->uv_length * sqrt(fabs(area) / own) : 0.0f);
}

static inline float row_times(UNIFORM float4 row, float3 p) {
  return fma(row.x, p.x, fma(row.y, p.y, fma(row.z, p.z, row.w)));
}
static inline float3 rows_times(UNIFORM __global const TextureNode* node, float3 p) {
  return (float3)(row_times(node->rows[0], p), row_times(node->rows[1], p), row_times(node->rows[2], p));
}

// Transforms u and v of a mapping to the texture's.
static inline MappedPoint map_uv(UNIFORM __global const TextureNode* node, float u, float v, float density) {
  const float4 a = node->uv_rows[0], b = node->uv_rows[1];
  MappedPoint mapped;
  mapped.q = (float3)(fma(a.x, u, fma(a.y, v, a.z)), fma(b.x, u, fma(b.y, v, b.z)), 0.0f);
  mapped.density = density * node->scale;
  mapped.across = (float3)(1.0f, 1.0f, 0.0f);
  return mapped;
}

static inline MappedPoint map_point(UNIFORM const Scene* scene, UNIFORM __global const TextureNode* node,
                                    const TexturePoint* at) {
  if ((node->mapping & MAPPING_KIND) == MAPPING_UV) {
    float3 uv = (float3)(at->u, at->v, at->uv_length);
    // Solids have only the first set.
    if (HAS_MESH && EXTRA_UVS != 0u && node->mapping >> MAPPING_SET_SHIFT != 0u &&
        scene->instances[at->instance].shape == SHAPE_MESH)
      uv = corners_of_set(scene, at, node->mapping >> MAPPING_SET_SHIFT);
    return map_uv(node, uv.x, uv.y, uv.z > 0.0f ? 1.0f / nonzero(uv.z) : 0.0f);
  }
  const float3 q = rows_times(node, at->p);
  const bool sphere = is_mapped(node, MAPPING_SPHERICAL);
  if (sphere || is_mapped(node, MAPPING_CYLINDRICAL)) {
    const float r = radius_about_y(q), u = turns(q.x, -q.z);
    const float v = sphere ? 0.5f + 2.0f * copysign(turns(r, fabs(q.y)), q.y) : q.y;
    const float area = sphere ? 2.0f * M_PI_F * M_PI_F * r * length(q) : 2.0f * M_PI_F * r;
    return map_uv(node, u, v, at->scale * real_rsqrt(real_max(area, 1e-12f)));
  }
  if (is_kind(node, TEXTURE_IMAGE)) return map_uv(node, q.x, q.y, at->scale);
  // A pattern's placement rotates and scales uniformly, so normals transform like vectors.
  MappedPoint mapped;
  mapped.q = q;
  mapped.density = node->scale * at->scale;
  mapped.across = sines_to_axes(unit3(
      (float3)(dot(node->rows[0].xyz, at->n), dot(node->rows[1].xyz, at->n), dot(node->rows[2].xyz, at->n))));
  return mapped;
}

static inline float4 mapped_image(UNIFORM const Scene* scene, UNIFORM __global const TextureNode* node,
                                  const TexturePoint* at, const MappedPoint* mapped) {
  return sample_image(scene, node, mapped->q.x, mapped->q.y, at->footprint * mapped->density);
}

// The image on six sides of a box, blended by the normal's components.
static inline float4 image_on_box(UNIFORM const Scene* scene, UNIFORM __global const TextureNode* node,
                                  const TexturePoint* at) {
  const float3 q = rows_times(node, at->p), n = unit3(rows_times(node, at->n)), n2 = n * n, weight = n2 * n2;
  const float sum = real_max(weight.x + weight.y + weight.z, 1e-12f);
  const float u[3] = {-copysign(1.0f, n.x) * q.z, q.x, copysign(1.0f, n.z) * q.x};
  const float v[3] = {q.y, -copysign(1.0f, n.y) * q.z, q.y};
  const float share[3] = {weight.x / sum, weight.y / sum, weight.z / sum};
  float4 mixed = (float4)(0.0f);
  for (u32 axis = 0; axis < 3u; ++axis) {
    if (!(share[axis] > 1e-3f)) continue;
    const MappedPoint mapped = map_uv(node, u[axis], v[axis], at->scale);
    const float4 side = mapped_image(scene, node, at, &mapped);
    mixed = (float4)(fma(share[axis], side.x, mixed.x), fma(share[axis], side.y, mixed.y),
                     fma(share[axis], side.z, mixed.z), fma(share[axis], side.w, mixed.w));
  }
  return mixed;
}

// The number of a pattern.
static inline float pattern_value(UNIFORM __global const TextureNode* node, const MappedPoint* mapped,
                                  float w) {
  const float3 q = mapped->q, across = mapped->across * w;
  const float a = node->parameter[0], b = node->parameter[1], c = node->parameter[2];
  if (is_kind(node, TEXTURE_CHECKER)) return checker_pattern(q, across);
  if (is_kind(node, TEXTURE_STRIPES)) return pulse(q.x, a, across.x);
  if (is_kind(node, TEXTURE_BRICK)) return brick_pattern(q, across, a, b);
  if (is_kind(node, TEXTURE_NOISE)) return 0.5f + 0.5f * octave_noise(q, w, (u32)a, b, c != 0.0f);
  if (is_kind(node, TEXTURE_CELLS)) return cell_distance(q, w);
  if (is_kind(node, TEXTURE_MARBLE)) return marble_pattern(q, w, (u32)a, b, c);
  if (is_kind(node, TEXTURE_WOOD)) return wood_pattern(q, w, (u32)a, b, c);
  return real_clamp(q.x, 0.0f, 1.0f);
}

// Vertex colours of meshes.
static inline float4 vertex_color(UNIFORM const Scene* scene, const TexturePoint* at) {
  if (scene->instances[at->instance].shape != SHAPE_MESH) return (float4)(1.0f);
  const float b = at->b, c = at->c;
  const float share[3] = {1.0f - b - c, b, c};
  float4 sum = (float4)(0.0f);
  for (u32 k = 0; k < 3u; ++k) {
    const u32 corner = scene->triangles[at->prim].vertex[k];
    __global const Vertex* vertex = scene->vertices + corner;
    sum += (float4)(vertex->r, vertex->g, vertex->b, scene->vertex_alphas[corner]) * share[k];
  }
  return sum;
}

// The value of a node's kind at a point.
static inline float4 node_value(UNIFORM const Scene* scene, UNIFORM __global const TextureNode* node,
                                const TexturePoint* at) {
  if (node->kind == TEXTURE_COLOR) return (float4)(0.0f);
  const bool image = is_kind(node, TEXTURE_IMAGE);
  if (image && is_mapped(node, MAPPING_BOX)) return image_on_box(scene, node, at);
  if (is_kind(node, TEXTURE_VERTEX_COLOR)) return vertex_color(scene, at);
  const MappedPoint mapped = map_point(scene, node, at);
  if (image) return mapped_image(scene, node, at, &mapped);
  const float width = at->footprint * mapped.density;
  if (is_kind(node, TEXTURE_FORMULA))
    return pattern_formula(node->count, mapped.q, width, scene->texture_values + node->first);
  return (float4)(pattern_value(node, &mapped, width));
}

// A ramp's colour at t: interpolated between stops, constant beyond the ends.
static inline float4 ramp_color(UNIFORM const Scene* scene, UNIFORM __global const TextureNode* node,
                                float t) {
  __global const float* stop = scene->texture_values + node->first;
  float3 color = (float3)(stop[1], stop[2], stop[3]);
  for (u32 i = 4u; i < 4u * node->count; i += 4u) {
    const float from = stop[i - 4u], width = fmax(stop[i] - from, 1e-9f);
    const float s = real_clamp((t - from) / width, 0.0f, 1.0f);
    const float3 a = (float3)(stop[i - 3u], stop[i - 2u], stop[i - 1u]),
                 b = (float3)(stop[i + 1u], stop[i + 2u], stop[i + 3u]);
    if (t >= from) color = along(a, s, b - a);
  }
  return (float4)(color, 1.0f);
}

// A texture's value at a point; `first` is its first node.
ENTRY static float4 value_of_texture(UNIFORM const Scene* scene, UNIFORM u32 first, const TexturePoint* at) {
  ValueStack stack;
  u32 count = 0u;
  float4 value = (float4)(0.0f);
  for (u32 i = first; true; ++i) {
    __global const TextureNode* node = scene->texture_nodes + i;
    if (TEXTURE_STACK > 1u && node->kind == TEXTURE_RAMP) {
      count -= 1u;
      value = ramp_color(scene, node, stack.value[count].x);
    } else if (TEXTURE_STACK > 1u && node->kind == TEXTURE_PRODUCT) {
      count -= 2u;
      value = stack.value[count] * stack.value[count + 1u];
    } else {
      value = node_value(scene, node, at);
    }
    if (TEXTURE_STACK > 1u && (node->flags & TEXTURE_MIXES) != 0u) {
      count -= 2u;
      value = blend(stack.value[count], stack.value[count + 1u], value.x);
    } else {
      const float4 k = node->factor, least = node->offset;
      value = (float4)(fma(value.x, k.x, least.x), fma(value.y, k.y, least.y), fma(value.z, k.z, least.z),
                       fma(value.w, k.w, least.w));
    }
    if ((node->flags & TEXTURE_ONE_CHANNEL) != 0u) {
      const u32 channel = node->flags >> TEXTURE_CHANNEL_SHIFT & 3u;
      value = (float4)(channel == 0u ? value.x : channel == 1u ? value.y : channel == 2u ? value.z : value.w);
    }
    if ((node->flags & TEXTURE_LAST) != 0u) break;
    if (TEXTURE_STACK > 1u) {
      stack.value[count] = value;
      count += 1u;
    }
  }
  return value;
}
