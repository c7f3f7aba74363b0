// A model file as a scene by itself: the document that sundog makes up around it.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "scene/model.h"

namespace sundog {

/// A scene document that places `file` (whose content is `model`): its own camera, lights, image size and
/// background where it has them; else a camera that frames its bounds in an image of width / height `aspect`
/// (without one: the document's image), a key light and an ambient one that expose the model's brightest
/// material just below white, and a light background. A model without camera and lights stands on a matte
/// ground, the second object.
nlohmann::json make_model_scene(const std::filesystem::path& file, const Model& model,
                                std::optional<double> aspect = std::nullopt);

/// Takes the ground away where a camera at that height would look at it from below.
void take_ground_above(nlohmann::json& document, double height);

}  // namespace sundog
