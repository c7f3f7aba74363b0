// Generates a scene document around a model file.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "models/model.h"

namespace sundog {

/// A scene document that places `file` (with content `model`). Camera, lights, image size and background come
/// from the model; defaults are a camera that frames the bounds, of all of its animations if it `plays`, in
/// an image of width / height `aspect` (none: the document's image), and a light background. A model without
/// lights is traced by paths under a soft sky and a key light, which expose its brightest material just below
/// white; without a camera too it gets a matte ground, the second object.
nlohmann::json make_model_scene(const std::filesystem::path& file, const Model& model,
                                std::optional<double> aspect = std::nullopt, bool plays = false);

/// Sets the document's camera and lights to those of the model, as far as it has any.
void set_view(nlohmann::json& document, const Model& model);

/// Removes the ground if a camera at that height would see it from below.
void take_ground_above(nlohmann::json& document, double height);

}  // namespace sundog
