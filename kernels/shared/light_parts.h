// The parts into which AOVs divide the light of a pixel, in the order in which their sum is its colour. The
// kernels add each part's samples to 3 floats, which lie one after the other in LIGHT_VECTORS float4.
//   PART(name)
// The AOVs of light groups use the same sums: the first is of lights in no group.
#pragma once

#define LIGHT_PARTS(PART)     \
  PART(diffuse_direct)        \
  PART(diffuse_indirect)      \
  PART(glossy_direct)         \
  PART(glossy_indirect)       \
  PART(transmission_direct)   \
  PART(transmission_indirect) \
  PART(volume_direct)         \
  PART(volume_indirect)       \
  PART(emission)              \
  PART(sky)
#define LIGHT_PART_COUNT 10u
#define NO_LIGHT_GROUP 0
#define LIGHT_VECTORS 8u  // hold 3 * LIGHT_PART_COUNT floats
