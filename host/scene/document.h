// A scene as an editable JSON document: read from a file, changed in memory, turned into a SceneDescription.
#pragma once
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "models/model.h"
#include "scene/load.h"

namespace sundog {

/// The document that load_scene() reads: a scene file's, or one generated around a model. Throws SceneError.
nlohmann::json read_scene_document(const std::filesystem::path& path, const LoadOptions& options = {});

/// Reads the scene of a document. `file` (which need not exist) names it in messages, and file names are
/// relative to its folder. `made` are additional meshes. Throws SceneError.
SceneDescription load_scene_document(const nlohmann::json& document, const std::filesystem::path& file,
                                     const LoadOptions& options = {}, const NamedMeshes& made = {});

/// Updates `scene`, read from `before`, to `after` if they differ only in camera, size, background, render
/// settings, lights, media, textures and materials. Reads no file, builds no mesh and tries no formula. Null
/// if more differs (see also change_surfaces()), or if the camera has no position. Throws SceneError.
std::shared_ptr<const SceneDescription> change_scene(const SceneDescription& scene,
                                                     const nlohmann::json& before,
                                                     const nlohmann::json& after,
                                                     const LoadOptions& options = {});

}  // namespace sundog
