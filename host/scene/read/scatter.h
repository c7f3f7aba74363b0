// Reads how copies of objects are scattered over a surface, and adds the copies.
#pragma once
#include "scene/json/value.h"
#include "scene/procedural/scatter.h"
#include "scene/read/parts.h"

namespace sundog {

struct ScatterKeys {
  Scatter how;
  std::size_t limit = 0;  // maximum number of copies
};
ScatterKeys read_scatter_keys(JsonObject& object);

/// Adds copies of objects, which were read at the origin, at another place. Throws SceneError at `value` for
/// a transform that cannot be inverted.
void add_copies(std::span<const Object> objects, const dmat4& place, const JsonValue& value,
                SceneDescription& scene);

}  // namespace sundog
