// The camera and the picture, as a scene file or a model has them.
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
  int blades = 0;                 // of the aperture, 3..16; 0: round
  double rotate = 0;              // rotation of the blades, degrees
  std::string focus_on{};         // the object whose middle has set `focus`; empty: none
  dvec3 focus_point{0};           // that middle
};

/// A pinhole camera unless its lens has a radius. `fov` is the vertical angle of view in degrees, (0, 180).
/// near/far clip by depth along the view.
struct Camera {
  dvec3 position{0, 0, 5}, target{0, 0, 0}, up{0, 1, 0};
  double fov = 45;
  double near = 0, far = std::numeric_limits<double>::infinity();
  Lens lens{};
  std::optional<View> moves_to{};  // position and target when the shutter closes; linear in between
  double shutter = 0;              // of a film: the part of a frame for which it is open
  double orthographic = 0;         // the picture's height in world units, by parallel rays; 0: perspective
};

struct ImageSettings {
  int width = 640, height = 480;
  dvec3 background_bottom{0, 0, 0}, background_top{0, 0, 0};  // equal: one colour
  bool transparent = false;        // what is behind the scene is left out of the colours
  bool transparent_glass = false;  // alpha counts what is behind smooth glass as behind the scene
  ToneMap tone_map;                // for files of 8 bits a channel; no part of the compiled scene
};

}  // namespace sundog
