// Reads keys and turns, checks their order, and evaluates the curves between keys.
#include "scene/read/tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/json/members.h"

namespace sundog {
namespace {

using nlohmann::json;

bool is_numeric(const json& value) {
  return value.is_number() || (value.is_array() && !value.empty() &&
                               std::ranges::all_of(value, [](const json& item) { return item.is_number(); }));
}

std::vector<double> numbers(const JsonValue& value) {
  if (value.json().is_number()) return {value.number()};
  std::vector<double> result;
  for (const JsonValue& item : value.items("numbers")) result.push_back(item.number());
  return result;
}

bool is_rotation(const std::vector<double>& values) {
  return values.size() == 4 && std::ranges::any_of(values, [](double v) { return v != 0; });
}

bool is_pointer(const std::string& text) {
  try {
    return !json::json_pointer(text).empty();
  } catch (const json::exception&) {
    return false;
  }
}

std::optional<TrackHandle> read_handle(JsonObject& object, const char* name) {
  const auto value = object.find(name);
  if (!value) return std::nullopt;
  return value->object("track_handle", [](JsonObject& handle) {
    return TrackHandle{handle.at("frame").number(), numbers(handle.at("value"))};
  });
}

TrackKey read_key(const JsonValue& value, Track::Kind kind) {
  return value.object("track_key", [&](JsonObject& object) {
    TrackKey key;
    object.read("frame", key.frame);
    const JsonValue at = object.at("value");
    key.value = at.json();
    if (at.json().is_object() || at.json().is_null()) at.wanted("a number, an array, a text, true or false");
    if (is_numeric(at.json())) key.values = numbers(at);
    if (kind == Track::Kind::slerp && !is_rotation(key.values)) at.wanted(quaternion_text);
    key.left = read_handle(object, "handle_left");
    key.right = read_handle(object, "handle_right");
    if ((key.left || key.right) && kind != Track::Kind::bezier)
      value.fail("handles are for tracks of the type \"bezier\"");
    return key;
  });
}

/// Checks a key against the one before: frames must rise, and values have the same form.
void check_next(const JsonValue& place, const TrackKey& before, const TrackKey& key) {
  if (!(key.frame > before.frame))
    place.fail(fmt::format("wanted frames that rise, found {} after {}", key.frame, before.frame));
  if (key.values.empty() != before.values.empty())
    place.fail("wanted numbers in all keys of the track, or in none");
  if (key.values.size() != before.values.size())
    place.fail(fmt::format("wanted {} numbers as in the first key, found {}", before.values.size(),
                           key.values.size()));
}

/// Checks that handles lie between their key and its neighbour: a curve that turned back in time would have
/// two values at a frame.
void check_handles(const JsonValue& place, const Track& track, std::size_t i) {
  const TrackKey& key = track.keys[i];
  const double from = i > 0 ? track.keys[i - 1].frame : any_number.low,
               to = i + 1 < track.keys.size() ? track.keys[i + 1].frame : any_number.high;
  const auto check = [&](const std::optional<TrackHandle>& handle, double low, double high) {
    if (handle && !(handle->frame >= low && handle->frame <= high))
      place.fail(
          fmt::format("wanted a handle in the frames {} to {}, between its key and the next one, found {}",
                      low, high, handle->frame));
    if (handle && handle->values.size() != key.values.size())
      place.fail(fmt::format("wanted {} numbers in a handle as in its key, found {}", key.values.size(),
                             handle->values.size()));
  };
  check(key.left, from, key.frame);
  check(key.right, key.frame, to);
}

void read_keys(JsonObject& object, Track& track) {
  const JsonValue list = object.at("keys");
  const JsonItems items = list.items("keys");
  for (const JsonValue& item : items) {
    TrackKey key = read_key(item, track.kind);
    if (!track.keys.empty()) check_next(item, track.keys.back(), key);
    track.keys.push_back(std::move(key));
  }
  for (std::size_t i = 0; i < track.keys.size(); ++i) check_handles(items[i], track, i);
}

void read_turn(JsonObject& object, Track& track) {
  if (const auto axis = object.find("axis")) track.axis = axis->direction();
  if (!(track.last > track.first))
    object.at("last").fail(
        fmt::format("wanted a frame after \"first\" ({}), found {}", track.first, track.last));
}

Track read_track(const JsonValue& value) {
  using Kind = Track::Kind;
  const bool turns = value.type() == "rotate";
  return value.object("track", [&](JsonObject& object) {
    Track track;
    if (turns)
      track.kind = Kind::rotate;
    else
      object.read("type", track.kind);
    const JsonValue pointer = object.at("value");
    track.pointer = pointer.text();
    if (!is_pointer(track.pointer) || track.pointer.starts_with("/animate"))
      pointer.wanted("the JSON pointer of a value of the scene, as \"/camera/fov\"");
    read_members(object, track, {"axis"});
    if (turns)
      read_turn(object, track);
    else
      read_keys(object, track);
    return track;
  });
}

/// The slope of component c from key `key` to the next key.
double secant(const Track& track, std::size_t key, std::size_t c) {
  const TrackKey &from = track.keys[key], &to = track.keys[key + 1];
  return (to.values[c] - from.values[c]) / (to.frame - from.frame);
}

/// The slope of component c at a key, at most three times either neighbouring slope, so that the curve does
/// not overshoot.
double slope_at(const Track& track, std::size_t key, std::size_t c) {
  const std::size_t last = track.keys.size() - 1;
  const bool is_end = key == 0 || key == last;
  if (is_end && (!track.cycle || last == 0)) return 0;
  const std::size_t before = key == 0 ? last - 1 : key - 1, after = key == last ? 0 : key;
  const auto length = [&](std::size_t k) { return track.keys[k + 1].frame - track.keys[k].frame; };
  const double a = secant(track, before, c), b = secant(track, after, c);
  if (a * b <= 0) return 0;
  const double mean = (a * length(before) + b * length(after)) / (length(before) + length(after));
  return std::copysign(std::min(std::abs(mean), 3 * std::min(std::abs(a), std::abs(b))), mean);
}

/// The Bezier curve of one component between two keys.
struct Curve {
  double frames[4], values[4];
};

Curve curve_at(const Track& track, std::size_t key, std::size_t c) {
  const TrackKey &from = track.keys[key], &to = track.keys[key + 1];
  const double third = (to.frame - from.frame) / 3;
  Curve curve{{from.frame, from.frame + third, to.frame - third, to.frame},
              {from.values[c], from.values[c] + third * slope_at(track, key, c),
               to.values[c] - third * slope_at(track, key + 1, c), to.values[c]}};
  if (from.right) curve.frames[1] = from.right->frame, curve.values[1] = from.right->values[c];
  if (to.left) curve.frames[2] = to.left->frame, curve.values[2] = to.left->values[c];
  return curve;
}

double bezier(const double (&p)[4], double s) {
  const double r = 1 - s;
  return r * r * r * p[0] + 3 * r * r * s * p[1] + 3 * r * s * s * p[2] + s * s * s * p[3];
}

double value_of(const Curve& curve, double frame) {
  double low = 0, high = 1;  // frames rise along the curve
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (bezier(curve.frames, middle) < frame ? low : high) = middle;
  }
  return bezier(curve.values, (low + high) / 2);
}

double between(const Track& track, std::size_t key, double frame, std::size_t c) {
  const TrackKey &from = track.keys[key], &to = track.keys[key + 1];
  const double a = from.values[c], b = to.values[c], length = to.frame - from.frame,
               s = (frame - from.frame) / length;
  if (track.kind == Track::Kind::linear) return a + (b - a) * s;
  if (track.kind == Track::Kind::bezier) return value_of(curve_at(track, key, c), frame);
  const double s2 = s * s, s3 = s2 * s;
  return a + (b - a) * (3 * s2 - 2 * s3) +
         length * (slope_at(track, key, c) * (s3 - 2 * s2 + s) + slope_at(track, key + 1, c) * (s3 - s2));
}

std::vector<double> turned_between(const TrackKey& from, const TrackKey& to, double frame) {
  const auto quaternion = [](const std::vector<double>& v) {
    return glm::normalize(glm::dquat(v[3], v[0], v[1], v[2]));
  };
  const glm::dquat q = glm::slerp(quaternion(from.values), quaternion(to.values),
                                  (frame - from.frame) / (to.frame - from.frame));
  return {q.x, q.y, q.z, q.w};
}

json keyed(const Track& track, double frame) {
  const TrackKey &first = track.keys.front(), &last = track.keys.back();
  if (const double length = last.frame - first.frame; track.cycle && length > 0)
    frame -= std::floor((frame - first.frame) / length) * length;
  const auto after = std::ranges::find_if(track.keys, [&](const TrackKey& key) { return key.frame > frame; });
  if (after == track.keys.begin()) return first.value;
  const auto key = static_cast<std::size_t>(after - track.keys.begin()) - 1;
  const TrackKey& from = track.keys[key];
  if (after == track.keys.end() || from.values.empty() || track.kind == Track::Kind::step ||
      frame == from.frame)
    return from.value;
  if (track.kind == Track::Kind::slerp) return turned_between(from, *after, frame);
  std::vector<double> values;
  for (std::size_t c = 0; c < from.values.size(); ++c) values.push_back(between(track, key, frame, c));
  return from.value.is_array() ? json(values) : json(values[0]);
}

json rounded(json value) {
  if (value.is_number_float()) return std::round(value.get<double>());
  if (value.is_array())
    for (json& item : value) item = rounded(item);
  return value;
}

json turned(const Track& track, double frame, const json& now) {
  double s = (frame - track.first) / (track.last - track.first);
  s = track.cycle ? s - std::floor(s) : std::clamp(s, 0.0, 1.0);
  const glm::dmat3 turn(glm::rotate(glm::dmat4(1), glm::radians(track.degrees * s), track.axis));
  const glm::dvec3 start(now[0].get<double>(), now[1].get<double>(), now[2].get<double>());
  const glm::dvec3 end = track.center + turn * (start - track.center);
  return {end.x, end.y, end.z};
}

}  // namespace

std::vector<Track> read_tracks(const JsonValue& list) {
  std::vector<Track> tracks;
  for (const JsonValue& item : list.items("tracks")) tracks.push_back(read_track(item));
  return tracks;
}

json value_at(const Track& track, double frame, const json& now) {
  if (track.kind == Track::Kind::rotate) return turned(track, frame, now);
  const json value = keyed(track, frame);
  return track.whole ? rounded(value) : value;
}

}  // namespace sundog
