// Whether a mesh is the surface of a solid: closed, and facing outwards.
#pragma once
#include <cstddef>

#include "scene/description.h"

namespace sundog {

/// Corners at one position count as one; triangles without area are left aside.
struct MeshFaults {
  std::size_t open_edges = 0;    // of an odd number of triangles: the mesh is not closed there
  std::size_t turned_edges = 0;  // whose triangles face different ways
  std::size_t parts = 0;         // that hang together; counted, as the next one, where no edge is at fault
  std::size_t inside_out = 0;    // parts that face inwards and are no hollow of another (by their boxes)
};

MeshFaults find_faults(const Mesh& mesh);

}  // namespace sundog
