// The flattened two-level BVH. One node array holds the scene BVH (`tlas`, over instances) and all mesh BVHs
// (`blas`, over triangle blocks), with absolute child indices.
#pragma once
#include "shared/shapes.h"
#include "shared/types.h"
SUNDOG_SHARED_BEGIN

#define BVH_WIDTH 8

// A child word is an inner node's index, or BVH_LEAF | (count - 1) << BVH_LEAF_SHIFT | first:
// in a mesh BVH `count` blocks from block `first`; in the scene BVH `count` instances from instance `first`.
// An empty slot holds BVH_EMPTY, and bounds of lower = +inf, upper = -inf.
#define BVH_LEAF 0x80000000u
#define BVH_LEAF_SHIFT 27u
#define BVH_LEAF_COUNT_MASK 0xFu
#define BVH_FIRST_MASK 0x07FFFFFFu
#define BVH_EMPTY 0xFFFFFFFFu

// 256 bytes: bounds as structure of arrays, so that one vector instruction tests eight children.
typedef struct Bvh8Node {
  float lower_x[8], lower_y[8], lower_z[8];
  float upper_x[8], upper_y[8], upper_z[8];
  u32 child[8];
  u32 valid;  // bit i: slot i holds a child; filled slots come first
  u32 pad[7];
} Bvh8Node;
SUNDOG_SHARED_SIZE(Bvh8Node, 256)

// 96 bytes: the node for devices with one ray per lane, after Ylitie, Karras and Laine 2017 ("Efficient
// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs"): boxes on a grid of 256 steps per axis,
// containing those of the Bvh8Node. Node indices are the same.
typedef struct CompactNode {
  float origin[3];    // of the grid
  u32 scale;          // bytes 0..2: biased exponents of the grid's steps by axis; byte 3: number of children
  u32 first_inner;    // smallest node index among the children, base of their distances
  u32 first_leaf;     // smallest block (or instance) of the leaves, base of their distances
  u32 child[4];       // 16 bits per slot: COMPACT_LEAF | (count - 1) << COMPACT_COUNT_SHIFT | distance
  u32 quantized[12];  // one byte per slot: lower x, y, z, upper x, y, z
  u32 pad[2];
} CompactNode;
SUNDOG_SHARED_SIZE(CompactNode, 96)

#define COMPACT_LEAF 0x8000u
#define COMPACT_COUNT_SHIFT 11u
#define COMPACT_LEAF_DISTANCE 0x7FFu
#define COMPACT_INNER_DISTANCE 0x7FFFu

// 320 bytes: corners of eight triangles, object space. Neighbours store a shared corner with equal bits,
// which makes the hit test watertight. `prim` indexes TriangleShading; an unused lane holds zeros and NO_PRIM
// (a point: never hit). Degenerate triangles are stored as points too.
typedef struct TriangleBlock {
  float v0_x[8], v0_y[8], v0_z[8];
  float v1_x[8], v1_y[8], v1_z[8];
  float v2_x[8], v2_y[8], v2_z[8];
  u32 prim[8];
} TriangleBlock;
SUNDOG_SHARED_SIZE(TriangleBlock, 320)

#define NO_PRIM 0xFFFFFFFFu
#define NO_INSTANCE 0xFFFFFFFFu

// 24 bytes: shading data of a triangle: three indices into the Vertex array, its material, the largest
// coordinate of its corners, which scales rounding errors of positions on it, and the location of its
// corners: lane place & 7 of block place >> 3.
typedef struct TriangleShading {
  u32 vertex[3];
  u32 material;
  float extent;
  u32 place;
} TriangleShading;
SUNDOG_SHARED_SIZE(TriangleShading, 24)

// 32 bytes: a mesh vertex's attributes. Normals have unit length, object space.
typedef struct Vertex {
  float nx, ny, nz;
  float u, v;
  float r, g, b;  // vertex colour, linear; default 1
} Vertex;
SUNDOG_SHARED_SIZE(Vertex, 32)

// 128 bytes. Instances [0, bounded_count) are leaves of the scene BVH in leaf order; of meshes that share a
// BVH, the first is the leaf and the others follow it. The rest, planes and a few solids, are tested one by
// one. Rays are transformed to object space without renormalising, so t is the same in both; normals are
// transformed by the transpose of object_from_world's linear part.
typedef struct Instance {
  float4 object_from_world[3];  // rows of the affine matrix
  float4 parameters;
  u32 shape;     // SHAPE_*
  u32 root;      // SHAPE_MESH: root node of its mesh BVH
  u32 material;  // of a solid; mesh triangles have their own unless material != NO_MATERIAL
  u32 flags;     // INSTANCE_*
  u32 object;    // index of its scene object, for AOVs and messages
  float touch;   // above 0 if its surfaces may touch others or each other: the gap that rounding may open; 1
                 // for fields of which rays remember their side
  u32 light;     // index of the light that it shows, or NO_LIGHT
  u32 first_prim;        // of a mesh: the index of its first triangle
  float4 world_center;   // centre of the bounds; w = half the diagonal (0 if unbounded)
  float4 pattern_scale;  // xyz: from object space to the scene file's, in which patterns are measured; w:
                         // geometric mean of the scale from world to there
} Instance;
SUNDOG_SHARED_SIZE(Instance, 128)

// 80 bytes: how an instance turns about a point, grows from it and then moves while the shutter is open, in
// world space. A rotation by the angle a moves p, relative to the pivot, to
// p + sin(a) S p + (1 - cos(a)) S S p (Rodrigues). An instance has a row for its own turn and one for each
// group around it, outermost first; `moves`.w is the index of the first plus one, or 0.
typedef struct Turn {
  float4 spin[3];  // rows of S; w: the pivot
  float4 turn;  // in whole turns; growth: final size - 1; number of rows that follow; largest coordinate that
                // limits precision near the object
  float4 moves;  // xyz: translation within the turn
} Turn;
SUNDOG_SHARED_SIZE(Turn, 80)

#define NO_MATERIAL 0xFFFFFFFFu
#define NO_LIGHT 0xFFFFFFFFu
#define INSTANCE_IDENTITY 1u   // object_from_world is the identity
#define INSTANCE_FILTERS 2u    // a shadow ray may pass (some material transmits and does not block shadows)
#define INSTANCE_TRANSMITS 4u  // some material has an interior medium
#define INSTANCE_SCALES 8u     // object_from_world is diagonal: no rotation
#define INSTANCE_SHARES 16u    // the next instance is in the same mesh BVH, and its triangles follow

// 32 bytes: the raw intersection. ng is the geometric normal in object space, outward, not normalised.
typedef struct Hit {
  float t, u, v;  // t along the ray; u, v barycentric (triangles) or surface parameters
  u32 prim;       // TriangleShading index; for a solid, the face or part
  u32 instance;   // NO_INSTANCE: nothing was hit
  float ng_x, ng_y, ng_z;
} Hit;
SUNDOG_SHARED_SIZE(Hit, 32)

// 32 bytes. direction need not have unit length.
typedef struct Ray {
  float ox, oy, oz, t_min;
  float dx, dy, dz, t_max;
} Ray;
SUNDOG_SHARED_SIZE(Ray, 32)

SUNDOG_SHARED_END
