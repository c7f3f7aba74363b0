// Models of others whose readmes say what they should show. All are optional: where the assets are not there
// the tests say so.
#include <base/file.h>
#include <base/image_io.h>
#include <base/pixels/stored_image.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "assets.h"
#include "catch.h"
#include "devices.h"
#include "scene/load.h"
#include "scenes.h"

using namespace sundog;

namespace {

constexpr double pi = std::numbers::pi;

/// The model in the assets; a warning where there is none.
std::optional<SceneDescription> model(const std::filesystem::path& name) {
  const std::filesystem::path file = assets_directory() / "gltf" / name;
  if (!assets_directory().empty() && std::filesystem::exists(file))
    return load_scene(file, {"/render/integrator=whitted", "/render/samples=1"});
  WARN("left out: " << file.string() << " is not there");
  return std::nullopt;
}

/// Without what sundog makes up: no floor, no sky, one ambient light.
void show_alone(SceneDescription& scene) {
  std::erase_if(scene.objects,
                [](const Object& object) { return std::holds_alternative<PlaneShape>(object.shape); });
  LightDescription ambient;
  ambient.type = LightType::ambient;
  scene.lights.assign(1, ambient);
  scene.environment = {};
}

/// A square picture that looks along -n at the point `middle`, `half` wide from there to its edges.
struct Sight {
  dvec3 middle, n, up;
  double half;
  int edge;
  Image image;

  void render(SceneDescription scene) {
    constexpr double away = 200;
    scene.camera.position = middle + away * n;
    scene.camera.target = middle;
    scene.camera.up = up;
    scene.camera.fov = 2 * std::atan(half / away) * 180 / pi;
    scene.image.width = scene.image.height = edge;
    image = scenes::render_on(test_devices().front(), scene).image;
  }
  dvec3 pixel(int column, int row) const {
    const float* rgb = &image.data[static_cast<std::size_t>(row * edge + column) * 4];
    return {rgb[0], rgb[1], rgb[2]};
  }
  /// At a point near the plane through `middle`: the mean of (2 reach + 1)^2 pixels.
  dvec3 at(const dvec3& p, int reach = 0) const {
    const dvec3 right = glm::normalize(glm::cross(up, n)), upwards = glm::cross(n, right);
    const double scale = edge / (2 * half);
    const auto column = static_cast<int>(edge / 2.0 + scale * glm::dot(p - middle, right)),
               row = static_cast<int>(edge / 2.0 - scale * glm::dot(p - middle, upwards));
    dvec3 sum(0);
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) sum += pixel(column + i, row + j);
    return sum / double((2 * reach + 1) * (2 * reach + 1));
  }
};

double difference(const dvec3& a, const dvec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

dvec3 middle_of(const SceneDescription& scene, const std::string& mesh) {
  for (const Mesh& each : scene.meshes)
    if (each.name == mesh) {
      glm::vec3 low(1e9f), high(-1e9f);
      for (const glm::vec3& p : each.positions) low = glm::min(low, p), high = glm::max(high, p);
      return dvec3(0.5f * (low + high));
    }
  FAIL("there is no mesh " << mesh);
  return {};
}

}  // namespace

// Its readme: an arrow on each side of the cube points to the target of its own colour, if rotations by
// quaternions and by matrices are right.
TEST_CASE("the arrows of OrientationTest point to their targets", "[assets]") {
  std::optional<SceneDescription> scene = model("OrientationTest.glb");
  if (!scene) return;
  show_alone(*scene);
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {1, -1}) {
      const std::string name = std::string("TargetMesh") + "XYZ"[axis] + (side > 0 ? '1' : '2');
      INFO(name);
      Sight view;
      view.n = dvec3(0);
      view.n[axis] = side;
      view.middle = 5.33 * view.n;
      view.up = axis == 1 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
      view.half = 5.5, view.edge = 88;
      view.render(*scene);
      dvec3 target = middle_of(*scene, name);
      target[axis] = 5.33 * side;
      const dvec3 way = glm::normalize(target - view.middle), beside = glm::cross(way, view.n);
      const dvec3 color = view.at(target);
      CHECK(difference(view.at(view.middle + 1.0 * way), color) < 0.02);
      CHECK(difference(view.at(view.middle + 2.5 * way), color) < 0.02);
      CHECK(difference(view.at(view.middle + 2.5 * beside), color) > 0.04);
      CHECK(difference(view.at(view.middle - 2.5 * beside), color) > 0.04);
      CHECK(difference(view.at(view.middle - 2.5 * way), color) > 0.04);
    }
}

