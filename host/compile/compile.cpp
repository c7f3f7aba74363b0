// compile(): from the description to the tables, in the order of their dependence.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "compile/camera.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "compile/fields/sdf_deep.h"
#include "compile/filter.h"
#include "compile/instances.h"
#include "compile/light_tree.h"
#include "compile/lobe_energy.h"
#include "compile/local_origin.h"
#include "compile/materials.h"
#include "compile/mesh_bvh.h"
#include "compile/textures.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

/// Indices that the loaders promise; a scene made by hand may break them.
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

/// The fields' views, an object each that is one.
std::vector<FieldView> views_of(const SceneDescription& scene) {
  std::vector<FieldView> views(scene.objects.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    if (std::holds_alternative<FieldShape>(scene.objects[i].shape))
      views[i] = view_of_field(scene, scene.objects[i]);
  return views;
}

/// In a deep view each placed field is one of its own, which counts from the tables' origin.
CompiledFields deep_fields(const SceneDescription& scene, const std::vector<FieldView>& views,
                           CompiledScene& out) {
  std::vector<DeepField> fields;
  for (u32 i = out.info.instance_count; i < out.info.field_end; ++i) {
    Instance& instance = out.instances[i];
    const Object& object = scene.objects[instance.object];
    fields.push_back({near_description(scene.fields[instance.root], views[instance.object]),
                      dvec3(glm::inverse(object.world_from_object) * glm::dvec4(out.origin, 1))});
    instance.root = static_cast<u32>(fields.size() - 1);
  }
  return compile_deep_fields(fields);
}

/// Each as its nearest view wants it.
CompiledFields near_fields(const SceneDescription& scene, const std::vector<FieldView>& views) {
  std::vector<SdfDescription> fields = scene.fields;
  std::vector<double> nearest(fields.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto* shape = std::get_if<FieldShape>(&scene.objects[i].shape);
    if (!shape) continue;
    const auto field = static_cast<std::size_t>(shape->field);
    if (!(views[i].footprint < nearest[field])) continue;
    nearest[field] = views[i].footprint;
    fields[field] = near_description(scene.fields[field], views[i]);
  }
  return compile_fields(fields);
}

/// Reading has checked each formula; only their number and their combination may still fail.
CompiledFields fields_of(const SceneDescription& scene, const std::vector<FieldView>& views,
                         CompiledScene& out) {
  try {
    return std::ranges::any_of(views, is_deep) ? deep_fields(scene, views, out) : near_fields(scene, views);
  } catch (const FormulaError& error) {
    throw SceneError(scene.file.string(), "", error.what());
  }
}

bool absorbs(const Medium& medium) {
  const float4& a = medium.absorption;
  return a.x != 0 || a.y != 0 || a.z != 0;
}

/// As highlight() of kernels/lib/shade/bsdf.cl tells them.
bool has_fractional_exponent(const Material& material) {
  const float exponent = material.specular.w;
  return exponent != std::floor(exponent) || exponent > GREATEST_WHOLE_EXPONENT;
}

void add_field_features(CompiledScene& out) {
  for (const SdfField& field : out.sdf_fields) {
    out.features.glow |= field.glow.w > 0;
    out.features.occlusion |= field.occlusion_reach > 0;
    out.features.soft_shadows |= field.shadow_hardness > 0;
    out.features.field_flags |= field.flags;
  }
}

void set_counts(CompiledScene& out) {
  out.info.light_count = static_cast<u32>(out.light_rays.size());
  out.info.table_lights = static_cast<u32>(out.lights.size());
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

/// Samples that more are added to come of a sequence.
u32 sampler_of(const RenderSettings& settings) {
  const bool grows = settings.sampling.threshold > 0 || settings.sampling.progressive;
  return grows && settings.sampler == SAMPLER_AUTO ? SAMPLER_SOBOL : settings.sampler;
}

void add_fields(CompiledFields fields, CompiledScene& out) {
  out.field_source = std::move(fields.source);
  out.sdf_fields = std::move(fields.fields);
  out.sdf_parameters = std::move(fields.parameters);
}

}  // namespace

std::size_t table_bytes(const SceneTables& tables) {
  std::size_t bytes = 0;
  for_each_table(tables, [&](const char*, const auto& table) { bytes += table.size() * sizeof table[0]; });
  return bytes;
}

CompiledScene compile(const SceneDescription& scene) {
  const auto start = std::chrono::steady_clock::now();
  CompiledScene out;
  out.integrator = scene.render.integrator;
  out.tracer = scene.render.tracer;
  check_objects(scene);
  if (!find_integrator(scene.render.integrator))
    throw SceneError(scene.file.string(), "/render/integrator",
                     fmt::format("wanted one of {}, found \"{}\"", fmt::join(integrator_names, ", "),
                                 scene.render.integrator));
  const std::vector<FieldView> views = views_of(scene);
  out.origin = std::ranges::any_of(views, is_deep) ? scene.camera.position : local_origin(scene);
  set_camera(scene, out.origin, out.info);
  out.features.lens = scene.camera.lens.radius > 0;
  out.features.camera_motion = scene.camera.moves_to.has_value();
  add_lights(scene, out);
  add_environment(scene, out);
  add_light_tree(scene, out);
  const u32 default_material = add_materials(scene, out);
  out.sampling = scene.render.sampling;
  out.features.sampler = sampler_of(scene.render);
  out.filter = filter_table(scene.render);
  out.features.filter = !out.filter.empty();
  add_textures(scene, out);
  out.features.media = absorbs(out.media[0]);
  out.features.absorption = std::ranges::any_of(out.media, absorbs);
  out.features.fractional_exponents = std::ranges::any_of(out.materials, has_fractional_exponent);
  const std::vector<PlacedMesh> meshes = add_meshes(scene, default_material, out);
  add_further_uvs(scene, meshes, out);
  add_tangents(scene, meshes, out);
  add_instances(scene, meshes, default_material, out);
  add_fields(fields_of(scene, views, out), out);
  add_field_features(out);
  if (out.features.rough) out.lobe_energy = make_lobe_energy();
  add_fog(scene, out);
  set_counts(out);
  set_figures(out);
  out.figures.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace sundog
