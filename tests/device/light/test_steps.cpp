// A ray's view, step by step: the attributes of triangles, fog, background and clipping in closed form.
// The scenes share their kernels: each is one triangle under one ambient and one directional light.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double pi = 3.14159265358979323846;

const std::vector<glm::vec3> corners{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

// The weights of the three corners at the point that the line of sight meets.
const dvec3 weights{0.5, 0.3, 0.2}, met{1.2, 0.8, 0};

dvec3 blend(const dvec3& a, const dvec3& b, const dvec3& c) {
  return weights.x * a + weights.y * b + weights.z * c;
}

/// The triangle as the only thing, of a white material without terms, seen along -z; and a light that travels
/// against `to_light`.
SceneDescription one_triangle(dvec3 to_light = {0, 0, 1}, double intensity = 1) {
  SceneDescription scene = scenes::line_of_sight(met + dvec3(0, 0, 5), met);
  Mesh mesh;
  mesh.positions = corners;
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  scenes::place(scene, MeshShape{0}, scenes::add_glow(scene, {0, 0, 0}));
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = -to_light;
  sun.intensity = intensity;
  scene.lights.push_back(sun);
  return scene;
}

MaterialDescription& material_of(SceneDescription& scene) { return scene.materials.front(); }

void check_color(const DeviceInfo& device, const SceneDescription& scene, const dvec3& expected) {
  const dvec3 seen = scenes::pixel_on(device, scene);
  for (int c = 0; c < 3; ++c) CHECK(seen[c] == Approx(expected[c]).epsilon(1e-5).margin(1e-6));
}

/// A triangle across the whole view, at this depth, that glows.
SceneDescription wall_at(double depth, double near, double far) {
  SceneDescription scene = one_triangle({0, 0, 1}, 0);
  scene.camera = Camera{};
  scene.camera.position = {0, 0, 0};
  scene.camera.target = {0, 0, -1};
  scene.camera.fov = 70;
  scene.camera.near = near;
  scene.camera.far = far;
  scene.image.width = scene.image.height = 8;
  material_of(scene).ambient = {1, 1, 1};
  scene.meshes.front().positions = {{-50, -50, -depth}, {150, -50, -depth}, {-50, 150, -depth}};
  return scene;
}

}  // namespace

TEST_CASE("vertex colours are blended by the weights of their own corners") {
  SceneDescription scene = one_triangle();
  scene.meshes.front().colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  material_of(scene).vertex_color = true;
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label()) {
      SceneDescription glowing = scene;
      material_of(glowing).ambient = {1, 1, 1};
      check_color(device, glowing, weights);
      SceneDescription lit = scene;
      material_of(lit).diffuse = {1, 1, 1};
      check_color(device, lit, weights);
      material_of(lit).vertex_color = false;
      check_color(device, lit, {1, 1, 1});
    }
}

TEST_CASE("vertex normals are blended by the weights of their own corners, and turned to the viewer") {
  const dvec3 a = glm::normalize(dvec3(0.3, 0.1, 1)), b = glm::normalize(dvec3(-0.2, 0.4, 1)),
              c = glm::normalize(dvec3(0.1, -0.5, 1)), to_light = glm::normalize(dvec3(0.6, -0.3, 0.8));
  const dvec3 normal = glm::normalize(blend(a, b, c));
  SceneDescription scene = one_triangle(to_light);
  scene.meshes.front().normals = {a, b, c};
  material_of(scene).diffuse = {1, 1, 1};
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label()) {
      check_color(device, scene, dvec3(glm::dot(normal, to_light)));
      SceneDescription behind = scene;  // seen and lit from the other side
      behind.camera.position.z = -5;
      behind.lights.back().direction = to_light;
      check_color(device, behind, dvec3(glm::dot(normal, to_light)));
    }
}

TEST_CASE("highlights are about the blended normal, not the triangle's") {
  const double tilt = 20 * pi / 180;
  const dvec3 normal{std::sin(tilt), 0, std::cos(tilt)};
  for (const double light_angle : {2 * tilt, 0.0, -0.3}) {
    const dvec3 to_light{std::sin(light_angle), 0, std::cos(light_angle)};
    for (const bool blinn : {false, true}) {
      SceneDescription scene = one_triangle(to_light);
      scene.meshes.front().normals = {normal, normal, normal};
      material_of(scene).specular = {1, 0.5, 0.25};
      material_of(scene).exponent = 8;
      material_of(scene).blinn = blinn;
      // The viewer is at angle 0, the mirrored light at 2 tilt - light_angle, the half vector between them.
      const double angle = blinn ? 0.5 * light_angle - tilt : 2 * tilt - light_angle;
      for (const DeviceInfo& device : picture_devices())
        DYNAMIC_SECTION(device.label() << ", " << light_angle << (blinn ? ", Blinn" : ", Phong")) {
          check_color(device, scene, std::pow(std::cos(angle), 8) * material_of(scene).specular);
        }
    }
  }
}

