// Ice crystals in a sky, and the map of the light that they scatter: plain values.
#pragma once
#include <vector>

#include "shared/halo.h"

namespace sundog {

/// One kind of hexagonal prism.
struct HaloCrystals {
  u32 shape = HALO_PLATE;  // a HALO_* constant
  double ratio = 1;        // length along the axis over width between corners
  double tilt = 1;         // degrees: standard deviation of the axis from its preferred orientation
  double roll = 1;         // parry; degrees: standard deviation of the level faces
  double share = 1;        // weight among the cloud's kinds
};

struct HaloDescription {
  std::vector<HaloCrystals> crystals;
  double optical_depth = 0.05;  // the cloud's, vertically, for scattered light
  double ior = 0;               // index of refraction for all colours; 0: that of ice
  int rays = 10'000'000;        // rays that hit crystals
  int cells = 1024;             // per side of the map
};

/// Light scattered by crystals, by direction: the sphere mapped to a square as in
/// kernels/plain/halo/sky_map.cl.
struct HaloMap {
  int side = 0;
  std::vector<float> cells;  // 3 each, row by row: red, green, blue per steradian; their integral is 1
  double passed = 0, turned = 0,
         kept = 0;  // fractions of the light at crystals: unscattered, scattered, lost
};

}  // namespace sundog
