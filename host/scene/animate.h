// Animation: values of a scene document keyed over frames ("animate").
#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/json/value.h"

namespace sundog {

/// One value of the document over time. linear and smooth go through the keys and hold the first and the last
/// outside of them; smooth has no kink at a key (cubic Hermite, Catmull-Rom tangents). rotate turns a point
/// or direction about an axis, by `degrees` from frame `first` to frame `last`.
struct Track {
  enum class Kind { linear, smooth, rotate } kind = Kind::linear;
  std::string pointer;  // of the value that is animated
  struct Key {
    double frame = 0;
    std::vector<double> values;
  };
  std::vector<Key> keys;  // at least one, frames rising, all as long as each other
  bool whole = false;     // round to whole numbers
  glm::dvec3 axis{0, 1, 0}, center{0};
  double degrees = 360, first = 0, last = 1;
};

/// Reads the list under "animate". Throws SceneError.
std::vector<Track> read_tracks(const JsonValue& list);

/// The track's value at a frame; `now` is what stands in the document (a rotation starts from it).
std::vector<double> value_at(const Track& track, double frame, const std::vector<double>& now);

/// Sets every animated value of the document to that of `frame`. Throws SceneError: for a document without
/// "animate", and where a pointer leads to nothing that is a number or an array of numbers.
void apply_animation(nlohmann::json& document, double frame, const JsonContext& context);

/// The place in the document of the track that moves the value at `place`, or a part of it; empty: none does.
std::string track_of(const nlohmann::json& document, const std::string& place);

}  // namespace sundog