TEST_CASE("a surface whose blended normal faces away from a light has no highlight of it") {
  const double tilt = 20 * pi / 180, light_angle = -75 * pi / 180;
  const dvec3 normal{std::sin(tilt), 0, std::cos(tilt)};
  SceneDescription scene = one_triangle({std::sin(light_angle), 0, std::cos(light_angle)});
  scene.meshes.front().normals = {normal, normal, normal};
  material_of(scene).specular = {1, 0.5, 0.25};
  material_of(scene).exponent = 2;
  material_of(scene).blinn = true;
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label()) {
      check_color(device, scene, dvec3(0));
    }
}

TEST_CASE("near and far clip by depth along the view, the same in every pixel") {
  struct Case {
    double depth, near, far;
    float seen;
  };
  const Case c = GENERATE(Case{1.99, 2, 9, 0}, Case{2.01, 2, 9, 1}, Case{2.99, 0, 3, 1}, Case{3.01, 0, 3, 0});
  for (const DeviceInfo& device : picture_devices())
    DYNAMIC_SECTION(device.label() << ", " << c.depth << " of " << c.near << " to " << c.far) {
      const Image image = scenes::render_on(device, wall_at(c.depth, c.near, c.far)).image;
      for (std::size_t i = 0; i < image.data.size(); i += 4) REQUIRE(image.data[i] == Approx(c.seen));
    }
}

namespace {

/// The triangle in fog, and a ball of glass at the place.
SceneDescription foggy_triangle(const dvec3& glow, const dvec3& fog, const dvec3& ball) {
  SceneDescription scene = one_triangle({0, 0, 1}, 0);
  scene.fog = {fog, 0.13, {}};
  material_of(scene).ambient = glow;
  scenes::place(scene, SphereShape{20}, scenes::add_dielectric(scene, 1.5, {0, 0, 0}, 0),
                glm::translate(glm::dmat4(1), ball));
  return scene;
}

}  // namespace

TEST_CASE("fog takes exp(-density d) of what lies behind it and adds the rest in its own colour") {
  const dvec3 glow{0.2, 0.9, 0.4}, fog{0.7, 0.3, 0.1};
  SceneDescription scene = foggy_triangle(glow, fog, {900, 0, 0});
  scene.image.background_bottom = scene.image.background_top = {1, 1, 1};
  const double clear = std::exp(-0.13 * 5);
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label()) {
      check_color(device, scene, clear * glow + (1 - clear) * fog);
      SceneDescription away = scene;  // nothing is behind it: all fog
      away.camera.target = met + dvec3(0, 0, 9);
      check_color(device, away, fog);
    }
}

TEST_CASE("there is no fog inside of things") {
  const dvec3 glow{0.2, 0.9, 0.4};
  const SceneDescription scene = foggy_triangle(glow, {0.7, 0.3, 0.1}, {0, 0, 0});
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label())
  check_color(device, scene, glow);
}

TEST_CASE("samples whose light is not finite in one color count for nothing") {
  SceneDescription scene = one_triangle({0, 0, 1}, 0);
  material_of(scene).ambient = {0.5, 0.5, std::numeric_limits<double>::infinity()};
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label())
  check_color(device, scene, {0, 0, 0});
}

TEST_CASE("the background goes from bottom to top with the sine of the elevation") {
  const dvec3 bottom{0.1, 0.5, 0.9}, top{0.8, 0.2, 0.3};
  for (const double elevation : {-1.2, -0.3, 0.0, 0.7}) {
    SceneDescription scene = one_triangle();
    scene.camera.target = scene.camera.position + dvec3(std::cos(elevation), std::sin(elevation), 0.0);
    scene.image.background_bottom = bottom;
    scene.image.background_top = top;
    const double share = 0.5 + 0.5 * std::sin(elevation);
    for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label() << elevation) {
        check_color(device, scene, (1 - share) * bottom + share * top);
      }
  }
}
