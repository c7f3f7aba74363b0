// Animation: keys of a scene document ("animate") that set values per frame.
#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/json/value.h"

namespace sundog {

/// One animated value. linear and smooth interpolate the keys and hold the first and last value outside them;
/// smooth is C1 (cubic Hermite, Catmull-Rom tangents). rotate turns a point or direction about an axis, by
/// `degrees` from frame `first` to frame `last`.
struct Track {
  enum class Kind { linear, smooth, rotate } kind = Kind::linear;
  std::string pointer;  // of the animated value
  struct Key {
    double frame = 0;
    std::vector<double> values;
  };
  std::vector<Key> keys;  // at least one, rising frames, equal lengths
  bool whole = false;     // round to integers
  glm::dvec3 axis{0, 1, 0}, center{0};
  double degrees = 360, first = 0, last = 1;
};

/// Reads the "animate" list. Throws SceneError.
std::vector<Track> read_tracks(const JsonValue& list);

/// Returns the value at a frame; `now` is the document's value, from which a rotation starts.
std::vector<double> value_at(const Track& track, double frame, const std::vector<double>& now);

/// Sets every animated value of the document for `frame`. Throws SceneError without "animate", or if a
/// pointer does not lead to a number or an array of numbers.
void apply_animation(nlohmann::json& document, double frame, const JsonContext& context);

}  // namespace sundog
