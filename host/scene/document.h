// A scene as the JSON document that people edit: read from a file, changed in memory, turned into a
// SceneDescription again.
#pragma once
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "scene/load.h"
#include "scene/model.h"

namespace sundog {

/// The document that load_scene() reads: a scene file's own, or the one that is made up around a model.
/// Throws SceneError.
nlohmann::json read_scene_document(const std::filesystem::path& path, const LoadOptions& options = {});

/// The scene of a document. `file` (it need not be there) stands for it in messages, and names of files count
/// from its folder. `made` are meshes beside the document's. Throws SceneError.
SceneDescription load_scene_document(const nlohmann::json& document, const std::filesystem::path& file,
                                     const LoadOptions& options = {}, const NamedMeshes& made = {});

/// The scene of `after`, where that differs from `before` (whose scene is `scene`) in nothing but the camera,
/// the size and background, the render settings, lights, media, textures and materials: no file is read
/// again, no mesh made, no formula of a field tried out. Null where more differs (change_surfaces() has
/// cases), or where the camera has no place of its own. Throws SceneError.
std::shared_ptr<const SceneDescription> change_scene(const SceneDescription& scene,
                                                     const nlohmann::json& before,
                                                     const nlohmann::json& after,
                                                     const LoadOptions& options = {});

}  // namespace sundog
