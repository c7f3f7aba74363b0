// Makes definitions, which are numbers by name; effect_of() determines which kernels may draw a scene that
// asks for other numbers.
#include "render/device/kernel_config.h"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <string>

#include "compile/fields/sdf.h"
#include "device/choice.h"
#include "scene/integrators.h"
#include "shared/textures.h"

namespace sundog {
namespace {

// A CPU's driver keeps a whole group's private memory on a thread's stack, 8 MiB by default, and crashes on
// overflow. A work-item's private memory is its ray stack and its batch.
constexpr std::size_t group_memory = std::size_t{6} << 20, ray_bytes = 80, batch_bytes = 640;

// The generated file with the fields' code.
constexpr const char* fields_file = "generated/sdf.cl";

// The kernel's flags permit features; each field's own flags select among them.
constexpr unsigned all_field_flags = SDF_SMOOTH | SDF_CUT_SPHERE;

constexpr unsigned most_touching = 16;  // faces that a ray may cross together

// General kernels have room for rays of this many levels and for the BVHs of most scenes; drafts for the
// maximum depth and any BVH.
constexpr unsigned general_depth = 12, general_bvh_stack = 64, general_bvh_levels = 32, draft_depth = 32,
                   draft_bvh_stack = 128, draft_bvh_levels = 64;

/// Waiting shadow rays per surface: one per light, within limits, and rounded up so that similar scenes share
/// kernels.
unsigned light_room(const CompiledScene& scene) {
  const unsigned lights = std::clamp(scene.info.light_count, 2u, MOST_LIGHT_ROOM),
                 step = std::bit_floor(lights) / 2;
  return (lights + step - 1) / step * step;
}

/// Room for faces that a ray may cross together (kernels/lib/trace/stretch.cl): up to four of each solid that
/// touches others, and one of each field (kernels/lib/path/touching.cl).
unsigned touching_room(const CompiledScene& scene) {
  constexpr unsigned of_solid = 4, of_field = 1;
  unsigned faces = 0;
  for (const Instance& instance : scene.instances) {
    if (!(instance.touch > 0)) continue;
    const unsigned own = instance.shape == SHAPE_MESH  ? most_touching
                         : instance.shape == SHAPE_SDF ? of_field
                                                       : of_solid;
    faces = std::min(faces + own, most_touching);
  }
  return std::max(faces, 1u);
}

/// Nodes on the longest path from `root` to a leaf.
u32 levels(const std::vector<Bvh8Node>& nodes, u32 root) {
  u32 below = 0;
  for (u32 slot = 0; slot < BVH_WIDTH && (nodes[root].valid >> slot & 1u); ++slot)
    if (const u32 child = nodes[root].child[slot]; !(child & BVH_LEAF))
      below = std::max(below, levels(nodes, child));
  return below + 1;
}

/// Entries of the compact tracer's stack (kernels/lib/trace/single.cl): one per level of the scene's BVH and
/// of the deepest mesh's, a leaf's other instances, and four for the ray in world space; in scenes with
/// lathes at least seven for a ray and its hit while a solid is tested.
unsigned waiting_levels(const CompiledScene& scene) {
  std::set<u32> meshes;
  for (const Instance& instance : scene.instances)
    if (instance.shape == SHAPE_MESH) meshes.insert(instance.root);
  u32 deepest = 0;
  for (const u32 root : meshes) deepest = std::max(deepest, levels(scene.nodes, root));
  const u32 root = scene.info.tlas_root;
  const u32 in_scene = scene.info.bounded_count == 0 || (root & BVH_LEAF) ? 0 : levels(scene.nodes, root);
  return in_scene + 1 + std::max(deepest + 4, scene.features.shapes[SHAPE_LATHE] ? 7u : 0u);
}

/// Rays marched together: the largest vector size that divides a work-item's batch.
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
#define SUNDOG_DEFINE_SOLID(constant, type, name, effect) \
  define("HAS_" #constant, features.shapes[SHAPE_##constant]);
  SOLIDS(SUNDOG_DEFINE_SOLID)
#undef SUNDOG_DEFINE_SOLID
#define SUNDOG_DEFINE_FEATURE(type, definition, name, effect) define(#definition, features.name);
  SCENE_FEATURES(SUNDOG_DEFINE_FEATURE)
#undef SUNDOG_DEFINE_FEATURE
}

/// How a definition changes the result of a scene that does not need it: shared/features.h.
enum class Effect { same, unlayered, rounds, mask, room, alters };

Effect effect_of(const std::string& definition) {
  static const auto& effects = *new const auto([] {
    std::map<std::string, Effect> all{{"HAS_BVH", Effect::same},       {"HAS_MESH", Effect::rounds},
                                      {"HAS_SDF", Effect::rounds},     {"BVH_LEVELS", Effect::room},
                                      {"BVH_STACK", Effect::room},     {"LIGHT_ROOM", Effect::room},
                                      {"MOST_TOUCHING", Effect::room}, {"RAY_STACK", Effect::room}};
#define SUNDOG_SOLID_EFFECT(constant, type, name, effect) all.emplace("HAS_" #constant, Effect::effect);
    SOLIDS(SUNDOG_SOLID_EFFECT)
#undef SUNDOG_SOLID_EFFECT
#define SUNDOG_FEATURE_EFFECT(type, definition, name, effect) all.emplace(#definition, Effect::effect);
    SCENE_FEATURES(SUNDOG_FEATURE_EFFECT)
#undef SUNDOG_FEATURE_EFFECT
    return all;
  }());
  const auto found = effects.find(definition);
  return found == effects.end() ? Effect::alters : found->second;
}

/// Whether kernels with the definition draw a scene of `numbers`, which does not use it, to the same bits.
bool is_harmless(const std::string& definition, const KernelNumbers& numbers) {
  const Effect effect = effect_of(definition);
  return effect == Effect::same || (effect == Effect::unlayered && numbers.at("HAS_LAYERS") == 0);
}

/// Whether kernels with the number `has` of a definition draw a scene that asks for `wants`: to the same bits
/// or, if `may_round`, up to rounding.
bool covers(const std::string& definition, unsigned has, unsigned wants, bool may_round,
            const KernelNumbers& wanted) {
  const Effect effect = effect_of(definition);
  if (definition == "SDF_FLAGS" && has == all_field_flags) return true;
  if (effect == Effect::mask) return may_round && (wants & ~has) == 0;
  return has > wants && (effect == Effect::room || is_harmless(definition, wanted) ||
                         (may_round && (effect == Effect::rounds || effect == Effect::unlayered)));
}

/// Whether kernels of `has` cover all definitions of `wanted`.
bool cover(const KernelConfig& has, const KernelConfig& wanted, bool may_round) {
  const auto covers_it = [&](const auto& one, const auto& other) {
    return one == other || (one.first == other.first &&
                            covers(one.first, one.second, other.second, may_round, wanted.numbers));
  };
  return has.options == wanted.options && std::ranges::equal(has.numbers, wanted.numbers, covers_it);
}

/// Kernels with the scene's features, and secondary rays of at least `depth` levels.
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
  const auto found = config.numbers.find(room);
  if (found != config.numbers.end()) found->second = std::max(found->second, least);
}

}  // namespace

