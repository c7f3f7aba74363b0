// The flattened two-level BVH. One node array holds the scene BVH (`tlas`, over instances) and every mesh BVH
// (`blas`, over triangle blocks); child indices are absolute in it.
#ifndef SUNDOG_SHARED_BVH_H
#define SUNDOG_SHARED_BVH_H
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
  u32 valid;  // bit i is set when slot i holds a child; filled slots come first
  u32 pad[7];
} Bvh8Node;
SUNDOG_SHARED_SIZE(Bvh8Node, 256)

// 96 bytes: the same node for devices that run a lane a ray, after Ylitie, Karras and Laine 2017 ("Efficient
// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs"): boxes on a grid of 256 steps an axis,
// never smaller than those of the Bvh8Node. Nodes keep their indices.
typedef struct CompactNode {
  float origin[3];    // of the grid
  u32 scale;          // bytes 0..2: biased exponents of the grid's steps by axis; byte 3: how many children
  u32 first_inner;    // least node among the children, from which their distances count
  u32 first_leaf;     // least block (or instance) of the leaves, for their distances
  u32 child[4];       // 16 bits a slot: COMPACT_LEAF | (count - 1) << COMPACT_COUNT_SHIFT | distance
  u32 quantized[12];  // a byte a slot: lower x, y, z, upper x, y, z
  u32 pad[2];
} CompactNode;
SUNDOG_SHARED_SIZE(CompactNode, 96)

#define COMPACT_LEAF 0x8000u
#define COMPACT_COUNT_SHIFT 11u
#define COMPACT_LEAF_DISTANCE 0x7FFu
#define COMPACT_INNER_DISTANCE 0x7FFFu

// 320 bytes: eight triangles by their corners, object space. Neighbours hold the same bits of a shared
// corner, which is what makes the hit test watertight. `prim` indexes TriangleShading; an unused lane holds
// zeros and NO_PRIM (a point: never hit), and a triangle without area is held as a point too.
typedef struct TriangleBlock {
  float v0_x[8], v0_y[8], v0_z[8];
  float v1_x[8], v1_y[8], v1_z[8];
  float v2_x[8], v2_y[8], v2_z[8];
  u32 prim[8];
} TriangleBlock;
SUNDOG_SHARED_SIZE(TriangleBlock, 320)

#define NO_PRIM 0xFFFFFFFFu
#define NO_INSTANCE 0xFFFFFFFFu

// 24 bytes: what shading needs of a triangle: three indices into the Vertex array, its material, the greatest
// distance of its corners along an axis, which rounding of positions on it is relative to, and where its
// corners are: lane place & 7 of the block place >> 3.
typedef struct TriangleShading {
  u32 vertex[3];
  u32 material;
  float extent;
  u32 place;
} TriangleShading;
SUNDOG_SHARED_SIZE(TriangleShading, 24)

// 32 bytes: a mesh vertex's attributes. Normals are unit length, object space.
typedef struct Vertex {
  float nx, ny, nz;
  float u, v;
  float r, g, b;  // vertex colour, linear; 1 where the file has none
} Vertex;
SUNDOG_SHARED_SIZE(Vertex, 32)

// 128 bytes. Instances [0, bounded_count) are leaves of the scene BVH in leaf order, meshes that share a BVH
// behind the first of them, which is the leaf; the rest, planes and a few solids beside meshes, are tried one
// by one. A ray is taken into object space without renormalising, so
// t is the same in both; a normal goes to world space by the transpose of object_from_world's linear part.
typedef struct Instance {
  float4 object_from_world[3];  // rows of the affine matrix
  float4 parameters;
  u32 shape;     // SHAPE_*
  u32 root;      // SHAPE_MESH: the first node of its mesh BVH
  u32 material;  // of a solid; a mesh's triangles carry their own unless material != NO_MATERIAL
  u32 flags;     // INSTANCE_*
  u32 object;    // index of the scene object it came from, for AOVs and messages
  float touch;   // above 0 where surfaces of it may lie on others' or its own: how far rounding may part them
  u32 light;     // index of the light that it shows, or NO_LIGHT
  u32 first_prim;        // of a mesh: the index of its first triangle
  float4 world_center;   // of the bounds; w = half the diagonal (0 when unbounded)
  float4 pattern_scale;  // xyz: from object space to that of the scene file, where patterns are measured;
                         // w: lengths there over lengths in the world, their geometric mean
} Instance;
SUNDOG_SHARED_SIZE(Instance, 128)

// 80 bytes: how an instance turns about a point, grows from it and then moves on while the shutter is open,
// seen in the world. After the part a of the turn, points p from there are where
// p + sin(a) S p + (1 - cos(a)) S S p was (Rodrigues). An instance has a row for its own turn and for that of
// each group around it, the outermost first; `moves`.w is one more than the index of the first, 0 without.
typedef struct Turn {
  float4 spin[3];  // rows of S; w: the coordinates of the point
  float4 turn;     // in whole turns; growth: 1 less than the final size; how many rows follow; the greatest
                   // coordinate that positions near the object round at
  float4 moves;    // xyz: how far what it turns moves within
} Turn;
SUNDOG_SHARED_SIZE(Turn, 80)

#define NO_MATERIAL 0xFFFFFFFFu
#define NO_LIGHT 0xFFFFFFFFu
#define INSTANCE_IDENTITY 1u   // object_from_world is the identity
#define INSTANCE_FILTERS 2u    // a shadow ray may pass (some material of it transmits and lets light through)
#define INSTANCE_TRANSMITS 4u  // some material of it has an interior medium
#define INSTANCE_SCALES 8u     // object_from_world has no turn: off its diagonal there are zeros
#define INSTANCE_SHARES 16u    // the next instance is in the same mesh BVH, and its triangles come next

// 32 bytes: the raw intersection. ng is the geometric normal in object space, outward, not normalised.
typedef struct Hit {
  float t, u, v;  // t along the ray; u, v barycentric (triangles) or surface parameters
  u32 prim;       // TriangleShading index; for a solid the face or part
  u32 instance;   // NO_INSTANCE: nothing was hit
  float ng_x, ng_y, ng_z;
} Hit;
SUNDOG_SHARED_SIZE(Hit, 32)

// 32 bytes. direction need not be unit length.
typedef struct Ray {
  float ox, oy, oz, t_min;
  float dx, dy, dz, t_max;
} Ray;
SUNDOG_SHARED_SIZE(Ray, 32)

SUNDOG_SHARED_END
#endif
