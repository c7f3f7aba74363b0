// A mesh's shading tables: unit normals, texture coordinates, colours; indices and material of each triangle.
#pragma once
#include <span>

#include "compile/compiled_scene.h"

namespace sundog {

/// Vertices that the mesh takes in the table: its own, or three a triangle when it has no normals (facets).
std::size_t vertex_count(const Mesh& mesh);

/// Fills vertex_count(mesh) vertices and the mesh's triangles; `first_vertex` is added to their indices.
/// A missing or unusable normal is replaced by the mean of the faces around it.
void fill_vertices(const Mesh& mesh, u32 first_vertex, u32 default_material, std::span<Vertex> vertices,
                   std::span<TriangleShading> triangles);

}  // namespace sundog
