// One reader per model format; load_model() selects one.
#pragma once
#include "models/model.h"
#include "models/source.h"

namespace sundog::models {

#define SUNDOG_READER(extension, reader) Model load_##reader(Source source, const ModelOptions& options);
SUNDOG_MODEL_FORMATS(SUNDOG_READER, SUNDOG_READER)
#undef SUNDOG_READER

/// Adds `mesh`, with positions relative to `origin`, and an object that places it, unless it is empty.
void add_mesh(Model& model, Mesh mesh, const dvec3& origin = dvec3(0));

/// Adds a feature to Model::unread once.
void leave_unread(Model& model, const std::string& feature);

/// Converts an sRGB channel in [0, 1] (IEC 61966-2-1) to linear.
float linear_from_srgb(double value);

}  // namespace sundog::models
