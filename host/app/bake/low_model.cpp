// Rasterises the triangles into the texture's square, which repeats: each texel stores its triangle and the
// position in it.
#include "app/bake/low_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/render/output_files.h"
#include "base/error.h"
#include "compile/bvh/tangents.h"
#include "models/model.h"
#include "scene/json/parse.h"

namespace sundog {
namespace {

dvec3 unit(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : v;
}

/// Removes all that does not affect geometry.
void forget_materials(SceneDescription& scene) {
  scene.materials.clear();
  scene.images.clear();
  scene.textures.clear();
  scene.lights.clear();
  scene.environment = {};
  for (Mesh& mesh : scene.meshes) mesh.materials.clear();
  for (Object& object : scene.objects) object.material = -1;
}

void add_triangles(const Object& object, const Mesh& mesh, std::vector<LowTriangle>& out) {
  const dmat4& world = object.world_from_object;
  const glm::dmat3 linear(world), normals = glm::transpose(glm::inverse(linear));
  const double turned = glm::determinant(linear) < 0 ? -1 : 1;
  const std::vector<CornerTangent> tangents = corner_tangents(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3 triangle = mesh.triangles[t];
    const dvec3 face = face_normal(mesh, triangle);
    LowTriangle low;
    for (int i = 0; i < 3; ++i) {
      const u32 vertex = triangle[i];
      LowCorner& corner = low.corner[i];
      corner.position = dvec3(world * glm::dvec4(dvec3(mesh.positions[vertex]), 1));
      corner.normal = unit(normals * (mesh.normals.empty() ? face : dvec3(mesh.normals[vertex])));
      corner.tangent = unit(linear * tangents[3 * t + static_cast<std::size_t>(i)].tangent);
      corner.uv = glm::dvec2(mesh.uvs[vertex]);
    }
    low.sign = tangents[3 * t].mirrored ? -turned : turned;
    out.push_back(low);
  }
}

double cross2(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Assigns the texels whose centres lie in a triangle.
void cover_triangle(const LowTriangle& triangle, u32 index, Coverage& out) {
  glm::dvec2 at[3];
  const glm::dvec2 lowest =
      glm::min(triangle.corner[0].uv, glm::min(triangle.corner[1].uv, triangle.corner[2].uv));
  const glm::dvec2 highest =
      glm::max(triangle.corner[0].uv, glm::max(triangle.corner[1].uv, triangle.corner[2].uv));
  if (!(lowest.x > -1e6 && lowest.y > -1e6 && highest.x < 1e6 && highest.y < 1e6)) return;
  if (lowest.x < -1e-6 || lowest.y < -1e-6 || highest.x > 1 + 1e-6 || highest.y > 1 + 1e-6) ++out.outside;
  const double size = out.size;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec2 uv = triangle.corner[i].uv;
    at[i] = {uv.x * size - 0.5, (1 - uv.y) * size - 0.5};
  }
  const double area = cross2(at[1] - at[0], at[2] - at[0]);
  if (area == 0) return;
  const auto low = glm::ceil(glm::min(at[0], glm::min(at[1], at[2])) - 1e-9),
             high = glm::floor(glm::max(at[0], glm::max(at[1], at[2])) + 1e-9);
  const double most = 4 * size;  // four repetitions of the map are enough
  for (double y = low.y; y <= std::min(high.y, low.y + most); ++y)
    for (double x = low.x; x <= std::min(high.x, low.x + most); ++x) {
      const glm::dvec2 p = glm::dvec2(x, y) - at[0];
      const double b = cross2(p, at[2] - at[0]) / area, c = cross2(at[1] - at[0], p) / area;
      if (b < -1e-9 || c < -1e-9 || b + c > 1 + 1e-9) continue;
      const auto wrapped = [&](double i) {
        return static_cast<std::size_t>(i - std::floor(i / size) * size);
      };
      Texel& texel = out.texels[wrapped(y) * static_cast<std::size_t>(out.size) + wrapped(x)];
      // Centres on a common edge lie in both triangles, so they do not count as shared.
      const bool inside = b > 1e-6 && c > 1e-6 && b + c < 1 - 1e-6;
      if (texel.triangle != Texel::nowhere) {
        out.shared += inside;
        continue;
      }
      texel = {index, static_cast<float>(b), static_cast<float>(c)};
      ++out.covered;
    }
}

}  // namespace

SceneDescription load_geometry(const std::string& file, bool outside_files) {
  SceneDescription scene;
  if (is_model_file(file)) {
    require_readable(file, file, "");
    Model model = load_model(file, {.outside_files = outside_files});
    scene.file = file;
    scene.media.push_back({.name = "vacuum", .priority = world_priority});
    scene.meshes = std::move(model.meshes);
    scene.objects = std::move(model.objects);
  } else {
    scene = load_for_command(file, {}, {.outside_files = outside_files});
  }
  for (const Object& object : scene.objects)
    if (std::holds_alternative<FieldShape>(object.shape))
      throw SceneError(file, object.place, "a distance field cannot be baked: wanted meshes and solids");
  forget_materials(scene);
  return scene;
}

std::vector<LowTriangle> low_triangles(const SceneDescription& scene) {
  std::vector<LowTriangle> triangles;
  for (const Object& object : scene.objects) {
    const auto* shape = std::get_if<MeshShape>(&object.shape);
    if (!shape) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(shape->mesh)];
    if (mesh.uvs.empty())
      throw SceneError(scene.file.string(), object.place,
                       fmt::format("the mesh \"{}\" has no texture coordinates: unwrap it before a map is "
                                   "baked for it",
                                   mesh.name));
    add_triangles(object, mesh, triangles);
  }
  if (triangles.empty())
    throw SceneError(scene.file.string(), "",
                     "has no mesh: maps are baked for meshes with texture coordinates");
  return triangles;
}

Coverage cover(const std::vector<LowTriangle>& triangles, int size) {
  Coverage out;
  out.size = size;
  out.texels.resize(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < triangles.size(); ++i) cover_triangle(triangles[i], static_cast<u32>(i), out);
  return out;
}

LowPoint point_of(const LowTriangle& triangle, const Texel& texel) {
  const double b = double(texel.b), c = double(texel.c), a = 1 - b - c;
  const LowCorner &p = triangle.corner[0], &q = triangle.corner[1], &r = triangle.corner[2];
  LowPoint point;
  point.position = a * p.position + b * q.position + c * r.position;
  point.normal = unit(a * p.normal + b * q.normal + c * r.normal);
  point.tangent = unit(a * p.tangent + b * q.tangent + c * r.tangent);
  point.bitangent = triangle.sign * glm::cross(point.normal, point.tangent);
  return point;
}

}  // namespace sundog
