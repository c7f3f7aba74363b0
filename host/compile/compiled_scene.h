// CompiledScene: the flat tables that kernels read, linked by indices, without pointers or device handles.
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

/// Features of a scene; kernels are specialised to them.
struct SceneFeatures {
  std::array<bool, SHAPE_COUNT> shapes{};
#define SUNDOG_FEATURE_MEMBER(type, definition, name, effect) type name = 0;
  SCENE_FEATURES(SUNDOG_FEATURE_MEMBER)
#undef SUNDOG_FEATURE_MEMBER
  bool camera_inside = false;
  bool unbounded = false;  // the scene contains planes
  u32 bvh_stack = 1;       // worst-case traversal stack entries (scene BVH and a mesh BVH below it)
  friend bool operator==(const SceneFeatures&, const SceneFeatures&) = default;
};

struct BvhFigures {
  std::size_t nodes = 0, blocks = 0, triangles = 0, instances = 0;
  double sah_cost = 0;         // expected node and block visits of a ray that crosses the root
  double build_seconds = 0;    // excluded from the deterministic result
  double mean_block_fill = 0;  // triangles per block, 1..8; a split triangle counts in each
  std::size_t bytes = 0;
  Bounds box = Bounds::none();  // bounds of all instances but planes and fields, from CompiledScene::origin
};

/// The tables of shared/scene_tables.h.
struct SceneTables {
#define SUNDOG_TABLE_MEMBER(type, host_type, name, label) SharedTable<host_type> name;
  SCENE_TABLES(SUNDOG_TABLE_MEMBER)
#undef SUNDOG_TABLE_MEMBER
};

/// Calls visit(label for messages, table) for each table in list order.
template <class Visit>
void for_each_table(const SceneTables& tables, const Visit& visit) {
#define SUNDOG_VISIT_TABLE(type, host_type, name, label) visit(label, tables.name);
  SCENE_TABLES(SUNDOG_VISIT_TABLE);
#undef SUNDOG_VISIT_TABLE
}

/// The instance that owns triangle `prim`, among the instances that share a mesh BVH and start at `first`.
inline u32 instance_of_triangle(const SceneTables& tables, u32 first, u32 prim) {
  const std::vector<Instance>& instances = tables.instances.rows();
  while (instances[first].flags & INSTANCE_SHARES && instances[first + 1].first_prim <= prim) ++first;
  return first;
}

/// Total size of the tables in bytes.
std::size_t table_bytes(const SceneTables& tables);

/// Parameters of photon maps.
struct PhotonPlan {
  u32 count = 0;               // photons emitted per map
  double radius = 0;           // radius of the first map
  bool lights_inside = false;  // some light may be inside a solid with a medium
};

struct CompiledScene : SceneTables {
  SceneInfo info{};
  dvec3 origin{0};                     // world position of the tables' origin; SceneInfo stores it as floats
  std::string field_source;            // generated/sdf.cl (compile/fields/sdf.h); empty without fields
  std::string pattern_source;          // generated/patterns.cl (compile/fields/pattern_code.h), or empty
  std::string integrator = "whitted";  // a name listed in scene/integrators.h
  Tracer tracer = Tracer::automatic;
  Sampling sampling;
  std::vector<std::string> light_groups;  // sorted; group i is number i + 1 in the tables
  PhotonPlan photons_by;
  SceneFeatures features;
  BvhFigures figures;
};

/// Compiles a scene. Pure: equal descriptions give equal bytes for any number of threads, except the times in
/// the figures. Assembled from parts (scene_compiler.h). Throws SceneError for more pixels, triangles or
/// texels than indices can address.
CompiledScene compile(const SceneDescription& scene);

}  // namespace sundog
