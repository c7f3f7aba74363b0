// Tracks: values of a scene over the frames of an animation.
#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/json/value.h"

namespace sundog {

/// A frame and numbers at it: where a curve leaves a key to, or comes from.
struct TrackHandle {
  double frame = 0;
  std::vector<double> values;
};

struct TrackKey {
  double frame = 0;
  nlohmann::json value;
  std::vector<double> values;  // of a number or an array of numbers; of anything else none
  std::optional<TrackHandle> left, right;
};

/// One value of the document over time. All but rotate go through keys, and hold the first and the last value
/// outside of them; values that are no numbers step. smooth is a cubic Hermite spline: Catmull-Rom's slopes,
/// limited so that the values between two keys lie between theirs (Fritsch and Carlson 1980), 0 at the ends.
/// bezier has handles, which without any of their own lie on that spline. slerp takes quaternions x, y, z, w
/// the short way (Shoemake 1985). rotate turns a point or direction about an axis, by `degrees` from frame
/// `first` to frame `last`.
struct Track {
  enum class Kind { step, linear, smooth, bezier, slerp, rotate } kind = Kind::linear;
  std::string pointer;         // of the value that is animated
  std::vector<TrackKey> keys;  // at least one, frames rising, of values of one kind and length
  bool whole = false;          // round to whole numbers
  bool cycle = false;          // after the last key, or the turn, it begins again
  glm::dvec3 axis{0, 1, 0}, center{0};
  double degrees = 360, first = 0, last = 1;
};

/// Reads the list under "animate". Throws SceneError.
std::vector<Track> read_tracks(const JsonValue& list);

/// The track's value at a frame; `now` is what stands in the document (a rotation starts from its 3 numbers).
nlohmann::json value_at(const Track& track, double frame, const nlohmann::json& now);

}  // namespace sundog