KernelDefines KernelConfig::defines() const {
  KernelDefines texts;
  for (const auto& [name, number] : numbers) texts[name] = std::to_string(number);
  return texts;
}

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
  return same_files && cover(general, wanted, false);
}

bool drafts(const KernelConfig& draft, const KernelConfig& wanted) {
  const auto draws = [&](const std::string& file, const std::string& text) {
    const auto found = draft.generated.find(file);
    return (file == fields_file && wanted.has_programs) ||
           (found != draft.generated.end() && found->second == text);
  };
  return interprets(draft) && cover(draft, wanted, true) &&
         std::ranges::all_of(wanted.generated, [&](const auto& one) { return draws(one.first, one.second); });
}

KernelConfig general_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning) {
  KernelConfig config = deep_config(scene, device, tuning, general_depth);
  const bool fields = config.generated.contains(fields_file);
  for (auto& [name, number] : config.numbers) {
    const bool of_fields = name == "HAS_SIDES" || name == "HAS_OCCLUSION" || name == "HAS_SOFT_SHADOWS" ||
                           name == "SDF_TWO_SIDED";
    if (is_harmless(name, config.numbers) && (fields || !of_fields)) number = 1;
  }
  widen(config, "MOST_TOUCHING", most_touching);
  widen(config, "BVH_STACK", general_bvh_stack);
  widen(config, "BVH_LEVELS", general_bvh_levels);
  return config;
}

