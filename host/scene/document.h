// Updates a scene after its JSON document was edited, without reading everything again.
#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "scene/load.h"

namespace sundog {

/// Updates `scene`, read from `before`, to `after` if they differ only in camera, size, background, render
/// settings, lights, media, textures and materials. Reads no file, builds no mesh and tries no formula. Null
/// if more differs (see also change_surfaces()), or if the camera has no position. Throws SceneError.
std::shared_ptr<const SceneDescription> change_scene(const SceneDescription& scene,
                                                     const nlohmann::json& before,
                                                     const nlohmann::json& after,
                                                     const LoadOptions& options = {});

}  // namespace sundog
