// The readers of the single formats; load_model() chooses among them.
#pragma once
#include "scene/model.h"
#include "scene/models/source.h"

namespace sundog::models {

Model load_obj(const Source& source, const ModelOptions& options);
Model load_ply(const Source& source, const ModelOptions& options);
Model load_stl(const Source& source, const ModelOptions& options);
Model load_gltf(const Source& source, const ModelOptions& options);
Model load_nff(const Source& source);

/// Adds `mesh`, whose positions count from `origin`, and an object that places it, unless it has no
/// triangles.
void add_mesh(Model& model, Mesh mesh, const dvec3& origin = dvec3(0));

/// Adds a feature to Model::unread, once.
void leave_unread(Model& model, const std::string& feature);

/// An 8-bit colour channel, taken as sRGB (IEC 61966-2-1), as a linear one.
float linear_from_srgb(double value);

}  // namespace sundog::models
