#include "scene/animate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/json/override.h"

namespace sundog {
namespace {

constexpr Range frame_range{.low = -1e6, .high = 1e6};

std::vector<double> numbers(const JsonValue& value) {
  if (value.json().is_number()) return {value.number()};
  if (!value.json().is_array() || value.json().empty()) value.wanted("a number or an array of numbers");
  std::vector<double> result;
  for (const JsonValue& item : value.items("numbers")) result.push_back(item.number());
  return result;
}

bool is_pointer(const std::string& text) {
  try {
    return !nlohmann::json::json_pointer(text).empty();
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

Track::Key read_key(const JsonValue& value) {
  return value.object("track_key", [](JsonObject& object) {
    return Track::Key{object.at("frame", "a frame's number").number(frame_range),
                      numbers(object.at("value", "a number or an array of numbers"))};
  });
}

void read_keys(JsonObject& object, Track& track) {
  const JsonValue list = object.at("keys", "an array of keys");
  for (const JsonValue& item : list.items("keys")) {
    Track::Key key = read_key(item);
    if (!track.keys.empty() && !(key.frame > track.keys.back().frame))
      item.fail(
          fmt::format("wanted frames that rise, found {} after {}", key.frame, track.keys.back().frame));
    if (!track.keys.empty() && key.values.size() != track.keys[0].values.size())
      item.fail(fmt::format("wanted {} numbers as in the first key, found {}", track.keys[0].values.size(),
                            key.values.size()));
    track.keys.push_back(std::move(key));
  }
  if (track.keys.empty()) list.wanted("an array of one key or more");
  track.whole = object.boolean("whole", false);
}

void read_turn(JsonObject& object, Track& track) {
  if (const auto axis = object.find("axis")) track.axis = axis->direction();
  track.center = object.vec3("center", track.center);
  track.degrees = object.number("degrees", track.degrees);
  track.first = object.number("first", track.first, frame_range);
  const JsonValue last = object.at("last", "the frame at which the turn is complete");
  track.last = last.number(frame_range);
  if (!(track.last > track.first))
    last.fail(fmt::format("wanted a frame after \"first\" ({}), found {}", track.first, track.last));
}

Track read_track(const JsonValue& value) {
  using Kind = Track::Kind;
  static constexpr std::array kinds = {NamedValue<Kind>{"linear", Kind::linear},
                                       NamedValue<Kind>{"smooth", Kind::smooth},
                                       NamedValue<Kind>{"rotate", Kind::rotate}};
  const Kind kind = value.member("type", names_of(kinds)).choose(kinds);
  return value.object(kind == Kind::rotate ? "rotate_track" : "keyed_track", [&](JsonObject& object) {
    Track track;
    object.at("type", "");
    track.kind = kind;
    const JsonValue pointer = object.at("value", "the JSON pointer of a value, as \"/camera/fov\"");
    track.pointer = pointer.text();
    if (!is_pointer(track.pointer) || track.pointer.starts_with("/animate"))
      pointer.wanted("the JSON pointer of a value of the scene, as \"/camera/fov\"");
    if (track.kind == Track::Kind::rotate)
      read_turn(object, track);
    else
      read_keys(object, track);
    return track;
  });
}

/// Slope of component `c` at a key: through its neighbours; flat at the ends, where the value is held.
double slope_at(const Track& track, std::size_t key, std::size_t c) {
  if (key == 0 || key + 1 == track.keys.size()) return 0;
  const Track::Key &before = track.keys[key - 1], &after = track.keys[key + 1];
  return (after.values[c] - before.values[c]) / (after.frame - before.frame);
}

double between(const Track& track, std::size_t key, double s, std::size_t c) {
  const Track::Key &from = track.keys[key], &to = track.keys[key + 1];
  const double a = from.values[c], b = to.values[c], length = to.frame - from.frame;
  if (track.kind == Track::Kind::linear) return a + (b - a) * s;
  const double s2 = s * s, s3 = s2 * s;
  return a * (2 * s3 - 3 * s2 + 1) + b * (3 * s2 - 2 * s3) +
         length * (slope_at(track, key, c) * (s3 - 2 * s2 + s) + slope_at(track, key + 1, c) * (s3 - s2));
}

std::vector<double> keyed(const Track& track, double frame) {
  const auto after =
      std::ranges::find_if(track.keys, [&](const Track::Key& key) { return key.frame > frame; });
  if (after == track.keys.begin()) return track.keys.front().values;
  if (after == track.keys.end()) return track.keys.back().values;
  const auto key = static_cast<std::size_t>(after - track.keys.begin()) - 1;
  const double s = (frame - track.keys[key].frame) / (after->frame - track.keys[key].frame);
  std::vector<double> result;
  for (std::size_t c = 0; c < after->values.size(); ++c) result.push_back(between(track, key, s, c));
  return result;
}

/// What stands at the track's pointer.
std::vector<double> standing(const nlohmann::json& document, const Track& track, const JsonValue& place) {
  const nlohmann::json::json_pointer pointer(track.pointer);
  if (!document.contains(pointer)) return {};
  const nlohmann::json& value = document[pointer];
  std::vector<double> result;
  const auto add = [&](const nlohmann::json& item) {
    if (!item.is_number())
      place.fail(
          fmt::format("\"{}\" leads to something that is no number or array of numbers", track.pointer));
    result.push_back(item.get<double>());
  };
  if (value.is_array())
    for (const nlohmann::json& item : value) add(item);
  else
    add(value);
  return result;
}

}  // namespace

std::vector<Track> read_tracks(const JsonValue& list) {
  std::vector<Track> tracks;
  for (const JsonValue& item : list.items("tracks")) tracks.push_back(read_track(item));
  return tracks;
}

std::vector<double> value_at(const Track& track, double frame, const std::vector<double>& now) {
  if (track.kind == Track::Kind::rotate) {
    const double s = std::clamp((frame - track.first) / (track.last - track.first), 0.0, 1.0);
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1), glm::radians(track.degrees * s), track.axis));
    const glm::dvec3 turned = track.center + turn * (glm::dvec3(now[0], now[1], now[2]) - track.center);
    return {turned.x, turned.y, turned.z};
  }
  std::vector<double> values = keyed(track, frame);
  if (track.whole) std::ranges::transform(values, values.begin(), [](double v) { return std::round(v); });
  return values;
}

