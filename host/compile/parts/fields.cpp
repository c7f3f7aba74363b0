// Compiles the fields, each for its nearest view.
#include <algorithm>
#include <limits>

#include "base/error.h"
#include "compile/parts/parts.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

bool any_deep(const std::vector<FieldView>& views) { return std::ranges::any_of(views, is_deep); }

dvec3 origin_in(const Object& object, const dvec3& origin) {
  return dvec3(glm::inverse(object.world_from_object) * glm::dvec4(origin, 1));
}

/// In a deep view, each placed field is separate and relative to the tables' origin.
std::vector<DeepField> deep_fields(const SceneDescription& scene, const std::vector<FieldView>& views,
                                   CompiledScene& out) {
  std::vector<DeepField> fields;
  for (u32 i = out.info.instance_count; i < out.info.field_end; ++i) {
    Instance& instance = out.instances.edit()[i];
    const Object& object = scene.objects[instance.object];
    fields.push_back({near_description(scene.fields[instance.root], views[instance.object]),
                      origin_in(object, out.origin)});
    instance.root = static_cast<u32>(fields.size() - 1);
  }
  return fields;
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

/// Soft shadows and ambient occlusion approximate light that path tracing computes.
void drop_artifices(CompiledScene& out) {
  for (SdfField& field : out.sdf_fields.edit()) field.shadow_hardness = field.occlusion_reach = 0;
}

void add_features(CompiledScene& out) {
  for (const SdfField& field : out.sdf_fields) {
    out.features.glow |= field.glow.w > 0;
    out.features.occlusion |= field.occlusion_reach > 0;
    out.features.soft_shadows |= field.shadow_hardness > 0;
    out.features.field_flags |= field.flags;
  }
}

}  // namespace

std::vector<FieldView> views_of(const SceneDescription& scene) {
  std::vector<FieldView> views(scene.objects.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    if (std::holds_alternative<FieldShape>(scene.objects[i].shape))
      views[i] = view_of_field(scene, scene.objects[i]);
  return views;
}

ContentKey fields_key(const SceneDescription& scene, const std::vector<FieldView>& views,
                      const ContentKey& instances, const dvec3& origin) {
  KeyMaker key;
  const bool deep = any_deep(views);
  key.add(deep).add(traces_paths(scene.render.integrator));
  if (!deep) return key.add_all(near_fields(scene, views)).key();
  key.add(instances).add(origin);
  for (std::size_t i = 0; i < views.size(); ++i)
    if (const auto* shape = std::get_if<FieldShape>(&scene.objects[i].shape))
      key.add(near_description(scene.fields[static_cast<std::size_t>(shape->field)], views[i]));
  return key.key();
}

ScenePart make_fields(const SceneDescription& scene, const std::vector<FieldView>& views,
                      const CompiledScene& instances) {
  ScenePart part;
  CompiledFields fields;
  try {
    if (any_deep(views)) {
      part.made.instances = instances.instances;
      part.made.info = instances.info;
      part.made.origin = instances.origin;
      fields = compile_deep_fields(deep_fields(scene, views, part.made));
    } else {
      fields = compile_fields(near_fields(scene, views));
    }
  } catch (const FormulaError& error) {
    // Formulas were checked on reading; only their number and combination may still fail.
    throw SceneError(scene.file.string(), "", error.what());
  }
  part.made.field_source = std::move(fields.source);
  part.made.sdf_fields = std::move(fields.fields);
  part.made.sdf_parameters = std::move(fields.parameters);
  if (traces_paths(scene.render.integrator)) drop_artifices(part.made);
  add_features(part.made);
  return part;
}

}  // namespace sundog
