// Animation: the values of a scene document at a frame ("animate").
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/json/value.h"

namespace sundog {

/// Sets every animated value of the document to that of `frame`, and the seed to the frame's number where the
/// document leaves that to it. Throws SceneError where a pointer leads nowhere, and where a track would be
/// lost to a later one.
void apply_animation(nlohmann::json& document, double frame, const JsonContext& context);

inline constexpr double default_frames_per_second = 24;

/// The frame's time by the document's "frames_per_second".
double seconds_at(const nlohmann::json& document, double frame);

/// The place in the document of the track that sets the value at `pointer` or a part of it; with `whole` only
/// one that sets all of it. Empty: none does.
std::string track_of(const nlohmann::json& document, const std::string& pointer, bool whole = false);

}  // namespace sundog
