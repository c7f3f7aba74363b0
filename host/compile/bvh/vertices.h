// Compiles a mesh's shading tables: unit normals, texture coordinates, colours, triangles' indices and so on.
#pragma once
#include <span>

#include "compile/compiled_scene.h"

namespace sundog {

/// The mesh's vertices in the table: its own, or three per triangle if it has no normals (facets).
std::size_t vertex_count(const Mesh& mesh);

/// Fills vertex_count(mesh) vertices and the mesh's triangles; `first_vertex` is added to their indices.
/// Replaces a missing or unusable normal by the mean of the adjacent faces.
void fill_vertices(const Mesh& mesh, u32 first_vertex, u32 default_material, std::span<Vertex> vertices,
                   std::span<TriangleShading> triangles);

}  // namespace sundog
