// Shot: the camera of a picture and its place in a film, as OpenEXR's standard attributes hold them.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <vector>

namespace sundog {

/// A triangle's corners in the world, now and in the next frame.
struct MovingFace {
  std::array<glm::vec3, 3> now, next;
};

/// The camera of the next frame, and what moves until then, by the objects' indices: the transforms of
/// objects' points, and the faces of meshes that change their shape.
struct NextShot {
  glm::dmat4 world_to_ndc{1};
  std::map<int, glm::dmat4> moves;
  std::map<int, std::vector<MovingFace>> faces;
};

struct Shot {
  /// For column vectors. Camera space is left-handed: x to the right, y up, z along the view.
  glm::dmat4 world_to_camera{1};
  /// To (0, 0) in the picture's upper left corner and (1, 1) in its lower right, after the division by w.
  glm::dmat4 world_to_ndc{1};
  double window_width = 1;      // of the picture at depth 1
  std::optional<double> focus;  // in metres; none: everything is sharp
  std::optional<int> frame;     // of a film; with it:
  double frames_per_second = 24;
  double exposure_seconds = 0;   // while the shutter is open; 0: not at all
  std::optional<NextShot> next;  // for the AOV motion
};

}  // namespace sundog