void apply_animation(nlohmann::json& document, double frame, const JsonContext& context) {
  const nlohmann::json original = document;
  const JsonValue root(original, context);
  const JsonValue list = root.member("animate", "an array of tracks: what the frames change");
  const std::vector<Track> tracks = read_tracks(list);
  const JsonItems places = list.items("tracks");
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const std::vector<double> now = standing(document, tracks[i], places[i]);
    if (tracks[i].kind == Track::Kind::rotate && now.size() != 3)
      places[i].fail(fmt::format("wanted the pointer of an array of 3 numbers to turn, found {}",
                                 now.empty() ? "nothing at " + tracks[i].pointer : tracks[i].pointer));
    const std::vector<double> values = value_at(tracks[i], frame, now);
    const nlohmann::json value =
        values.size() == 1 && now.size() < 2 ? nlohmann::json(values[0]) : nlohmann::json(values);
    try {
      apply_override(document, tracks[i].pointer + "=" + value.dump(), context.file);
    } catch (const SceneError&) {
      places[i].fail(fmt::format("\"{}\" leads nowhere in this scene", tracks[i].pointer));
    }
  }
}

std::string track_of(const nlohmann::json& document, const std::string& place) {
  const nlohmann::json& list = document.at("animate");
  for (std::size_t i = 0; i < list.size(); ++i)
    if (concerns(list[i].at("value").get<std::string>(), place)) return fmt::format("/animate/{}", i);
  return "";
}

}  // namespace sundog
