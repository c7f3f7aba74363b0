// Checks whether a mesh bounds a solid: closed and facing outwards.
#pragma once
#include <cstddef>

#include "scene/description.h"

namespace sundog {

/// Coincident corners count as one; triangles without area are ignored.
struct MeshFaults {
  std::size_t open_edges = 0;    // edges of an odd number of triangles: the mesh is not closed
  std::size_t turned_edges = 0;  // edges between triangles of opposite orientation
  std::size_t parts = 0;         // connected components; counted, like inside_out, only without edge faults
  std::size_t inside_out = 0;    // inward-facing parts that are no hollow of another (by bounding box)
};

MeshFaults find_faults(const Mesh& mesh);

}  // namespace sundog
