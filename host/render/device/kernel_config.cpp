#include "render/device/kernel_config.h"

#include <algorithm>
#include <bit>
#include <set>
#include <string>

#include "compile/fields/sdf.h"
#include "device/choice.h"
#include "scene/integrators.h"
#include "shared/textures.h"

namespace sundog {
namespace {

// A CPU's driver keeps a whole group's private memory on a thread's stack, 8 MiB by default, and crashes on
// overflow. A work-item holds its ray stack and its batch.
constexpr std::size_t group_memory = std::size_t{6} << 20, ray_bytes = 80, batch_bytes = 640;

// The file with the fields' code.
constexpr const char* fields_file = "generated/sdf.cl";

// A field's own flags apply within the kernel's.
const std::string all_field_flags = std::to_string(SDF_SMOOTH | SDF_CUT_SPHERE);

// General kernels have room for rays of this many levels and for the BVHs of most scenes; drafts for the
// maximum depth and any BVH.
constexpr unsigned general_depth = 12, general_bvh_stack = 64, general_bvh_levels = 32, draft_depth = 32,
                   draft_bvh_stack = 128, draft_bvh_levels = 64;

/// Waiting shadow rays per surface: one per light, within limits, and rounded up so that similar scenes share
/// kernels.
unsigned light_room(const CompiledScene& scene) {
  return std::clamp(std::bit_ceil(scene.info.light_count), 2u, 16u);
}

/// Nodes on the longest way from `root` to a leaf.
u32 levels(const std::vector<Bvh8Node>& nodes, u32 root) {
  u32 below = 0;
  for (u32 slot = 0; slot < BVH_WIDTH && (nodes[root].valid >> slot & 1u); ++slot)
    if (const u32 child = nodes[root].child[slot]; !(child & BVH_LEAF))
      below = std::max(below, levels(nodes, child));
  return below + 1;
}

/// Entries of the compact tracer's stack (kernels/lib/trace/single.cl): one a level of the scene's BVH and of
/// the deepest mesh's, a leaf's other instances, and four for the ray in world space.
unsigned waiting_levels(const CompiledScene& scene) {
  constexpr unsigned instances_and_ray = 5;
  std::set<u32> meshes;
  for (const Instance& instance : scene.instances)
    if (instance.shape == SHAPE_MESH) meshes.insert(instance.root);
  u32 deepest = 0;
  for (const u32 root : meshes) deepest = std::max(deepest, levels(scene.nodes, root));
  const u32 root = scene.info.tlas_root;
  return (scene.info.bounded_count == 0 || (root & BVH_LEAF) ? 0 : levels(scene.nodes, root)) + deepest +
         instances_and_ray;
}

/// Rays marched together: all of a work-item's, if vectors of that size exist.
unsigned marched_lanes(unsigned batch) {
  for (const unsigned lanes : {16u, 8u, 4u})
    if (batch % lanes == 0) return lanes;
  return 1;
}

/// Defines the scene's features; `define` takes a name and a number.
template <class Define>
void define_features(const SceneFeatures& features, const Define& define) {
  define("HAS_MESH", features.shapes[SHAPE_MESH]);
  define("HAS_SDF", features.shapes[SHAPE_SDF]);
#define SUNDOG_DEFINE_SOLID(constant, type, name) define("HAS_" #constant, features.shapes[SHAPE_##constant]);
  SOLIDS(SUNDOG_DEFINE_SOLID)
#undef SUNDOG_DEFINE_SOLID
#define SUNDOG_DEFINE_FEATURE(type, definition, name) define(#definition, features.name);
  SCENE_FEATURES(SUNDOG_DEFINE_FEATURE)
#undef SUNDOG_DEFINE_FEATURE
}

/// Whether a definition changes no bit of a scene without the feature, so that kernels with it can draw such
/// a scene (a test renders scenes both ways). Fog, lenses, textures and meshes do not qualify, because they
/// change the arithmetic of every ray; surface coordinates rotate the frame in which layers are sampled.
bool harmless(const std::string& definition, const KernelDefines& defines) {
  static const std::set<std::string> always{
      "HAS_ABSORPTION", "HAS_AREA_LIGHTS",    "HAS_BOX",         "HAS_BVH",
      "HAS_DISK",       "HAS_EMISSION",       "HAS_ENVIRONMENT", "HAS_FRACTIONAL_EXPONENTS",
      "HAS_GLOW",       "HAS_LIGHT_TREE",     "HAS_MEDIA",       "HAS_METAL_ROUGH",
      "HAS_OCCLUSION",  "HAS_PLANE",          "HAS_RECTANGLE",   "HAS_ROUGH",
      "HAS_SECONDARY",  "HAS_SHADOW_FILTERS", "HAS_SKY",         "HAS_SOFT_SHADOWS",
      "HAS_SPHERE",     "HAS_TOUCHING",       "SDF_TWO_SIDED"};
  if (definition == "HAS_UV") return defines.at("HAS_LAYERS") == "0";
  return always.contains(definition);
}

/// Whether a definition changes at most rounding in a scene without the feature, because kernels test
/// materials, objects and the camera at run time.
bool has_no_use(const std::string& definition, const KernelDefines& defines) {
  static const std::set<std::string> solids{
#define SUNDOG_SOLID_DEFINITION(constant, type, name) std::string("HAS_") + #constant,
      SOLIDS(SUNDOG_SOLID_DEFINITION)
#undef SUNDOG_SOLID_DEFINITION
  };
  static const std::set<std::string> others{
      "HAS_CAMERA_MOTION", "HAS_CHECKER",     "HAS_COAT_MAPS", "HAS_FUZZ_MAPS",     "HAS_LAYERS",
      "HAS_LAYER_FILTERS", "HAS_LAYER_MAPS",  "HAS_MAPS",      "HAS_MESH",          "HAS_PARALLAX",
      "HAS_RELIEF",        "HAS_ROUGH_GLASS", "HAS_SDF",       "HAS_SPECULAR_MAPS", "HAS_TEXEL_PAGES",
      "HAS_THIN_WALLS",    "HAS_UV"};
  return solids.contains(definition) || others.contains(definition) || harmless(definition, defines);
}

/// Whether the definition is a mask of kinds, one bit each.
bool is_mask(const std::string& definition) {
  static const std::set<std::string> masks{"SDF_FLAGS", "TEXEL_FORMATS", "TEXTURE_KINDS", "TEXTURE_MAPPINGS"};
  return masks.contains(definition);
}

bool is_room(const std::string& definition) {
  static const std::set<std::string> rooms{"BVH_LEVELS", "BVH_STACK", "LIGHT_ROOM", "RAY_STACK",
                                           "TEXTURE_STACK"};
  return rooms.contains(definition);
}

/// The kernels of the scene's features with secondary rays of at least `depth` levels.
KernelConfig deep_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning,
                         unsigned depth) {
  CompiledScene deep;
  deep.features = scene.features;
  deep.features.secondary_rays = true;
  deep.info = scene.info;
  deep.nodes = scene.nodes;
  deep.instances = scene.instances;
  deep.info.max_depth = std::max(scene.info.max_depth, depth);
  deep.integrator = scene.integrator;
  deep.tracer = scene.tracer;
  deep.field_source = scene.field_source;
  deep.sdf_parameters = scene.sdf_parameters;
  deep.pattern_source = scene.pattern_source;
  return make_kernel_config(deep, device, tuning);
}

void widen(KernelConfig& config, const char* room, unsigned least) {
  const auto found = config.defines.find(room);
  if (found != config.defines.end() && std::stoul(found->second) < least)
    found->second = std::to_string(least);
}

}  // namespace

