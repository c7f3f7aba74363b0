// Shared by tests of path tracing: a scene of one point, lamps, and means with their errors.
#pragma once
#include <cmath>
#include <numbers>

#include "catch.h"
#include "devices.h"
#include "scene/lamps.h"
#include "scenes.h"

namespace sundog::paths {

using glm::dvec3;

inline constexpr double pi = std::numbers::pi;

/// A view so narrow that all pixels see one point, each with random numbers of its own.
inline SceneDescription path_scene(const dvec3& position, const dvec3& target, int samples = 32) {
  SceneDescription scene = scenes::line_of_sight(position, target);
  scene.lights.clear();
  scene.image.width = scene.image.height = 8;
  scene.render.integrator = "path";
  scene.render.samples = samples;
  scene.render.max_depth = 64;
  return scene;
}

inline int add_matte(SceneDescription& scene, double albedo) {
  const int material = scenes::add_white(scene);
  scene.materials.back().diffuse = dvec3(albedo);
  return material;
}

inline LightDescription lamp(LightType type, const dvec3& position, double radiance) {
  LightDescription light;
  light.type = type;
  light.position = position;
  light.intensity = radiance;
  light.hidden = true;
  return light;
}

struct Mean {
  dvec3 value;
  double error;  // standard, of the first channel
};

inline Mean mean_on(const DeviceInfo& device, const SceneDescription& scene) {
  const Image image = scenes::render_on(device, scene).image;
  const double count = double(image.data.size()) / 4;
  dvec3 sum(0);
  double squares = 0;
  for (std::size_t i = 0; i < image.data.size(); i += 4) {
    sum += dvec3(image.data[i], image.data[i + 1], image.data[i + 2]);
    squares += double(image.data[i]) * double(image.data[i]);
  }
  const dvec3 mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean.x * mean.x, 0.0) / count)};
}

/// Three standard errors, and rounding.
inline void check_mean(const Mean& found, double expected) {
  INFO(found.value.x << " +- " << found.error << ", expected " << expected);
  CHECK(std::abs(found.value.x - expected) < 3 * found.error + 2e-3 * expected);
}

/// A box of half size 1 about the origin whose faces look inwards.
inline int add_room(SceneDescription& scene) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  const glm::uvec4 faces[] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                              {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (const glm::uvec4& f : faces) {
    mesh.triangles.push_back({f.x, f.y, f.z});
    mesh.triangles.push_back({f.x, f.z, f.w});
  }
  mesh.source_vertex_count = 8;
  scene.meshes.push_back(mesh);
  return static_cast<int>(scene.meshes.size()) - 1;
}

}  // namespace sundog::paths
