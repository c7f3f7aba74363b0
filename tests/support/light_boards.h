// A scene with light of every part (kernels/shared/light_parts.h).
#pragma once
#include <string>
#include <vector>

#include "shared/light_parts.h"

#define NAME_OF_PART(name) #name,
inline const std::vector<std::string> light_part_names = {LIGHT_PARTS(NAME_OF_PART)};
#undef NAME_OF_PART

/// Six boards in a row in front of a bright background, a ball of smoke above them and a frosted pane below.
inline constexpr const char* light_boards = R"({
  "camera": {"position": [0, 0, 6], "target": [0, 0, 0], "fov": 40},
  "image": {"width": 32, "height": 24, "background": [0.2, 0.4, 0.8]},
  "render": {"integrator": "path", "samples": 16, "max_depth": 6},
  "lights": [{"type": "directional", "direction": [0.3, -0.6, -1], "intensity": 2}],
  "media": {"smoke": {"ior": 1, "absorption": [0.2, 0.2, 0.2], "scattering": [1, 1, 1]}},
  "materials": {
    "matte": {"color": [0.5, 0.3, 0.1]},
    "mirror": {"color": [0, 0, 0], "reflection": 0.9},
    "lamp": {"color": [0, 0, 0], "emission": [3, 2, 1]},
    "plastic": {"type": "openpbr", "base_color": [0.8, 0.1, 0.1], "specular_roughness": 0.5},
    "pane": {"color": [0.5, 0.3, 0.1], "opacity": 0.5},
    "glass": {"type": "dielectric", "ior": 1.5},
    "frosted": {"type": "dielectric", "ior": 1.5, "thin_walled": true, "roughness": 0.5},
    "smoke": {"type": "dielectric", "medium": "smoke"}
  },
  "objects": [
    {"type": "rectangle", "size": [0.6, 0.6], "center": [-2, 0, 0], "normal": [0, 0, 1], "material": "matte"},
    {"type": "rectangle", "size": [0.6, 0.6], "center": [-1.2, 0, 0], "normal": [0, 0, 1], "material": "mirror"},
    {"type": "rectangle", "size": [0.6, 0.6], "center": [-0.4, 0, 0], "normal": [0, 0, 1], "material": "lamp"},
    {"type": "rectangle", "size": [0.6, 0.6], "center": [0.4, 0, 0], "normal": [0, 0, 1], "material": "plastic"},
    {"type": "rectangle", "size": [0.6, 0.6], "center": [1.2, 0, 0], "normal": [0, 0, 1], "material": "pane"},
    {"type": "box", "min": [1.7, -0.3, -0.2], "max": [2.3, 0.3, 0], "material": "glass"},
    {"type": "rectangle", "size": [0.6, 0.6], "center": [0, -1, 0], "normal": [0, 0, 1], "material": "frosted"},
    {"type": "sphere", "radius": 0.4, "center": [0, 1.3, 0], "material": "smoke"}
  ]
})";