bool interprets(const KernelConfig& config) {
  const auto fields = config.generated.find(fields_file);
  return fields != config.generated.end() && fields->second == interpreting_source;
}

bool stands_in(const KernelConfig& general, const KernelConfig& wanted) {
  const bool any_fields = interprets(general) && wanted.has_programs;
  const bool same_files =
      std::ranges::equal(general.generated, wanted.generated, [&](const auto& has, const auto& wants) {
        return has == wants || (any_fields && has.first == fields_file && wants.first == fields_file);
      });
  if (!same_files || general.defines.size() != wanted.defines.size()) return false;
  return std::ranges::equal(general.defines, wanted.defines, [&](const auto& has, const auto& wants) {
    if (has == wants) return true;
    if (has.first != wants.first) return false;
    if (has.first == "SDF_FLAGS") return has.second == all_field_flags;
    return (is_room(has.first) || harmless(has.first, wanted.defines)) &&
           std::stoul(has.second) >= std::stoul(wants.second);
  });
}

bool drafts(const KernelConfig& draft, const KernelConfig& wanted) {
  const auto draws = [&](const std::string& file, const std::string& text) {
    const auto found = draft.generated.find(file);
    return (file == fields_file && wanted.has_programs) ||
           (found != draft.generated.end() && found->second == text);
  };
  if (!interprets(draft) || draft.defines.size() != wanted.defines.size() ||
      !std::ranges::all_of(wanted.generated, [&](const auto& one) { return draws(one.first, one.second); }))
    return false;
  return std::ranges::equal(draft.defines, wanted.defines, [&](const auto& has, const auto& wants) {
    if (has == wants) return true;
    if (has.first != wants.first) return false;
    const unsigned long there = std::stoul(has.second), asked = std::stoul(wants.second);
    if (is_mask(has.first)) return (asked & ~there) == 0;
    return (is_room(has.first) || has_no_use(has.first, wanted.defines)) && there >= asked;
  });
}

