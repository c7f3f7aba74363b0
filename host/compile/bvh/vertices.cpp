// Gives each triangle its own vertices if the mesh has no normals; replaces a normal without direction by the
// sum of its faces' normals.
#include "compile/bvh/vertices.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"

namespace sundog {
namespace {

bool usable(const glm::dvec3& normal) {
  const double length = glm::length(normal);
  return std::isfinite(length) && length > 0;
}

void set_normal(Vertex& vertex, const glm::dvec3& normal) {
  const glm::dvec3 unit = usable(normal) ? normal / glm::length(normal) : glm::dvec3(0, 1, 0);
  vertex.nx = static_cast<float>(unit.x);
  vertex.ny = static_cast<float>(unit.y);
  vertex.nz = static_cast<float>(unit.z);
}

Vertex make_vertex(const Mesh& mesh, std::size_t index) {
  Vertex vertex{};
  if (!mesh.uvs.empty()) {
    vertex.u = mesh.uvs[index].x;
    vertex.v = mesh.uvs[index].y;
  }
  const glm::vec3 color = mesh.colors.empty() ? glm::vec3(1) : mesh.colors[index];
  vertex.r = color.r;
  vertex.g = color.g;
  vertex.b = color.b;
  if (!mesh.normals.empty()) set_normal(vertex, glm::dvec3(mesh.normals[index]));
  return vertex;
}

/// Replaces the mesh's normals that have no direction.
void mend_normals(const Mesh& mesh, std::span<Vertex> vertices) {
  std::atomic<bool> broken{false};
  in_parallel(mesh.normals.size(), [&](std::size_t i) {
    if (!usable(glm::dvec3(mesh.normals[i]))) broken = true;
  });
  if (!broken) return;
  std::vector<glm::dvec3> sums(vertices.size(), glm::dvec3(0));
  for (const glm::uvec3& triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner) sums[triangle[corner]] += face_normal(mesh, triangle);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (!usable(glm::dvec3(mesh.normals[i]))) set_normal(vertices[i], sums[i]);
}

u32 triangle_material(const Mesh& mesh, std::size_t triangle, u32 default_material) {
  if (mesh.materials.empty() || mesh.materials[triangle] < 0) return default_material;
  return static_cast<u32>(mesh.materials[triangle]);
}

float triangle_extent(const Mesh& mesh, const glm::uvec3& triangle) {
  const glm::vec3 &a = mesh.positions[triangle.x], &b = mesh.positions[triangle.y],
                  &c = mesh.positions[triangle.z];
  const glm::vec3 size = glm::max(glm::max(a, b), c) - glm::min(glm::min(a, b), c);
  return std::max({size.x, size.y, size.z});
}

void fill_facets(const Mesh& mesh, u32 first_vertex, u32 default_material, std::span<Vertex> vertices,
                 std::span<TriangleShading> triangles) {
  in_parallel(mesh.triangles.size(), [&](std::size_t t) {
    const glm::dvec3 normal = face_normal(mesh, mesh.triangles[t]);
    TriangleShading& triangle = triangles[t];
    triangle.material = triangle_material(mesh, t, default_material);
    triangle.extent = triangle_extent(mesh, mesh.triangles[t]);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Vertex& vertex = vertices[3 * t + corner];
      vertex = make_vertex(mesh, mesh.triangles[t][static_cast<int>(corner)]);
      set_normal(vertex, normal);
      triangle.vertex[corner] = first_vertex + static_cast<u32>(3 * t + corner);
    }
  });
}

}  // namespace

std::size_t vertex_count(const Mesh& mesh) {
  return mesh.normals.empty() ? 3 * mesh.triangles.size() : mesh.positions.size();
}

void fill_vertices(const Mesh& mesh, u32 first_vertex, u32 default_material, std::span<Vertex> vertices,
                   std::span<TriangleShading> triangles) {
  if (mesh.normals.empty()) {
    fill_facets(mesh, first_vertex, default_material, vertices, triangles);
    return;
  }
  in_parallel(vertices.size(), [&](std::size_t i) { vertices[i] = make_vertex(mesh, i); });
  mend_normals(mesh, vertices);
  in_parallel(triangles.size(), [&](std::size_t t) {
    const glm::uvec3& corners = mesh.triangles[t];
    triangles[t] = {{first_vertex + corners.x, first_vertex + corners.y, first_vertex + corners.z},
                    triangle_material(mesh, t, default_material),
                    triangle_extent(mesh, corners),
                    0};
  });
}

}  // namespace sundog
