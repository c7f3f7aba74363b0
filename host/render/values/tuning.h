// Tuning parameters of a render: work-group, tile and launch sizes.
#pragma once
#include <string>

#include "render/values/work_group.h"

namespace sundog {

/// None of these changes a bit of the image. Zeros and `automatic` mean the defaults.
struct Tuning {
  WorkGroup work_group;
  WorkGroup surfaces_group;         // for the AOV kernel
  unsigned tile_w = 0, tile_h = 0;  // pixels per work-item
  unsigned packet_least = 0;        // packets with fewer rays are traced ray by ray
  double launch_ms = 0;             // target length of a launch: determines the rays in flight
  double tile_ms = 0;               // target length of a tile: determines the pixels between transfers
  std::string options{};            // build options of the integrator's program (BuildWish::tuned)
  friend bool operator==(const Tuning&, const Tuning&) = default;
};

}  // namespace sundog
