// Halves edges until none is too long, then moves each point along its mean normal by its mean height.
#include "scene/displace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "base/error.h"
#include "models/normals.h"
#include "scene/heights.h"
#include "scene/json/value.h"

namespace sundog {
namespace {

/// Edges with a larger angle stay sharp.
constexpr double crease_degrees = 75;

double length2(const Mesh& mesh, u32 a, u32 b) {
  const dvec3 way = dvec3(mesh.positions[b]) - dvec3(mesh.positions[a]);
  return glm::dot(way, way);
}

/// Vertices at the midpoints of edges, each created once.
class Middles {
 public:
  explicit Middles(Mesh& mesh) : mesh_(mesh) {}

  u32 between(u32 a, u32 b) {
    const auto [found, added] = made_.try_emplace(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b),
                                                  static_cast<u32>(mesh_.positions.size()));
    if (added) add(std::min(a, b), std::max(a, b));
    return found->second;
  }

 private:
  template <class Value>
  static void add_mean(MeshArray<Value>& values, u32 a, u32 b) {
    if (!values.empty()) values.push_back(0.5f * (values[a] + values[b]));
  }
  void add(u32 a, u32 b) {
    add_mean(mesh_.positions, a, b);
    add_mean(mesh_.normals, a, b);
    add_mean(mesh_.uvs, a, b);
    add_mean(mesh_.colors, a, b);
    add_mean(mesh_.alphas, a, b);
    for (auto& uvs : mesh_.further_uvs) add_mean(uvs, a, b);
  }

  Mesh& mesh_;
  std::unordered_map<std::uint64_t, u32> made_;
};

/// Splits a triangle at the edges, from corner i to i + 1, for which `cut` is true.
void split(const Mesh& mesh, const glm::uvec3& triangle, const bool (&cut)[3], Middles& middles,
           std::vector<glm::uvec3>& out) {
  const int count = cut[0] + cut[1] + cut[2];
  if (count == 0) return out.push_back(triangle);
  // Rotate so that the single cut edge comes first, or the corner between two cut edges is the middle one.
  int first = cut[0] ? 0 : cut[1] ? 1 : 2;
  if (count == 2 && !cut[(first + 1) % 3]) first = (first + 2) % 3;
  const u32 a = triangle[first], b = triangle[(first + 1) % 3], c = triangle[(first + 2) % 3];
  const u32 ab = middles.between(a, b);
  if (count == 1) {
    out.insert(out.end(), {{a, ab, c}, {ab, b, c}});
    return;
  }
  const u32 bc = middles.between(b, c);
  if (count == 3) {
    const u32 ca = middles.between(c, a);
    out.insert(out.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    return;
  }
  out.push_back({ab, b, bc});
  if (length2(mesh, a, bc) < length2(mesh, ab, c))
    out.insert(out.end(), {{a, ab, bc}, {a, bc, c}});
  else
    out.insert(out.end(), {{a, ab, c}, {ab, bc, c}});
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const glm::uvec3& t : mesh.triangles) area += glm::length(face_normal(mesh, t)) / 2;
  return area;
}

/// Displaces a mesh for one object that shows it.
class Displacer {
 public:
  Displacer(const SceneDescription& scene, const Object& object, const Mesh& mesh)
      : scene_(scene), object_(object), mesh_(mesh) {}

  Mesh run() {
    if (mesh_.uvs.empty())
      fail(fmt::format("its mesh \"{}\" has no texture coordinates, which \"displacement\" needs",
                       mesh_.name));
    Mesh mesh = mesh_;
    if (mesh.materials.empty()) mesh.materials.assign(mesh.triangles.size(), object_.material);
    const double edge = wanted_edge();
    // A refined triangle has at most the area of an equilateral one.
    const bool few = area_of(mesh) / (0.434 * edge * edge) < double{most_displaced_triangles};
    if (few) mesh = refine(std::move(mesh), edge, most_displaced_triangles);
    if (!few || mesh.triangles.size() > most_displaced_triangles)
      fail(
          fmt::format("its displaced mesh would have more than {} million triangles; give its material's "
                      "\"displacement\" a longer \"edge\" than {:.3g}",
                      most_displaced_triangles / 1'000'000, edge));
    move(mesh);
    mesh.normals.clear();
    models::complete_normals(mesh, {}, crease_degrees, models::weld_positions(mesh));
    if (object_.material >= 0) mesh.materials.clear();
    return mesh;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw SceneError(scene_.file.string(), object_.place, reason);
  }

  const MaterialDescription* material_of(const Mesh& mesh, std::size_t triangle) const {
    const int index = object_.material >= 0 ? object_.material : mesh.materials[triangle];
    return index < 0 ? nullptr : &scene_.materials[static_cast<std::size_t>(index)];
  }

