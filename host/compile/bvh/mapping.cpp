// Compiles texture coordinates, alphas and tangents for textures.
#include <algorithm>

#include "compile/bvh/mesh_groups.h"
#include "compile/bvh/tangents.h"
#include "compile/steps.h"

namespace sundog {
namespace {

/// Calls put(table vertex, mesh vertex) for each vertex that vertices.cpp creates.
void each_vertex(const Mesh& mesh, std::size_t first_vertex, const auto& put) {
  if (!mesh.normals.empty())
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) put(first_vertex + vertex, vertex);
  else  // three per triangle
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int corner = 0; corner < 3; ++corner)
        put(first_vertex + 3 * t + static_cast<std::size_t>(corner), mesh.triangles[t][corner]);
}

/// Calls visit(mesh, its place in the tables) for each placed mesh.
void for_each_mesh(const MappingInputs& in, const auto& visit) {
  for (std::size_t i = 0; i < in.sources->size(); ++i)
    if (const Mesh* mesh = (*in.sources)[i]) visit(*mesh, in.meshes->placed[i]);
}

/// The texture coordinate sets after the first that textures use.
SharedTable<float> further_uvs(const MappingInputs& in) {
  const std::size_t sets = in.extra_uvs;
  if (sets == 0) return {};
  std::vector<float> table(in.meshes->vertices.size() * sets * 2);
  for_each_mesh(in, [&](const Mesh& mesh, const PlacedMesh& placed) {
    for (std::size_t set = 0; set < std::min(sets, mesh.further_uvs.size()); ++set) {
      const MeshArray<glm::vec2>& uvs = mesh.further_uvs[set];
      if (uvs.empty()) continue;
      each_vertex(mesh, placed.first_vertex, [&](std::size_t vertex, std::size_t from) {
        float* to = &table[2 * (vertex * sets + set)];
        to[0] = uvs[from].x;
        to[1] = uvs[from].y;
      });
    }
  });
  return table;
}

/// The alpha of all vertices, if a texture uses it.
SharedTable<float> vertex_alphas(const MappingInputs& in) {
  if (!in.vertex_colors) return {};
  std::vector<float> table(in.meshes->vertices.size(), 1.0f);
  for_each_mesh(in, [&](const Mesh& mesh, const PlacedMesh& placed) {
    if (mesh.alphas.empty()) return;
    each_vertex(mesh, placed.first_vertex,
                [&](std::size_t vertex, std::size_t from) { table[vertex] = mesh.alphas[from]; });
  });
  return table;
}

}  // namespace

MappingInputs mapping_inputs(const SceneDescription& scene, const Known<Meshes>& meshes,
                             const Surfaces& surfaces) {
  return {.meshes = meshes,
          .sources = {placed_meshes(scene)},
          .extra_uvs = surfaces.features.extra_uvs,
          .relief = surfaces.features.relief,
          .vertex_colors = (surfaces.features.texture_kinds >> TEXTURE_VERTEX_COLOR & 1u) != 0};
}

MeshMapping compile_mapping(const MappingInputs& in) {
  return {further_uvs(in), vertex_alphas(in), tangents_of(in)};
}

}  // namespace sundog
