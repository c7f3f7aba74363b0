// Compiles meshes: triangle blocks under a wide BVH, and vertices and triangles for shading.
#pragma once
#include <vector>

#include "compile/bvh/wide_bvh.h"
#include "compile/compiled_scene.h"

namespace sundog {

/// A mesh in the tables, with the facts that its instances need.
struct PlacedMesh {
  bool used = false;     // some object places it
  bool follows = false;  // shares the BVH of the previous mesh in the triangle table
  double unit = 1;       // unit of the tables' coordinates in mesh units: a power of two
  u32 root = 0;          // root node of its BVH
  u32 first_vertex = 0, first_triangle = 0;
  u32 triangle_count = 0;
  double cost = 0;             // expected cost of a ray that crosses the BVH's box
  u32 stack = 0;               // traversal stack entries that the BVH may need
  std::vector<Bounds> boxes;   // of its root's grandchildren: a tight hull for a rotated instance
  std::vector<u32> materials;  // of its triangles, without duplicates
};

/// Appends the meshes used by `scene`'s objects to nodes, blocks, triangles and vertices of `out`; returns
/// one PlacedMesh per mesh. `default_material` is for triangles without a material. A mesh whose largest
/// coordinate is beyond 1e11 or below 1e-11 is scaled to about 1, since products of its edges and transforms
/// would leave a float's range. Throws SceneError for a non-finite or distant vertex, and for an index out of
/// range.
std::vector<PlacedMesh> add_meshes(const SceneDescription& scene, u32 default_material, CompiledScene& out);

}  // namespace sundog
