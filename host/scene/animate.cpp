// Resolves names, checks that tracks do not undo each other, and applies them in order; then seeds the noise
// with the frame's number.
#include "scene/animate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/json/override.h"
#include "scene/read/tracks.h"

namespace sundog {
namespace {

using nlohmann::json;

bool is_point(const json& value) {
  return value.is_array() && value.size() == 3 &&
         std::ranges::all_of(value, [](const json& item) { return item.is_number(); });
}

/// Checks that a track does not undo an earlier one: keyed tracks replace the value, while a turning track
/// starts from the current value.
void check_alone(const std::vector<Track>& tracks, std::size_t i, const JsonValue& place) {
  if (tracks[i].kind == Track::Kind::rotate) return;
  for (std::size_t k = 0; k < i; ++k)
    if (overlap(tracks[i].pointer, tracks[k].pointer))
      place.fail(tracks[k].kind == Track::Kind::rotate
                     ? fmt::format("undoes what /animate/{} turns: put the track with keys before it", k)
                     : fmt::format("moves {}, as /animate/{} does: take one of the tracks out",
                                   tracks[i].pointer, k));
}

void apply_track(json& document, const Track& track, double frame, const JsonValue& place) {
  json now;
  if (track.kind == Track::Kind::rotate) {
    now = value_or_default(document, track.pointer);
    if (!is_point(now))
      place.fail(fmt::format("wanted the pointer of an array of 3 numbers to turn, found {}", track.pointer));
  }
  try {
    set_value(document, track.pointer, value_at(track, frame, now), place.context().file,
              fmt::format("\"{}\"", track.pointer));
  } catch (const SceneError& error) {
    place.fail(error.reason);
  }
}

void apply_tracks(json& document, double frame, const JsonValue& list) {
  std::vector<Track> tracks = read_tracks(list);
  const JsonItems places = list.items("tracks");
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    tracks[i].pointer = resolve_names(document, tracks[i].pointer);
    check_alone(tracks, i, places[i]);
    apply_track(document, tracks[i], frame, places[i]);
  }
}

/// Gives each frame its own noise, unless the scene has a seed.
void set_seed(json& document, double frame) {
  json& seed = document["render"]["seed"];
  if (seed.is_null() || seed == "frame") seed = std::abs(std::lround(frame));
}

}  // namespace

void apply_animation(json& document, double frame, const JsonContext& context) {
  if (document.contains("animate")) {
    const json tracks = document["animate"];  // a copy: tracks may change the document
    apply_tracks(document, frame, JsonObject::section("scene", "animate", tracks, context));
  }
  if (!document.contains("render") || document["render"].is_object()) set_seed(document, frame);
}

double seconds_at(const json& document, double frame) {
  const auto rate = document.find("frames_per_second");
  const bool given = rate != document.end() && rate->is_number() && rate->get<double>() > 0;
  return frame / (given ? rate->get<double>() : default_frames_per_second);
}

std::string track_of(const json& document, const std::string& pointer, bool whole) {
  const json list = document.value("animate", json::array());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string moved = resolve_names(document, list[i].at("value").get<std::string>());
    if (whole ? list[i].at("type") != "rotate" && leads_through(pointer, moved) : overlap(moved, pointer))
      return fmt::format("/animate/{}", i);
  }
  return "";
}

}  // namespace sundog
