// Displaced meshes: cut finely, moved by heights, without cracks.
#include <cmath>
#include <map>

#include "base/error.h"
#include "catch.h"
#include "scene/displace.h"
#include "scene/heights.h"
#include "scene/mesh_faults.h"

using namespace sundog;

namespace {

/// A closed box of eight corners, whose faces' coordinates meet in seams.
Mesh closed_box() {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const auto first = static_cast<u32>(mesh.positions.size());
      for (int corner = 0; corner < 4; ++corner) {
        glm::vec3 p(0);
        p[axis] = side ? 1.0f : -1.0f;
        const float a = corner % 2 ? 1.0f : -1.0f, b = corner / 2 ? 1.0f : -1.0f;
        p[(axis + 1) % 3] = side ? a : b;
        p[(axis + 2) % 3] = side ? b : a;
        mesh.positions.push_back(p);
        mesh.uvs.emplace_back(corner % 2, corner / 2);
      }
      mesh.triangles.emplace_back(first, first + 1, first + 3);
      mesh.triangles.emplace_back(first, first + 3, first + 2);
    }
  return mesh;
}

void add_object(SceneDescription& scene, int material) {
  Object& object = scene.objects.emplace_back();
  object.shape = MeshShape{0};
  object.material = material;
}

/// An object of the mesh, displaced by an image of grey bytes.
SceneDescription displaced(Mesh mesh, int width, std::vector<std::uint8_t> grey, double height, double edge) {
  SceneDescription scene;
  ImageDescription image;
  image.srgb = false;
  image.pixels.width = width;
  image.pixels.height = static_cast<int>(grey.size()) / width;
  image.pixels.channels = 1;
  image.pixels.data = std::move(grey);
  scene.images.push_back(std::move(image));
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = 0;
  texture.channel = 0;
  scene.textures.push_back(texture);
  MaterialDescription material;
  material.name = "stone";
  material.displaced_by = 0;
  material.displacement = height;
  material.displacement_edge = edge;
  scene.materials.push_back(material);
  scene.meshes.push_back(std::move(mesh));
  add_object(scene, 0);
  return scene;
}

Mesh square() {
  Mesh mesh;
  for (const float v : {0.0f, 1.0f})
    for (const float u : {0.0f, 1.0f}) {
      mesh.positions.emplace_back(4 * u, 0, -4 * v);
      mesh.uvs.emplace_back(u, v);
    }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  return mesh;
}

const Mesh& mesh_of(const SceneDescription& scene) {
  return scene.meshes[static_cast<std::size_t>(std::get<MeshShape>(scene.objects[0].shape).mesh)];
}

double longest_edge(const Mesh& mesh) {
  float longest = 0;
  for (const glm::uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      longest = std::max(longest, glm::distance(mesh.positions[t[i]], mesh.positions[t[(i + 1) % 3]]));
  return double(longest);
}

}  // namespace

TEST_CASE("refined meshes have short edges, the same area, and close as before") {
  Mesh uneven = closed_box();
  for (glm::vec3& p : uneven.positions) p.x *= 5;
  for (const double edge : {20.0, 3.0, 0.7, 0.21}) {
    const Mesh fine = refine(uneven, edge, 1'000'000);
    CHECK(longest_edge(fine) <= std::max(edge, 0.0) + 1e-6);
    double area = 0;
    for (const glm::uvec3& t : fine.triangles)
      area += double(glm::length(glm::cross(fine.positions[t.y] - fine.positions[t.x],
                                            fine.positions[t.z] - fine.positions[t.x]))) /
              2;
    CHECK(area == Approx(88).epsilon(1e-5));
    const MeshFaults faults = find_faults(fine);
    CHECK(faults.open_edges == 0);
    CHECK(faults.turned_edges == 0);
    CHECK(faults.inside_out == 0);
  }
}

