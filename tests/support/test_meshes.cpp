// Generates the tests' meshes from fixed seeds.
#include "test_meshes.h"

#include <cmath>
#include <numbers>
#include <random>

namespace sundog {
namespace {

/// std::uniform_real_distribution differs between libraries; this does not.
float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f; }

glm::vec3 point(std::mt19937& random) {
  const float x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

}  // namespace

Mesh random_triangles(std::size_t count, float size, unsigned seed) {
  std::mt19937 random(seed);
  Mesh mesh;
  mesh.name = "random";
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 center = point(random);
    const auto first = static_cast<unsigned>(mesh.positions.size());
    for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(center + size * point(random));
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

Mesh bumpy_sphere(int rings, double bumps) {
  Mesh mesh;
  mesh.name = "bumpy";
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * j / columns;
      const double r =
          1 + bumps * (0.1 * std::sin(7 * a) * std::cos(5 * b) + 0.02 * std::sin(31 * a + 17 * b));
      const glm::dvec3 n(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b));
      mesh.positions.emplace_back(r * n);
      mesh.normals.emplace_back(n);
    }
  const auto index = [&](int i, int j) { return static_cast<unsigned>(i * columns + j % columns); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < columns; ++j) {
      if (i > 0) mesh.triangles.emplace_back(index(i, j), index(i, j + 1), index(i + 1, j));
      if (i + 1 < rings) mesh.triangles.emplace_back(index(i, j + 1), index(i + 1, j + 1), index(i + 1, j));
    }
  return mesh;
}

SceneDescription scene_of(Mesh mesh) {
  SceneDescription scene;
  scene.file = "test.json";
  scene.media.resize(1);
  scene.materials.resize(1);
  scene.meshes.push_back(std::move(mesh));
  Object object;
  object.name = "object";
  object.place = "/objects/0";
  object.shape = MeshShape{0};
  object.material = 0;
  scene.objects.push_back(object);
  return scene;
}

}  // namespace sundog
