// See scene_compiler.h.
#include "compile/scene_compiler.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <chrono>

#include "base/error.h"
#include "compile/camera.h"
#include "compile/filter.h"
#include "compile/light_tree.h"
#include "compile/lobe_energy.h"
#include "compile/local_origin.h"
#include "compile/mesh_lights.h"
#include "compile/parts/parts.h"
#include "compile/parts/photons.h"
#include "compile/placing/instances.h"
#include "scene/integrators.h"
#include "scene/pack.h"

namespace sundog {
namespace {

/// Validates indices; a scene made in memory may break them.
void check_objects(const SceneDescription& scene) {
  const auto fits = [](int index, std::size_t size) { return index < static_cast<int>(size); };
  for (const Object& object : scene.objects) {
    const auto* shape = std::get_if<MeshShape>(&object.shape);
    if (shape && (shape->mesh < 0 || !fits(shape->mesh, scene.meshes.size())))
      throw SceneError(scene.file.string(), object.place,
                       "object \"" + object.name + "\" places a mesh that does not exist");
    const auto* field = std::get_if<FieldShape>(&object.shape);
    if (field && (field->field < 0 || !fits(field->field, scene.fields.size())))
      throw SceneError(scene.file.string(), object.place,
                       "object \"" + object.name + "\" places a field that does not exist");
    if (!fits(object.material, scene.materials.size()))
      throw SceneError(scene.file.string(), object.place,
                       "object \"" + object.name + "\" names a material that does not exist");
  }
  for (const MaterialDescription& material : scene.materials)
    if (!fits(material.medium, scene.media.size()))
      throw SceneError(scene.file.string(), "",
                       "material \"" + material.name + "\" names a medium that does not exist");
}

void check_integrator(const SceneDescription& scene) {
  if (!find_integrator(scene.render.integrator))
    throw SceneError(scene.file.string(), "/render/integrator",
                     fmt::format("wanted one of {}, found \"{}\"", fmt::join(integrator_names, ", "),
                                 scene.render.integrator));
}

/// Samples that grow in number must come from a sequence.
u32 sampler_of(const RenderSettings& settings) {
  const bool grows = settings.sampling.threshold > 0 || settings.sampling.progressive;
  return grows && settings.sampler == SAMPLER_AUTO ? SAMPLER_SOBOL : settings.sampler;
}

void set_view(const SceneDescription& scene, CompiledScene& out) {
  set_camera(scene, out.origin, out.info);
  out.features.clear_glass = scene.image.transparent_glass;
  out.features.lens = scene.camera.lens.radius > 0;
  out.features.camera_motion = scene.camera.moves_to.has_value();
  out.sampling = scene.render.sampling;
  out.features.sampler = sampler_of(scene.render);
  out.filter = filter_table(scene.render);
  out.features.filter = !out.filter.empty();
  out.info.roulette_depth = static_cast<u32>(scene.render.roulette == 65 ? 65537 : scene.render.roulette);
  out.info.light_strategy = scene.render.light_strategy;
  if (traces_paths(scene.render.integrator))
    for (const Guide& guide : scene.render.caustics ? std::vector<Guide>{} : scene.render.guides)
      out.guides.push_back(pack(guide.center - out.origin, guide.radius));
  out.features.guides = !out.guides.empty();
}

/// log2 of each pixel's places in the blue noise sequence; rays to a light divide samples.
void set_sample_room(CompiledScene& out) {
  if (out.features.sampler != SAMPLER_BLUE_NOISE) return;
  u32 parts = 1;
  for (const LightRay& ray : out.light_rays) parts = std::max(parts, ray.rays);
  out.features.sample_room = static_cast<u32>(std::bit_width(out.info.samples * parts - 1));
}

/// Whether surfaces test occlusion of area lights by shafts: there are few instances, and only surfaces
/// change light on its way.
bool asks_by_shafts(const CompiledScene& scene) {
  return scene.features.area_lights && !traces_paths(scene.integrator) && !scene.features.absorption &&
         scene.info.instance_count <= SHAFT_INSTANCES && scene.info.field_end == scene.info.instance_count;
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

/// Equal for all scenes; rough glass has one more table.
const SharedTable<float>& lobe_energies(bool glass) {
  const auto first = [](u32 count) {
    const auto rows = built_lobe_energy().first(count);
    return SharedTable<float>(std::vector<float>(rows.begin(), rows.end()));
  };
  static const SharedTable<float> usual = first(LOBE_GLASS),
                                  with_glass = first(static_cast<u32>(built_lobe_energy().size()));
  return glass ? with_glass : usual;
}

/// Builds the light tables once all emitters are known.
void finish_lights(const SceneDescription& scene, CompiledScene& out) {
  add_mesh_lights(scene, out);
  add_light_tree(scene, out);
  if (traces_paths(out.integrator))
    std::erase_if(out.light_rays.edit(), [](const LightRay& ray) { return ray.ray > 0; });
}

}  // namespace

void take_part(const CompiledScene& part, CompiledScene& out) {
#define SUNDOG_TAKE_TABLE(type, host_type, name, label) \
  if (!part.name.empty()) out.name = part.name;
  SCENE_TABLES(SUNDOG_TAKE_TABLE)
#undef SUNDOG_TAKE_TABLE
#define SUNDOG_TAKE_FEATURE(type, definition, name) \
  out.features.name = static_cast<type>(out.features.name | part.features.name);
  SCENE_FEATURES(SUNDOG_TAKE_FEATURE)
#undef SUNDOG_TAKE_FEATURE
  for (std::size_t i = 0; i < part.features.shapes.size(); ++i)
    out.features.shapes[i] |= part.features.shapes[i];
  out.features.unbounded |= part.features.unbounded;
  out.features.bvh_stack = std::max(out.features.bvh_stack, part.features.bvh_stack);
}

struct SceneCompiler::Parts {
  HaloPart halo;
  ScenePart lights;
  SurfacesPart surfaces;
  MeshesPart meshes;
  ScenePart mapping;
  InstancesPart instances;
  ScenePart touching;
  ScenePart fields;

