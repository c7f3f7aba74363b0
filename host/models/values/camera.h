// The camera and the picture, as a scene file or a model describes them.
#pragma once
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>

#include "base/tone_map.h"

namespace sundog {

using glm::dvec3;

/// Position and target of a camera.
struct View {
  dvec3 position{0, 0, 5}, target{0, 0, 0};
};

/// A thin lens; only points at depth `focus` along the view are sharp.
struct Lens {
  double radius = 0;              // 0: a pinhole
  std::optional<double> focus{};  // none: the target's distance
  int blades = 0;                 // blades of the aperture; 0: round
  double rotate = 0;              // rotation of the blades, degrees
  std::string focus_on{};         // the object whose centre has set `focus`; empty: none
  dvec3 focus_point{0};           // that object's centre
};

/// A pinhole camera unless its lens has a radius. `fov` is the vertical angle of view in degrees, (0, 180).
/// near/far clip by depth along the view.
struct Camera {
  dvec3 position{0, 0, 5}, target{0, 0, 0}, up{0, 1, 0};
  double fov = 45;
  double near = 0, far = std::numeric_limits<double>::infinity();
  Lens lens{};
  std::optional<View> moves_to{};  // position and target when the shutter closes; linear in between
  double shutter = 0;              // for animations: fraction of a frame for which it is open
  double orthographic = 0;         // the picture's height in world units, by parallel rays; 0: perspective
};

struct ImageSettings {
  int width = 640, height = 480;
  dvec3 background_bottom{0, 0, 0}, background_top{0, 0, 0};  // equal: one colour
  bool transparent = false;                                   // the background is left out of the colours
  bool transparent_glass = false;  // alpha counts the background behind smooth glass as visible
  ToneMap tone_map;                // for 8-bit files; not part of the compiled scene
};

}  // namespace sundog
