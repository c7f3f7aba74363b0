// What a render can be tuned by.
#pragma once
#include "render/values/work_group.h"

namespace sundog {

/// What a render can be tuned by; none of it changes a bit of the image. Zeros and `automatic` are the
/// defaults.
struct Tuning {
  WorkGroup work_group;
  WorkGroup surfaces_group;         // of the kernel that makes the AOVs
  unsigned tile_w = 0, tile_h = 0;  // pixels a work-item
  unsigned packet_least = 0;        // rays below which a packet is traced ray by ray
  double launch_ms = 0;             // the length of a launch: how many rays are in flight
  double tile_ms = 0;               // the length of a tile: how many pixels are made between two transfers
  friend bool operator==(const Tuning&, const Tuning&) = default;
};

}  // namespace sundog