TEST_CASE("a displaced square stands where its heights say, and its normals follow their slope") {
  // Heights rise from 0 to 1 between the middles of the first and the last texel.
  std::vector<std::uint8_t> ramp;
  for (int i = 0; i < 16; ++i) ramp.push_back(static_cast<std::uint8_t>(17 * i));
  SceneDescription scene = displaced(square(), 16, ramp, 0.5, 0.1);
  scene.materials[0].displacement_middle = 0.25;
  displace_meshes(scene);
  const Mesh& mesh = mesh_of(scene);
  REQUIRE(mesh.triangles.size() > 2000);
  REQUIRE(mesh.normals.size() == mesh.positions.size());
  const double slope = 0.5 * 16 / 15 / 4;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 p = mesh.positions[i];
    const double u = double(p.x) / 4;
    if (u < 0.1 || u > 0.9) continue;
    const double h = (u * 16 - 0.5) / 15;
    REQUIRE(double(p.y) == Approx(0.5 * (h - 0.25)).margin(1e-4));
    REQUIRE(double(mesh.normals[i].x / mesh.normals[i].y) == Approx(-slope).margin(1e-3));
  }
}

TEST_CASE("a displaced solid stays closed across its edges and seams") {
  std::vector<std::uint8_t> noise;
  for (u32 i = 0; i < 64; ++i) noise.push_back(static_cast<std::uint8_t>(i * 2654435761u >> 24));
  SceneDescription scene = displaced(closed_box(), 8, noise, 0.2, 0.15);
  displace_meshes(scene);
  const MeshFaults faults = find_faults(mesh_of(scene));
  CHECK(faults.open_edges == 0);
  CHECK(faults.turned_edges == 0);
  CHECK(faults.inside_out == 0);
  bool moved = false;
  for (const glm::vec3& p : mesh_of(scene).positions) moved |= std::abs(p.x) > 1.1f;
  CHECK(moved);
}

TEST_CASE("objects share a displaced mesh, and others keep theirs") {
  SceneDescription scene = displaced(square(), 1, {255}, 1, 1);
  scene.materials.emplace_back().name = "plain";
  add_object(scene, 0);
  add_object(scene, 1);
  displace_meshes(scene);
  const auto mesh = [&](std::size_t i) { return std::get<MeshShape>(scene.objects[i].shape).mesh; };
  CHECK(mesh(0) == mesh(1));
  CHECK(mesh(0) != 0);
  CHECK(mesh(2) == 0);
  CHECK(scene.meshes.size() == 2);
}

TEST_CASE("what cannot be displaced is an error that says why") {
  const auto message = [](SceneDescription scene) {
    try {
      displace_meshes(scene);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto has = [](const std::string& text, const char* words) { return text.find(words) != text.npos; };
  SceneDescription solid = displaced(square(), 1, {255}, 1, 0);
  solid.objects[0].shape = SphereShape{};
  CHECK(has(message(solid), "only meshes"));
  SceneDescription bare = displaced(square(), 1, {255}, 1, 0);
  bare.meshes[0].uvs.clear();
  CHECK(has(message(bare), "texture coordinates"));
  SceneDescription pattern = displaced(square(), 1, {255}, 1, 0);
  pattern.textures[0].kind = TEXTURE_NOISE;
  CHECK(has(message(pattern), "/materials/stone/displacement"));
  CHECK(has(message(displaced(square(), 1, {255}, 1, 1e-5)), "longer \"edge\""));
}

TEST_CASE("heights on the host are those of bilinear texels, turned and repeated") {
  SceneDescription scene = displaced(square(), 2, {0, 255, 51, 102}, 1, 0);
  TextureDescription& texture = scene.textures[0];
  CHECK(texture_number(scene, texture, {0.25, 0.75}) == Approx(0).margin(1e-9));
  CHECK(texture_number(scene, texture, {0.75, 0.75}) == Approx(1));
  CHECK(texture_number(scene, texture, {1.75, -0.75}) == Approx(0.4));
  CHECK(texture_number(scene, texture, {0.5, 0.5}) == Approx((0 + 1 + 0.2 + 0.4) / 4));
  CHECK(texture_number(scene, texture, {0, 0.75}) == Approx(0.5));  // repeats
  texture.wrap[0] = Wrap::clamp;
  CHECK(texture_number(scene, texture, {0, 0.75}) == Approx(0).margin(1e-9));
  texture.uv = glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1));
  CHECK(texture_number(scene, texture, {0.25, 0.75}) == Approx(0.4));
  CHECK(texture_number(scene, texture, {NAN, 0.5}) >= 0);
}
