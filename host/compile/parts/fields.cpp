// Compiles the fields, each for its nearest view.
#include "base/error.h"
#include "compile/fields/sdf_deep.h"
#include "compile/parts/steps.h"

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

}  // namespace

Fields compile_field_tables(const FieldInputs& in) {
  Fields out;
  CompiledFields made;
  try {
    if (in.deep) out.instances = *in.instances;
    made = in.deep ? separate_fields(in, out.instances.edit()) : compile_fields(in.fields);
  } catch (const FormulaError& error) {
    // Formulas were checked on reading; only their number and combination may still fail.
    throw SceneError(*in.file, "", error.what());
  }
  // Soft shadows and ambient occlusion approximate light that path tracing computes.
  if (in.paths)
    for (SdfField& field : made.fields) field.shadow_hardness = field.occlusion_reach = 0;
  out.features = features_of(made.fields);
  out.source = std::move(made.source);
  out.fields = std::move(made.fields);
  out.parameters = std::move(made.parameters);
  return out;
}

}  // namespace sundog