  /// Copies numbers found by the parts.
  void set_numbers(CompiledScene& out) const {
    out.info.ambient = lights.made.info.ambient;
    out.info.fog = lights.made.info.fog;
    out.info.sees_environment = lights.made.info.sees_environment;
    out.info.texel_page = surfaces.made.info.texel_page;
    out.info.tlas_root = instances.made.info.tlas_root;
    out.info.bounded_count = instances.made.info.bounded_count;
    out.info.scene_center = instances.made.info.scene_center;
    out.info.instance_count = instances.made.info.instance_count;
    out.info.field_end = instances.made.info.field_end;
    out.figures.mean_block_fill = meshes.made.figures.mean_block_fill;
    out.figures.sah_cost = instances.made.figures.sah_cost;
    out.figures.box = instances.made.figures.box;
  }
};

SceneCompiler::SceneCompiler() : parts_(std::make_unique<Parts>()) {}
SceneCompiler::~SceneCompiler() = default;
SceneCompiler::SceneCompiler(SceneCompiler&&) noexcept = default;
SceneCompiler& SceneCompiler::operator=(SceneCompiler&&) noexcept = default;

namespace {

/// Makes the part unless its key is unchanged. Returns whether it was made.
template <class P, class Make>
bool renew(P& part, const ContentKey& key, const Make& make) {
  if (part.key == key) return false;
  P made = make();
  made.key = key;
  part = std::move(made);
  return true;
}

}  // namespace

CompiledScene SceneCompiler::compile(const SceneDescription& scene) {
  const auto start = std::chrono::steady_clock::now();
  CompiledScene out;
  out.integrator = scene.render.integrator;
  out.tracer = scene.render.tracer;
  check_objects(scene);
  check_integrator(scene);
  const std::vector<FieldView> views = views_of(scene);
  out.origin = std::ranges::any_of(views, is_deep) ? scene.camera.position : local_origin(scene);
  set_view(scene, out);

  Parts& p = *parts_;
  renew(p.halo, halo_key(scene), [&] { return make_halo(scene); });
  work_.lights +=
      renew(p.lights, lights_key(scene, out.origin), [&] { return make_lights(scene, out.origin, p.halo); });
  work_.surfaces += renew(p.surfaces, surfaces_key(scene), [&] { return make_surfaces(scene); });
  const bool new_meshes =
      renew(p.meshes, meshes_key(scene, p.surfaces), [&] { return make_meshes(scene, p.surfaces); });
  work_.meshes += new_meshes;
  if (new_meshes)
    work_.bvhs += static_cast<std::uint64_t>(std::ranges::count(p.meshes.placed, true, &PlacedMesh::used));
  renew(p.mapping, mapping_key(p.meshes, p.surfaces),
        [&] { return make_mapping(scene, p.meshes, p.surfaces); });
  const bool new_instances = renew(p.instances, instances_key(scene, p.meshes, p.surfaces, out.origin),
                                   [&] { return make_instances(scene, p.meshes, p.surfaces, out.origin); });
  work_.instances += new_instances;
  work_.bvhs += new_instances;
  take_part(p.lights.made, out);
  take_part(p.surfaces.made, out);
  take_part(p.meshes.made, out);
  take_part(p.mapping.made, out);
  take_part(p.instances.made, out);
  parts_->set_numbers(out);
  if (out.features.media) {
    work_.touching += renew(p.touching, touching_key(scene, p.instances, out.origin),
                            [&] { return make_touching(scene, p.instances, out.origin); });
    out.features.touching = p.touching.made.features.touching;
    out.instances = p.touching.made.instances;
  }
  const ContentKey placed = out.features.media ? p.touching.key : p.instances.key;
  work_.fields += renew(p.fields, fields_key(scene, views, placed, out.origin),
                        [&] { return make_fields(scene, views, out); });
  take_part(p.fields.made, out);
  out.field_source = p.fields.made.field_source;
  out.pattern_source = p.surfaces.made.pattern_source;
  out.features.camera_inside = is_camera_inside(scene.camera.position - out.origin,
                                                p.instances.made.instances.rows(), p.instances.boxes);
  finish_lights(scene, out);
  if (out.features.rough || out.features.layers)
    out.lobe_energy = lobe_energies(out.features.rough_glass != 0);
  add_photon_targets(scene, p.instances.boxes, out);
  set_counts(out);
  set_figures(out);
  out.figures.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace sundog
