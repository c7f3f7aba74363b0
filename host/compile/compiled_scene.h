// CompiledScene: the flat tables that the kernels read. Indices only, no device, no pointers.
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "compile/bounds.h"
#include "compile/shared_table.h"
#include "scene/description.h"
#include "shared/features.h"
#include "shared/scene_tables.h"

namespace sundog {

/// What a scene uses: kernels are specialised to it, so only what a scene needs is built.
struct SceneFeatures {
  std::array<bool, SHAPE_COUNT> shapes{};
#define SUNDOG_FEATURE_MEMBER(type, definition, name) type name = 0;
  SCENE_FEATURES(SUNDOG_FEATURE_MEMBER)
#undef SUNDOG_FEATURE_MEMBER
  bool camera_inside = false;
  bool unbounded = false;  // there are planes
  u32 bvh_stack = 1;       // entries a traversal stack needs at most (scene BVH and the mesh BVH below it)
  friend bool operator==(const SceneFeatures&, const SceneFeatures&) = default;
};

struct BvhFigures {
  std::size_t nodes = 0, blocks = 0, triangles = 0, instances = 0;
  double sah_cost =
      0;  // expected cost of a ray that crosses the root: node visits + block visits, area-weighted
  double build_seconds = 0;    // not part of the pure result's bytes
  double mean_block_fill = 0;  // triangles in a block, 1..8; a cut triangle counts in each
  std::size_t bytes = 0;
  Bounds box = Bounds::none();  // of all instances but planes and fields, from CompiledScene::origin
};

/// The tables of shared/scene_tables.h.
struct SceneTables {
#define SUNDOG_TABLE_MEMBER(type, host_type, name, label) SharedTable<host_type> name;
  SCENE_TABLES(SUNDOG_TABLE_MEMBER)
#undef SUNDOG_TABLE_MEMBER
};

/// Calls visit(words for messages, table) for each table, in the order of the list.
template <class Visit>
void for_each_table(const SceneTables& tables, const Visit& visit) {
#define SUNDOG_VISIT_TABLE(type, host_type, name, label) visit(label, tables.name);
  SCENE_TABLES(SUNDOG_VISIT_TABLE);
#undef SUNDOG_VISIT_TABLE
}

/// Of the instances that share a mesh BVH, `first` being the first of them, the one that has the triangle
/// `prim`.
inline u32 instance_of_triangle(const SceneTables& tables, u32 first, u32 prim) {
  const std::vector<Instance>& instances = tables.instances.rows();
  while (instances[first].flags & INSTANCE_SHARES && instances[first + 1].first_prim <= prim) ++first;
  return first;
}

/// Bytes of all tables.
std::size_t table_bytes(const SceneTables& tables);

/// What maps of photons are made by.
struct PhotonPlan {
  u32 count = 0;               // sent out for each
  double radius = 0;           // of the first
  bool lights_inside = false;  // some light may be inside a solid with a medium
};

struct CompiledScene : SceneTables {
  SceneInfo info{};
  dvec3 origin{0};             // where the tables' coordinates begin in the world; SceneInfo has it in floats
  std::string field_source;    // text of generated/sdf.cl (compile/fields/sdf.h); empty without fields
  std::string pattern_source;  // text of generated/patterns.cl (compile/fields/pattern_code.h), or empty
  std::string integrator = "whitted";  // a name of scene/integrators.h
  Tracer tracer = Tracer::automatic;   // of which kind the device shall trace
  Sampling sampling;
  PhotonPlan photons_by;
  SceneFeatures features;
  BvhFigures figures;
};

/// Pure (and put together from parts, see scene_compiler.h): the same description gives the same bytes,
/// whatever the number of threads (figures' times apart). Throws SceneError for what cannot be compiled
/// (empty image, too many triangles for the index width).
CompiledScene compile(const SceneDescription& scene);

}  // namespace sundog
