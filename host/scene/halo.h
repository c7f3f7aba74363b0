// Ice crystals in a sky, and the map of the light that they send. Plain values.
#pragma once
#include <vector>

#include "shared/halo.h"

namespace sundog {

/// One kind of hexagonal prisms.
struct HaloCrystals {
  u32 shape = HALO_PLATE;  // a HALO_* constant
  double ratio = 1;        // length along the axis over the width from corner to corner
  double tilt = 1;         // degrees: standard deviation of the axis from its way to lie
  double roll = 1;         // parry; degrees: of the level faces
  double share = 1;        // of the cloud, over the sum of all kinds' shares
};

struct HaloDescription {
  std::vector<HaloCrystals> crystals;
  double optical_depth = 0.05;  // of the cloud, upwards, for light that it turns
  double index = 0;             // of refraction for all colours; 0: that of ice
  int rays = 10'000'000;        // that meet crystals
  int size = 1024;              // cells a side of the map
};

/// Where light goes that crystals turn: the sphere as kernels/lib/halo/sky_map.cl lays it on a square.
struct HaloMap {
  int side = 0;
  std::vector<float> cells;  // 3 each, row by row: red, green, blue a steradian; 1 in all over the sphere
  double passed = 0, turned = 0, kept = 0;  // parts of the light that met crystals: passed straight through,
                                            // turned, and given up inside
};

}  // namespace sundog
