// Runs the steps in the order of the diagram below, skipping those whose inputs' key has not changed, and
// merges their tables and features.
#include "compile/scene_compiler.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "compile/placing/instances.h"
#include "compile/steps.h"
#include "compile/surfaces/lobe_energy.h"
#include "compile/view/field_view.h"
#include "compile/view/local_origin.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

/// log2 of the number of places of each pixel in the blue noise sequence; each ray to a light takes its own.
void set_sample_room(CompiledScene& out) {
  if (out.features.sampler != SAMPLER_BLUE_NOISE) return;
  u32 parts = 1;
  for (const LightRay& ray : out.light_rays) parts = std::max(parts, ray.rays);
  out.features.sample_room = static_cast<u32>(std::bit_width(out.info.samples * parts - 1));
}

/// Whether surfaces test occlusion of area lights with shafts: only among few instances, without fields or
/// absorption.
bool asks_by_shafts(const CompiledScene& scene) {
  return scene.features.area_lights && integrator_of(scene.integrator).branches &&
         !scene.features.absorption && scene.info.instance_count <= SHAFT_INSTANCES &&
         scene.info.field_end == scene.info.instance_count;
}

void set_counts(CompiledScene& out) {
  set_sample_room(out);
  out.info.shafts = asks_by_shafts(out) ? 1 : 0;
  out.info.light_count = static_cast<u32>(out.light_rays.size());
  out.info.table_lights = static_cast<u32>(out.lights.size());
  out.info.guide_count = static_cast<u32>(out.guides.size());
  out.info.material_count = static_cast<u32>(out.materials.size());
  out.info.medium_count = static_cast<u32>(out.media.size());
  out.info.camera_inside = out.features.camera_inside ? 1 : 0;
}

void set_figures(CompiledScene& out) {
  BvhFigures& figures = out.figures;
  figures.nodes = out.nodes.size();
  figures.blocks = out.blocks.size();
  figures.triangles = out.triangles.size();
  figures.instances = out.instances.size();
  figures.bytes = sizeof(SceneInfo) + table_bytes(out);
}

/// The table of lobe energies, equal for all scenes; rough glass has one more.
const SharedTable<float>& lobe_energies(bool glass) {
  const auto first = [](u32 count) {
    const auto rows = built_lobe_energy().first(count);
    return SharedTable<float>(std::vector<float>(rows.begin(), rows.end()));
  };
  static const SharedTable<float> usual = first(LOBE_GLASS),
                                  with_glass = first(static_cast<u32>(built_lobe_energy().size()));
  return glass ? with_glass : usual;
}

/// Adds a part's features to the whole's.
void add_features(const SceneFeatures& part, SceneFeatures& whole) {
#define SUNDOG_ADD_FEATURE(type, definition, name, effect) \
  whole.name = static_cast<type>(whole.name | part.name);
  SCENE_FEATURES(SUNDOG_ADD_FEATURE)
#undef SUNDOG_ADD_FEATURE
  for (std::size_t i = 0; i < part.shapes.size(); ++i) whole.shapes[i] |= part.shapes[i];
  whole.unbounded |= part.unbounded;
  whole.bvh_stack = std::max(whole.bvh_stack, part.bvh_stack);
}

/// Copies the tables and features of a step's result.
template <class Step>
void take_tables(const Step& step, CompiledScene& out) {
#define SUNDOG_TAKE_TABLE(type, host_type, name, label) \
  if constexpr (requires { step.name; }) out.name = step.name;
  SCENE_TABLES(SUNDOG_TAKE_TABLE)
#undef SUNDOG_TAKE_TABLE
  if constexpr (requires { step.features; }) add_features(step.features, out.features);
}

void take(const CompiledView& view, CompiledScene& out) {
  out.info = view.info;
  out.features = view.features;
  out.filter = view.filter;
  out.guides = view.guides;
}

void take(const Lights& lights, CompiledScene& out) {
  take_tables(lights, out);
  out.info.ambient = lights.ambient;
  out.info.fog = lights.fog;
  out.info.sees_environment = lights.sees_environment;
}

void take(const AllLights& lights, CompiledScene& out) {
  take_tables(lights, out);
  out.light_groups = lights.groups;
  out.photons_by = lights.photons_by;
}

void take(const Surfaces& surfaces, CompiledScene& out) {
  take_tables(surfaces, out);
  out.info.texel_page = surfaces.texel_page;
  out.pattern_source = surfaces.pattern_source;
}

