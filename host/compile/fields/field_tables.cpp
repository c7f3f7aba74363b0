// Compiles the fields, each for its nearest view.
#include <limits>

#include "base/error.h"
#include "compile/fields/sdf_deep.h"
#include "compile/steps.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

/// In a deep view, each placed field is separate and relative to the tables' origin.
CompiledFields separate_fields(const FieldInputs& in, std::vector<Instance>& instances) {
  std::vector<DeepField> fields;
  for (std::size_t k = 0; k < in.fields.size(); ++k) {
    Instance& instance = instances[*in.first_instance + k];
    const dmat4& world_from_object = (*in.objects)[instance.object].world_from_object;
    fields.push_back({in.fields[k], dvec3(glm::inverse(world_from_object) * glm::dvec4(in.origin, 1))});
    instance.root = static_cast<u32>(k);
  }
  return compile_deep_fields(fields);
}

SceneFeatures features_of(const std::vector<SdfField>& fields) {
  SceneFeatures features;
  for (const SdfField& field : fields) {
    features.glow |= field.glow.w > 0;
    features.occlusion |= field.occlusion_reach > 0;
    features.soft_shadows |= field.shadow_hardness > 0;
    features.field_flags |= field.flags;
  }
  return features;
}

/// Each field for its nearest view.
std::vector<SdfDescription> near_fields(const SceneDescription& scene, const std::vector<FieldView>& views) {
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
  return fields;
}

/// One field per object that places one.
std::vector<SdfDescription> placed_fields(const SceneDescription& scene,
                                          const std::vector<FieldView>& views) {
  std::vector<SdfDescription> fields;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (const auto* shape = std::get_if<FieldShape>(&scene.objects[i].shape))
      fields.push_back(near_description(scene.fields[static_cast<std::size_t>(shape->field)], views[i]));
  return fields;
}

}  // namespace

FieldInputs field_inputs(const SceneDescription& scene, const dvec3& origin,
                         const std::vector<FieldView>& views, const Known<SharedTable<Instance>>& placed,
                         u32 first) {
  FieldInputs in{.file = file_of(scene),
                 .paths = integrator_of(scene.render.integrator).own_materials,
                 .deep = any_deep(views)};
  if (!in.deep) {
    in.fields = near_fields(scene, views);
    return in;
  }
  in.fields = placed_fields(scene, views);
  in.instances = placed;
  in.origin = origin;
  in.first_instance = {first};
  in.objects = {scene.objects};
  return in;
}

Fields compile_field_tables(const FieldInputs& in) {
  Fields out;
  CompiledFields made;
  try {
    if (in.deep) out.deep_instances = *in.instances;
    made = in.deep ? separate_fields(in, out.deep_instances.edit()) : compile_fields(in.fields);
  } catch (const FormulaError& error) {
    // Formulas were checked on reading; only their number and combination may still fail.
    throw SceneError(*in.file, "", error.what());
  }
  // Soft shadows and ambient occlusion approximate light that path tracing computes.
  if (in.paths)
    for (SdfField& field : made.fields) field.shadow_hardness = field.occlusion_reach = 0;
  out.features = features_of(made.fields);
  out.source = std::move(made.source);
  out.sdf_fields = std::move(made.fields);
  out.sdf_parameters = std::move(made.parameters);
  return out;
}

}  // namespace sundog
