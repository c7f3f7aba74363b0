// Which pictures the viewer takes: each that the pages can be shown and the machine can hold.
#pragma once
#include <cstdint>
#include <optional>

#include "scene/description.h"

namespace sundog {

/// Throws SceneError at /image/width or /image/height where a page cannot be shown such a picture, or where
/// it takes more than a quarter of `available` bytes (none: not known). A frame of no more than `shown`
/// pixels is held already.
void check_frame(const SceneDescription& scene, std::int64_t shown, std::optional<std::uint64_t> available);

}  // namespace sundog