void take(const Instances& instances, CompiledScene& out) {
  take_tables(instances, out);
  out.info.tlas_root = instances.tlas_root;
  out.info.bounded_count = instances.bounded_count;
  out.info.scene_center = instances.scene_center;
  out.info.instance_count = instances.instance_count;
  out.info.field_end = instances.field_end;
  out.figures.sah_cost = instances.sah_cost;
  out.figures.box = instances.box;
}

/// Sets the values that depend on several parts.
void finish(CompiledScene& out) {
  if (out.features.rough || out.features.layers)
    out.lobe_energy = lobe_energies(out.features.rough_glass != 0);
  set_counts(out);
  set_figures(out);
}

}  // namespace

struct SceneCompiler::Parts {
  Memo<Halo> halo;
  Memo<Lights> lights;
  Memo<Surfaces> surfaces;
  Memo<Meshes> meshes;
  Memo<MeshMapping> mapping;
  Memo<Instances> instances;
  Memo<Touching> touching;
  Memo<Fields> fields;
};

SceneCompiler::SceneCompiler() : parts_(std::make_unique<Parts>()) {}
SceneCompiler::~SceneCompiler() = default;
SceneCompiler::SceneCompiler(SceneCompiler&&) noexcept = default;
SceneCompiler& SceneCompiler::operator=(SceneCompiler&&) noexcept = default;

//   materials, media, textures, images ─▶ surfaces ─┬▶ mapping ──────────┐
//   meshes ────────────────────────────▶ meshes ────┴▶ instances ─┬──────┼▶ CompiledScene
//   objects ──────────────────────────────────────────▲           └▶ touching ─▶ fields
//   environment ─▶ halo ─┐                                               │
//   lights, fog ─────────┴▶ lights ─▶ lights of meshes, tree, photons ───┘
CompiledScene SceneCompiler::compile(const SceneDescription& scene) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<FieldView> views = views_of(scene);
  const dvec3 origin = any_deep(views) ? scene.camera.position : local_origin(scene);
  CompiledScene out;
  out.origin = origin;
  out.integrator = scene.render.integrator;
  out.tracer = scene.render.tracer;
  out.sampling = scene.render.sampling;
  take(compile_view({file_of(scene), origin, scene.camera, scene.image, scene.render}), out);

  auto& [halo, lights, surfaces, meshes, mapping, instances, touching, fields] = *parts_;
  work_.surfaces += memo(surfaces, surface_inputs(scene), compile_surfaces);
  take(surfaces.value, out);
  if (memo(meshes, mesh_inputs(scene, surfaces.value), compile_meshes)) {
    ++work_.meshes;
    work_.bvhs +=
        static_cast<std::uint64_t>(std::ranges::count(meshes.value.placed, true, &PlacedMesh::used));
  }
  take_tables(meshes.value, out);
  out.figures.mean_block_fill = meshes.value.mean_block_fill;
  memo(mapping, mapping_inputs(scene, meshes.known(), surfaces.value), compile_mapping);
  take_tables(mapping.value, out);
  if (memo(instances, instance_inputs(scene, origin, meshes.known(), surfaces.value), compile_instances)) {
    ++work_.instances;
    ++work_.bvhs;
  }
  take(instances.value, out);
  out.features.camera_inside = is_camera_inside(scene.camera.position - origin,
                                                instances.value.instances.rows(), instances.value.boxes);
  const bool media = out.features.media;
  if (!media)  // materials that no object uses may name media
    out.features.absorption = out.features.scattering = out.features.dispersion = false;
  if (media)
    work_.touching += memo(touching, touching_inputs(scene, origin, instances.known()), compile_touching);
  out.features.touching = media && (touching.value.any || out.features.near_fields);
  out.instances = media ? touching.value.instances : instances.value.instances;
  work_.fields +=
      memo(fields,
           field_inputs(scene, origin, views, {&out.instances, media ? touching.key : instances.key},
                        instances.value.instance_count),
           compile_field_tables);
  take_tables(fields.value, out);
  out.field_source = fields.value.source;
  if (any_deep(views)) out.instances = fields.value.deep_instances;
  memo(halo, HaloInputs{&scene.environment}, compile_halo);
  work_.lights += memo(lights, light_inputs(scene, origin, halo.known()), compile_lights);
  take(lights.value, out);
  take(compile_all_lights(all_lights_inputs(scene, out, lights.value, surfaces.value, instances.value)), out);
  finish(out);
  out.figures.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace sundog
