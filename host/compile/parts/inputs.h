// Gathers what the steps of compile() read of a description.
#pragma once
#include <vector>

#include "compile/fields/sdf_deep.h"
#include "compile/parts/steps.h"

namespace sundog {

LightInputs light_inputs(const SceneDescription& scene, const dvec3& origin, const Known<Halo>& halo);
SurfaceInputs surface_inputs(const SceneDescription& scene);
MeshInputs mesh_inputs(const SceneDescription& scene, const Surfaces& surfaces);
MappingInputs mapping_inputs(const SceneDescription& scene, const Known<Meshes>& meshes,
                             const Surfaces& surfaces);
InstanceInputs instance_inputs(const SceneDescription& scene, const dvec3& origin,
                               const Known<Meshes>& meshes, const Surfaces& surfaces);
TouchingInputs touching_inputs(const SceneDescription& scene, const dvec3& origin,
                               const Known<Instances>& instances);

/// The camera's views of fields, one for each object, empty for other objects.
std::vector<FieldView> views_of(const SceneDescription& scene);
bool any_deep(const std::vector<FieldView>& views);
/// `placed`: the instances, of which those of fields begin at `first`.
FieldInputs field_inputs(const SceneDescription& scene, const dvec3& origin,
                         const std::vector<FieldView>& views, const Known<SharedTable<Instance>>& placed,
                         u32 first);

}  // namespace sundog
