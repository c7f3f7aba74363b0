// Tracks: values of a scene over the frames of an animation.
#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/json/value.h"

namespace sundog {

/// A Bezier handle, at which a curve leaves or reaches a key: its frame and numbers.
struct TrackHandle {
  double frame = 0;
  std::vector<double> values;
};

struct TrackKey {
  double frame = 0;
  nlohmann::json value;
  std::vector<double> values;  // a number or an array's numbers; otherwise empty
  std::optional<TrackHandle> left, right;
};

/// One value of the document over time. All kinds but rotate interpolate between keys, and hold the first and
/// last value outside them; values other than numbers step. smooth is a cubic Hermite spline with Catmull-Rom
/// slopes, which are 0 at the ends and limited so that values between two keys lie between the keys' values
/// (Fritsch and Carlson 1980). bezier has handles; missing handles lie on that spline. slerp interpolates
/// quaternions x, y, z, w the short way (Shoemake 1985). rotate turns a point or direction about an axis, by
/// `degrees` from frame `first` to frame `last`.
struct Track {
  enum class Kind { step, linear, smooth, bezier, slerp, rotate } kind = Kind::linear;
  std::string pointer;         // to the animated value
  std::vector<TrackKey> keys;  // at least one; frames rise; values of one kind and length
  bool whole = false;          // round to whole numbers
  bool cycle = false;          // starts again after the last key or the turn
  glm::dvec3 axis{0, 1, 0}, center{0};
  double degrees = 360, first = 0, last = 1;
};

/// Reads the list under "animate". Throws SceneError.
std::vector<Track> read_tracks(const JsonValue& list);

/// The track's value at a frame; `now` is the value in the document (from whose 3 numbers a rotation starts).
nlohmann::json value_at(const Track& track, double frame, const nlohmann::json& now);

}  // namespace sundog