  /// The shortest edge that materials request; at least a texel for those that request none.
  double wanted_edge() const {
    double area = 0, texels = 0, asked = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const MaterialDescription* material = material_of(mesh_, t);
      if (!material || material->displaced_by < 0) continue;
      if (material->displacement_edge > 0) {
        asked = std::min(asked, material->displacement_edge);
        continue;
      }
      const auto& [a, b, c] = std::tie(mesh_.triangles[t].x, mesh_.triangles[t].y, mesh_.triangles[t].z);
      const dvec3 p(mesh_.positions[a]);
      area += glm::length(glm::cross(dvec3(mesh_.positions[b]) - p, dvec3(mesh_.positions[c]) - p)) / 2;
      const glm::dvec2 uv(mesh_.uvs[a]), e1 = glm::dvec2(mesh_.uvs[b]) - uv,
                                         e2 = glm::dvec2(mesh_.uvs[c]) - uv;
      const TextureDescription& heights = scene_.textures[static_cast<std::size_t>(material->displaced_by)];
      const StoredImage& image = scene_.images[static_cast<std::size_t>(heights.image)].pixels;
      texels += std::abs(e1.x * e2.y - e1.y * e2.x) / 2 * std::abs(glm::determinant(glm::dmat2(heights.uv))) *
                double(image.width) * image.height;
    }
    if (!(area > 0)) return asked;
    // Triangles with edges up to this length are about 2.5 times as many as squares.
    const double usual = std::sqrt(area * 2.5 / double{usual_displaced_triangles});
    return std::min(asked, texels > 0 ? std::max(std::sqrt(area / texels), usual) : usual);
  }

  /// Moves each point by the mean height of its corners along their mean normal.
  void move(Mesh& mesh) const {
    const std::vector<u32> place = models::weld_positions(mesh);
    std::vector<dvec3> normals(mesh.positions.size(), dvec3(0));
    std::vector<dvec2> heights(mesh.positions.size(), dvec2(0));  // sum and count
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const glm::uvec3 triangle = mesh.triangles[t];
      const dvec3 face = face_normal(mesh, triangle);
      const MaterialDescription* material = material_of(mesh, t);
      for (int corner = 0; corner < 3; ++corner) {
        const u32 vertex = triangle[corner];
        normals[place[vertex]] += mesh.normals.empty() ? face : dvec3(mesh.normals[vertex]);
        heights[place[vertex]] += dvec2(height_at(material, mesh.uvs[vertex]), 1);
      }
    }
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
      const dvec3 normal = normals[place[vertex]];
      const dvec2 height = heights[place[vertex]];
      const double length = glm::length(normal);
      if (length > 0 && height.y > 0)
        mesh.positions[vertex] += glm::vec3(normal * (height.x / height.y / length));
    }
  }

  double height_at(const MaterialDescription* material, glm::vec2 uv) const {
    if (!material || material->displaced_by < 0) return 0;
    const TextureDescription& heights = scene_.textures[static_cast<std::size_t>(material->displaced_by)];
    const double value = texture_number(scene_, heights, dvec2(uv)) - material->displacement_middle;
    return material->displacement * value;
  }

  const SceneDescription& scene_;
  const Object& object_;
  const Mesh& mesh_;
};

/// Whether a material displaces its meshes; heights must come from an image.
bool displaces(const SceneDescription& scene, int index) {
  if (index < 0) return false;
  const MaterialDescription& material = scene.materials[static_cast<std::size_t>(index)];
  if (material.displaced_by < 0 || material.displacement == 0) return false;
  const TextureDescription& heights = scene.textures[static_cast<std::size_t>(material.displaced_by)];
  if (heights.kind != TEXTURE_IMAGE || heights.mapping != Mapping::uv || heights.uv_set != 0)
    throw SceneError(scene.file.string(), join_pointer("/materials", material.name) + "/displacement",
                     fmt::format("the \"displacement\" of material \"{}\" needs an image on the first set of "
                                 "texture coordinates; bump and parallax take any texture",
                                 material.name));
  return true;
}

}  // namespace

Mesh refine(Mesh mesh, double edge, std::size_t most) {
  mesh.tangents.clear();  // compile() computes them for the new surface
  if (!(edge > 0)) return mesh;
  for (bool any = true; any && mesh.triangles.size() <= most;) {
    any = false;
    Middles middles(mesh);
    std::vector<glm::uvec3> triangles;
    std::vector<int> materials;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const glm::uvec3 triangle = mesh.triangles[t];
      bool cut[3];
      for (int i = 0; i < 3; ++i) cut[i] = length2(mesh, triangle[i], triangle[(i + 1) % 3]) > edge * edge;
      any |= cut[0] || cut[1] || cut[2];
      split(mesh, triangle, cut, middles, triangles);
      if (!mesh.materials.empty()) materials.resize(triangles.size(), mesh.materials[t]);
    }
    mesh.triangles = std::move(triangles);
    if (!mesh.materials.empty()) mesh.materials = std::move(materials);
  }
  return mesh;
}

void displace_meshes(SceneDescription& scene) {
  std::map<std::pair<int, int>, int> made;  // key: mesh and the object's material
  for (Object& object : scene.objects) {
    auto* shape = std::get_if<MeshShape>(&object.shape);
    bool wanted = displaces(scene, object.material);
    if (!shape && wanted)
      throw SceneError(scene.file.string(), object.place,
                       fmt::format("its material \"{}\" has a \"displacement\", which only meshes can have; "
                                   "give it a \"bump\" or a \"parallax\"",
                                   scene.materials[static_cast<std::size_t>(object.material)].name));
    if (!shape) continue;
    if (object.material < 0)
      for (const int material : scene.meshes[static_cast<std::size_t>(shape->mesh)].materials)
        wanted = wanted || displaces(scene, material);
    if (!wanted) continue;
    const auto [found, added] =
        made.try_emplace({shape->mesh, object.material}, static_cast<int>(scene.meshes.size()));
    if (added) {
      Mesh moved = Displacer(scene, object, scene.meshes[static_cast<std::size_t>(shape->mesh)]).run();
      scene.meshes.push_back(std::move(moved));
    }
    shape->mesh = found->second;
  }
}

}  // namespace sundog
