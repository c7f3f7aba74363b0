// Generates a scene document around a model file.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "models/model.h"

namespace sundog {

/// A scene document that places `file`, whose content is `model`. Camera, lights, image size and background
/// come from the model if it has them. Defaults: a camera that frames the bounds (over all animations if it
/// `plays`) in an image of width / height `aspect` (none: the document's image), and a light background. A
/// model without lights is rendered by path tracing under a soft sky and a key light, which expose its
/// brightest material just below white; if it also has no camera, it gets a matte ground, the second object.
nlohmann::json make_model_scene(const std::filesystem::path& file, const Model& model,
                                std::optional<double> aspect = std::nullopt, bool plays = false);

/// Sets the document's camera and lights to the model's, if it has any.
void set_view(nlohmann::json& document, const Model& model);

/// Removes the ground if a camera at this height would see it from below.
void take_ground_above(nlohmann::json& document, double height);

}  // namespace sundog
