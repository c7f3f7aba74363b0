// CompiledScene: the flat tables that the kernels read. Indices only, no device, no pointers.
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "compile/bounds.h"
#include "compile/sdf.h"
#include "scene/description.h"
#include "shared/bvh.h"
#include "shared/scene.h"

namespace sundog {

/// What a scene uses: kernels are specialised to it, so only what a scene needs is built.
struct SceneFeatures {
  std::array<bool, SHAPE_COUNT> shapes{};
  bool secondary_rays = false;  // some material reflects or transmits
  bool media = false;           // some material has an interior medium, or the world's absorbs
  bool touching = false;        // surfaces of solids with media may lie on others
  bool shadow_filters = false;  // shadow rays must look through transmissive things
  bool camera_inside = false;
  bool unbounded = false;         // there are planes
  bool two_sided_fields = false;  // rays may be inside of a distance field
  bool glow = false;              // some field glows
  bool occlusion = false;         // some field takes ambient light from its crevices
  bool soft_shadows = false;      // some field's shadow has a penumbra
  u32 field_flags = 0;            // SdfField.flags that some field has
  bool fog = false;
  bool absorption = false;            // some medium absorbs
  bool fractional_exponents = false;  // some highlight's exponent is no integer
  u32 bvh_stack = 1;  // entries a traversal stack needs at most (scene BVH and the mesh BVH below it)
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

struct CompiledScene {
  SceneInfo info{};
  dvec3 origin{0};  // where the tables' coordinates begin in the world; SceneInfo has it in floats
  std::vector<Bvh8Node> nodes;
  std::vector<TriangleBlock> blocks;
  std::vector<TriangleShading> triangles;
  std::vector<Vertex> vertices;
  std::vector<Instance> instances;
  std::vector<Material> materials;
  std::vector<Medium> media;
  std::vector<Light> lights;
  CompiledFields fields;
  Tracer tracer = Tracer::automatic;  // of which kind the device shall trace
  SceneFeatures features;
  BvhFigures figures;
};

/// Pure: the same description gives the same bytes, whatever the number of threads (figures' times apart).
/// Throws SceneError for what cannot be compiled (empty image, too many triangles for the index width).
CompiledScene compile(const SceneDescription& scene);

}  // namespace sundog
