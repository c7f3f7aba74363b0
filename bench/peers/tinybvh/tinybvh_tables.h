// A mesh in the layouts that tinybvh's OpenCL kernels read, as plain tables, so that only one file includes
// tinybvh's header.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "shared/types.h"

namespace sundog {

struct TinyBvhTables {
  std::string version;                    // of tinybvh's header: "1.6.8"
  std::vector<float4> nodes, triangles;   // eight wide, compressed: traverse_cwbvh.cl
  bool compressed_triangles = false;      // CWBVH_COMPRESSED_TRIS
  std::vector<float4> nodes2, vertices2;  // two wide: traverse_bvh2.cl, with the triangles' order
  std::vector<u32> order2;
  double build_seconds = 0;  // of both trees
};

/// `corners`: three for each triangle.
TinyBvhTables tinybvh_tables(std::span<const float4> corners);

}  // namespace sundog
