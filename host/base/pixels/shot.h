// Shot: a picture's camera and its place in a film, as OpenEXR's standard attributes store them.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <vector>

namespace sundog {

/// A triangle's corners in world space, now and in the next frame.
struct MovingFace {
  std::array<glm::vec3, 3> now, next;
};

/// The camera of the next frame, and the motion until then by object index: `moves` transforms an object's
/// points; `faces` are the triangles of meshes that change their shape.
struct NextShot {
  glm::dmat4 world_to_ndc{1};
  std::map<int, glm::dmat4> moves;
  std::map<int, std::vector<MovingFace>> faces;
};

struct Shot {
  /// Matrix for column vectors. Camera space is left-handed: x to the right, y up, z along the view.
  glm::dmat4 world_to_camera{1};
  /// After division by w: (0, 0) is the picture's upper left corner, (1, 1) its lower right.
  glm::dmat4 world_to_ndc{1};
  double window_width = 1;      // the picture's width at depth 1
  std::optional<double> focus;  // focus distance in metres; none: everything is sharp
  std::optional<int> frame;     // in a film; none: the next two members do not apply
  double frames_per_second = 24;
  double exposure_seconds = 0;   // how long the shutter is open; 0: no motion blur
  std::optional<NextShot> next;  // for the AOV motion
};

}  // namespace sundog
