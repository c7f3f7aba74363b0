// Meshes to tables: triangle blocks under a wide BVH, and the vertices and triangles that shading reads.
#pragma once
#include <vector>

#include "compile/bvh/wide_bvh.h"
#include "compile/compiled_scene.h"

namespace sundog {

/// A mesh in the tables, and what its instances need to know of it.
struct PlacedMesh {
  bool used = false;     // some object places it
  bool follows = false;  // it is in the BVH of the one before it in the triangles' table
  double unit = 1;       // of the tables' coordinates, in the mesh's: a power of two
  u32 root = 0;          // the first node of its BVH
  u32 first_vertex = 0, first_triangle = 0;
  u32 triangle_count = 0;
  double cost = 0;  // expected cost of a ray that crosses the BVH's box
  u32 stack = 0;    // entries the BVH's traversal may need
  std::vector<Bounds>
      boxes;  // of what it has in its root's grandchildren: a tight hull for a rotated instance
  std::vector<u32> materials;  // of its triangles, each once
};

/// Appends the meshes that `scene`'s objects use to nodes, blocks, triangles and vertices of `out`; one
/// PlacedMesh a mesh. `default_material` is for triangles that neither the mesh nor an object gives one.
/// A mesh whose greatest coordinate is beyond 1e11 or below 1e-11 is brought to about 1, since products of
/// its edges and transforms would leave a float's range. Throws SceneError for a vertex that is not finite or
/// too far out, and for an index out of range.
std::vector<PlacedMesh> add_meshes(const SceneDescription& scene, u32 default_material, CompiledScene& out);

}  // namespace sundog