KernelConfig general_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning) {
  KernelConfig config = deep_config(scene, device, tuning, general_depth);
  const bool fields = config.generated.contains(fields_file);
  for (auto& [name, value] : config.defines) {
    const bool of_fields = name == "HAS_OCCLUSION" || name == "HAS_SOFT_SHADOWS" || name == "SDF_TWO_SIDED";
    if (harmless(name, config.defines) && (fields || !of_fields)) value = "1";
  }
  widen(config, "BVH_STACK", general_bvh_stack);
  widen(config, "BVH_LEVELS", general_bvh_levels);
  return config;
}

KernelConfig draft_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning) {
  KernelConfig config = deep_config(scene, device, tuning, draft_depth);
  for (auto& [name, value] : config.defines) {
    if (has_no_use(name, config.defines)) value = "1";
    if (is_mask(name)) value = "65535";
  }
  widen(config, "BVH_STACK", draft_bvh_stack);
  widen(config, "BVH_LEVELS", draft_bvh_levels);
  widen(config, "TEXTURE_STACK", MOST_TEXTURE_STACK);
  config.defines["SDF_FLAGS"] = all_field_flags;
  config.generated[fields_file] = interpreting_source;
  config.has_programs = true;
  return config;
}

KernelConfig interpreting_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning) {
  KernelConfig config = general_config(scene, device, tuning);
  config.generated[fields_file] = interpreting_source;
  config.defines["SDF_FLAGS"] = all_field_flags;
  return config;
}

std::vector<KernelConfig> general_configs(const CompiledScene& scene, const DeviceInfo& device,
                                          const Tuning& tuning) {
  std::vector<KernelConfig> all{general_config(scene, device, tuning)};
  if (all.front().has_programs && calls_functions(device))
    all.push_back(interpreting_config(scene, device, tuning));
  for (const char* name : {"HAS_FOG", "HAS_LENS"}) {
    KernelConfig other = all.front();
    std::string& value = other.defines.at(name);
    value = value == "0" ? "1" : "0";
    all.push_back(std::move(other));
  }
  if (calls_functions(device)) all.push_back(draft_config(scene, device, tuning));
  return all;
}

std::size_t greatest_work_group(const KernelConfig& config, const DeviceInfo& device) {
  if (device.device_class != DeviceClass::cpu) return device.max_work_group;
  const std::size_t item =
      config.ray_stack * ray_bytes + std::size_t{config.tile_w} * config.tile_h * batch_bytes;
  return std::min(device.max_work_group, group_memory / item);
}

bool traces_compact(const CompiledScene& scene, const DeviceInfo& device) {
  if (scene.tracer != Tracer::automatic) return scene.tracer == Tracer::compact;
  return !wants_vectors(device);
}

KernelConfig make_kernel_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning) {
  KernelConfig config;
  const bool vectors = !traces_compact(scene, device);
  if (!vectors) config.tile_w = config.tile_h = 1;
  if (tuning.tile_w > 0) {
    config.tile_w = tuning.tile_w;
    config.tile_h = tuning.tile_h;
  }
  const unsigned batch = config.tile_w * config.tile_h;
  KernelDefines& defines = config.defines;
  const auto define = [&](const char* name, unsigned value) { defines[name] = std::to_string(value); };
  define("TILE_W", config.tile_w);
  define("TILE_H", config.tile_h);
  define("WIDE_VECTORS", vectors);
  if (tuning.packet_least > 0) define("PACKET_LEAST", tuning.packet_least);
  // Depth first, `batch` rays at a time, at most that many wait per level, plus one batch of children. Beyond
  // 32 levels, the kernel counts rays that do not fit and the frame reports them.
  const bool waits = scene.features.secondary_rays && !traces_paths(scene.integrator);
  const unsigned rays = waits ? batch * (std::min(scene.info.max_depth, 32u) + 2u) : batch;
  define("RAY_STACK", rays);
  config.ray_stack = rays;
  if (batch == 1) {
    define("LIGHT_ROOM", light_room(scene));
    config.ray_stack += light_room(scene) + 1;
  }
  // Rounded up so that similar scenes share kernels.
  define("BVH_STACK", (scene.features.bvh_stack + 31u) / 32u * 32u);
  if (!vectors) define("BVH_LEVELS", (waiting_levels(scene) + 7u) / 8u * 8u);
  define_features(scene.features, define);
  const unsigned lanes = marched_lanes(batch), few_solids = std::max(2u, lanes * 3 / 2);
  define("FEW_SOLIDS", few_solids);
  // Packets profit from a tree of fewer solids, but not of very few, and its kernels compile slowly.
  const unsigned without_tree = vectors && batch == 16 ? 6 : few_solids;
  define("HAS_BVH", scene.features.shapes[SHAPE_MESH] || scene.info.bounded_count > without_tree);
  define("LANES", lanes);
  if (!scene.field_source.empty()) {
    config.generated[fields_file] = scene.field_source;
    config.has_programs = have_programs(scene.sdf_parameters);
  }
  if (!scene.pattern_source.empty()) config.generated["generated/patterns.cl"] = scene.pattern_source;
  return config;
}

}  // namespace sundog
