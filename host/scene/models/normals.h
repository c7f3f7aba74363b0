// Normals for meshes that have none, or too few.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/description.h"

namespace sundog::models {

/// Brings a mesh's normals into order. `has_normal` tells which vertices have one (empty: all when
/// mesh.normals is filled, else none); those are normalised, and count as missing when they are too short.
/// The missing ones become the mean of the faces around the vertex, weighted by their angles, over the faces
/// that hang together across edges of at most `crease_degrees`; a vertex is split where that gives several.
/// Edges run between `point_of_vertex` (empty: the vertices themselves), so vertices that differ in texture
/// coordinates alone still smooth. With `groups` (a number a triangle) edges between faces of one group other
/// than 0 are smooth whatever their angle, and all others are sharp. Faces without area have no say; every
/// normal comes out with unit length. A mesh that needs no normals (none given, crease 0) keeps none: flat.
/// Throws std::length_error above 2^30 triangles.
void complete_normals(Mesh& mesh, std::vector<bool> has_normal, double crease_degrees,
                      std::vector<std::uint32_t> point_of_vertex = {},
                      std::vector<std::uint32_t> groups = {});

/// For each vertex the first vertex at the same position.
std::vector<std::uint32_t> weld_positions(const Mesh& mesh);

}  // namespace sundog::models
