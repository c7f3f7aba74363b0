// Animation: sets the values of a scene document at a frame, from its "animate" tracks.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/json/value.h"

namespace sundog {

/// Sets every animated value of the document to its value at `frame`, and the seed to the frame's number
/// unless the document has its own seed. Throws SceneError for a pointer that leads nowhere, and for a track
/// that a later track would undo.
void apply_animation(nlohmann::json& document, double frame, const JsonContext& context);

inline constexpr double default_frames_per_second = 24;

/// The frame's time in seconds, by the document's "frames_per_second".
double seconds_at(const nlohmann::json& document, double frame);

/// The JSON pointer of the track that sets the value at `pointer` or a part of it; with `whole`, of a track
/// that sets all of it. Empty if there is none.
std::string track_of(const nlohmann::json& document, const std::string& pointer, bool whole = false);

}  // namespace sundog
