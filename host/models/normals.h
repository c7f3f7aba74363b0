// Completes a mesh's vertex normals: normalises given ones, generates missing ones and splits vertices at
// creases.
#pragma once
#include <cstdint>
#include <vector>

#include "models/values/mesh.h"

namespace sundog::models {

/// Normalises a mesh's normals and generates missing ones. `has_normal` tells which vertices have one (empty:
/// all if mesh.normals is filled, else none); too short ones count as missing. A generated normal is the mean
/// of the faces around the vertex, weighted by angle, over the faces connected across edges of at most
/// `crease_degrees`; several groups split the vertex. Edges connect `point_of_vertex` (empty: the vertices),
/// so vertices that differ only in texture coordinates are still smoothed. With `groups` (one per triangle),
/// edges between faces of the same nonzero group are smooth at any angle, and all others are sharp.
/// Degenerate faces are ignored. A mesh without normals and with crease 0 stays flat. Throws
/// std::length_error above 2^30 triangles.
void complete_normals(Mesh& mesh, std::vector<bool> has_normal, double crease_degrees,
                      const std::vector<std::uint32_t>& point_of_vertex = {},
                      const std::vector<std::uint32_t>& groups = {});

/// For each vertex, the first vertex at the same position.
std::vector<std::uint32_t> weld_positions(const Mesh& mesh);

}  // namespace sundog::models
