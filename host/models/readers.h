// One reader per model format; load_model() selects one.
#pragma once
#include "models/model.h"
#include "models/source.h"

namespace sundog::models {

Model load_obj(Source source, const ModelOptions& options);
Model load_ply(Source source, const ModelOptions& options);
Model load_stl(Source source, const ModelOptions& options);
Model load_gltf(Source source, const ModelOptions& options);
Model load_nff(Source source, const ModelOptions& options);

/// Adds `mesh`, with positions relative to `origin`, and an object that places it, unless it is empty.
void add_mesh(Model& model, Mesh mesh, const dvec3& origin = dvec3(0));

/// Adds a feature to Model::unread once.
void leave_unread(Model& model, const std::string& feature);

/// An 8-bit sRGB channel (IEC 61966-2-1) as linear.
float linear_from_srgb(double value);

}  // namespace sundog::models