// KHR_texture_transform: offset, rotation and scale of each texture by itself, on v that goes down; nearest
// texels.
TEST_CASE("each texture of 09_texture_transform lies where its transform says", "[assets]") {
  const std::filesystem::path folder = "09_texture_transform";
  std::optional<SceneDescription> scene = model(folder / "09_texture_transform.gltf");
  if (!scene) return;
  show_alone(*scene);
  const StoredImage grid =
      decode_stored(read_file(assets_directory() / "gltf" / folder / "09_tiny_grid.png"));
  struct Transform {
    int texture;
    double x, y, angle, width, height;
    bool srgb;
  };
  const MaterialTextures textures = scene->materials.at(0).textures;
  scene->materials[0] = {};
  MaterialDescription& material = scene->materials[0];
  material.ambient = material.diffuse = dvec3(0);
  material.emission = dvec3(1);
  Sight view{{0, 0, 0}, {0, 1, 0}, {0, 0, -1}, 1, 240, {}};
  for (const Transform& t : {Transform{textures.diffuse, 0.1, 0.2, 0.3, 4, 5, true},
                             Transform{textures.metal_rough, 0.2, 0.3, 0.4, 5, 6, false},
                             Transform{textures.normal, 0.3, 0.4, 0.5, 6, 7, false}}) {
    INFO("offset " << t.x << ", " << t.y);
    REQUIRE(t.texture >= 0);
    material.textures.emission = t.texture;
    view.render(*scene);
    int wrong = 0;
    for (int row = 0; row < view.edge; ++row)
      for (int column = 0; column < view.edge; ++column) {
        // The quad has u from 0 to 1 along x and v from 0 to 1 along z.
        const double u = (column + 0.5) / view.edge * t.width, v = (row + 0.5) / view.edge * t.height;
        const double x = std::cos(t.angle) * u + std::sin(t.angle) * v + t.x,
                     y = -std::sin(t.angle) * u + std::cos(t.angle) * v + t.y;
        const auto texel = [](double place, int size) {
          return std::min(static_cast<int>((place - std::floor(place)) * size), size - 1);
        };
        const std::uint8_t* rgba =
            &grid.data[static_cast<std::size_t>(texel(y, grid.height) * grid.width + texel(x, grid.width)) *
                       4];
        dvec3 wanted;
        for (int c = 0; c < 3; ++c)
          wanted[c] = t.srgb ? double(linear_from_srgb(static_cast<float>(rgba[c]) / 255)) : rgba[c] / 255.0;
        wrong += difference(view.pixel(column, row), wanted) > 0.01;
      }
    CHECK(wrong <= view.edge * view.edge / 25);  // where rounding chooses a texel
  }
}

// Its readme: each square of the left column shows what the sample beside it shows, a green check, or all
// green where the texture is clamped. Wraps and sides that are wrong show a red cross.
TEST_CASE("the squares of TextureSettingsTest are those of its samples", "[assets]") {
  std::optional<SceneDescription> scene = model("TextureSettingsTest/TextureSettingsTest.gltf");
  if (!scene) return;
  show_alone(*scene);
  Sight view{{1.525, -1.1, 0}, {0, 0, 1}, {0, 1, 0}, 4.5, 120, {}};
  view.render(*scene);
  for (const double y : {-4.715, -3.678, -2.641, -1.604, -0.57, 0.467, 1.52, 2.545}) {
    const dvec3 square = view.at({0.455, y, 0}, 4), sample = view.at({2.601, y, 0}, 4);
    INFO("the row at " << y << ": " << square.x << " " << square.y << " " << square.z << ", sample "
                       << sample.x << " " << sample.y << " " << sample.z);
    CHECK(square.y > 1.05 * square.x);
    CHECK(difference(square, sample) < 0.05);
  }
}
