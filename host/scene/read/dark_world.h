// What fills the world without end takes all light from infinitely far away.
#pragma once
#include "scene/description.h"

namespace sundog {

/// Adds a warning, with the mend, where the world's medium or fog leaves nothing of a sun, a sky or a
/// directional light.
void warn_of_dark_world(SceneDescription& scene);

}  // namespace sundog