KernelConfig draft_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning) {
  if (!calls_functions(device)) return general_config(scene, device, tuning);
  KernelConfig config = deep_config(scene, device, tuning, draft_depth);
  constexpr unsigned all_kinds = (1u << 17) - 1;
  for (auto& [name, number] : config.numbers) {
    const Effect effect = effect_of(name);
    if (effect == Effect::mask) number = all_kinds;
    if (effect != Effect::mask && effect != Effect::room && effect != Effect::alters) number = 1;
  }
  widen(config, "BVH_STACK", draft_bvh_stack);
  widen(config, "BVH_LEVELS", draft_bvh_levels);
  widen(config, "TEXTURE_STACK", MOST_TEXTURE_STACK);
  config.numbers["SDF_FLAGS"] = all_field_flags;
  config.generated[fields_file] = interpreting_source;
  config.has_programs = true;
  return config;
}

KernelConfig drawing_draft_config(const CompiledScene& scene, const DeviceInfo& device,
                                  const Tuning& tuning) {
  const bool lacks_programs = !scene.field_source.empty() && !have_programs(scene.sdf_parameters);
  return lacks_programs ? general_config(scene, device, tuning) : draft_config(scene, device, tuning);
}

KernelConfig interpreting_config(const CompiledScene& scene, const DeviceInfo& device, const Tuning& tuning) {
  KernelConfig config = general_config(scene, device, tuning);
  config.generated[fields_file] = interpreting_source;
  config.numbers["SDF_FLAGS"] = all_field_flags;
  return config;
}

std::vector<KernelConfig> general_configs(const CompiledScene& scene, const DeviceInfo& device,
                                          const Tuning& tuning) {
  std::vector<KernelConfig> all{general_config(scene, device, tuning)};
  if (all.front().has_programs && calls_functions(device))
    all.push_back(interpreting_config(scene, device, tuning));
  for (const char* name : {"HAS_FOG", "HAS_LENS"}) {
    KernelConfig other = all.front();
    unsigned& number = other.numbers.at(name);
    number = number == 0;
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
  config.options = tuning.options;
  if (tuning.tile_w > 0) {
    config.tile_w = tuning.tile_w;
    config.tile_h = tuning.tile_h;
  }
  const unsigned batch = config.tile_w * config.tile_h;
  const auto define = [&](const char* name, unsigned number) { config.numbers[name] = number; };
  define("TILE_W", config.tile_w);
  define("TILE_H", config.tile_h);
  define("WIDE_VECTORS", vectors);
  if (tuning.packet_least > 0) define("PACKET_LEAST", tuning.packet_least);
  // Depth first, `batch` rays at a time: at most that many wait per level, plus one batch of children. With
  // single rays, at most one waits per level. Beyond 34 levels, the kernel counts rays that do not fit, and
  // the frame reports them.
  const bool waits = scene.features.secondary_rays && integrator_of(scene.integrator).branches;
  const unsigned levels = std::min(scene.info.max_depth + (batch > 1 ? 2u : 0u), 34u);
  const unsigned rays = waits ? batch * levels : batch;
  define("RAY_STACK", rays);
  config.ray_stack = rays;
  if (batch == 1) {
    define("LIGHT_ROOM", light_room(scene));
    define("MOST_TOUCHING", touching_room(scene));
    config.ray_stack += light_room(scene) + 1;
  }
  // Rounded up so that similar scenes share kernels.
  define("BVH_STACK", (scene.features.bvh_stack + 31u) / 32u * 32u);
  if (!vectors) define("BVH_LEVELS", (waiting_levels(scene) + 1u) / 2u * 2u);
  define_features(scene.features, define);
  const unsigned lanes = marched_lanes(batch), few_solids = std::max(2u, lanes * 3 / 2);
  define("FEW_SOLIDS", few_solids);
  // Packets benefit from a tree over fewer solids, but not over very few; its kernels compile slowly.
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
