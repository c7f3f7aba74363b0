// Meshes that share a BVH look like meshes with a BVH each, on every tracer. One walk passes any number of
// surfaces that cannot be seen, or that let light through.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "compile/bvh/mesh_groups.h"
#include "devices.h"
#include "same_bits.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// A closed one: both ends of its rings are points.
Mesh ball(float radius, glm::vec3 center) {
  Mesh mesh = bumpy_sphere(10);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] = center + radius * glm::round(mesh.normals[i] * 0x1p20f) * 0x1p-20f;
  return mesh;
}

void add_pane(Mesh& mesh, float y, float slope) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  for (const glm::vec3 corner : {glm::vec3(-2, y - 2 * slope, -1), {2, y + 2 * slope, -1}, {0, y, 2}})
    mesh.positions.push_back(corner);
  mesh.triangles.emplace_back(first, first + 2, first + 1);
}

/// Triangles over the origin, the steeper the higher: their boxes overlap, and rays meet far ones first.
Mesh panes(int count, float up) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) add_pane(mesh, up * (1 + 0.1f * float(i)), 0.07f * float(i));
  return mesh;
}

void place_mesh(SceneDescription& scene, Mesh mesh, int material) {
  scene.meshes.push_back(std::move(mesh));
  scenes::place(scene, MeshShape{static_cast<int>(scene.meshes.size()) - 1}, material);
}

/// A camera on what is placed about the origin, in the light of a point.
SceneDescription small_picture() {
  SceneDescription scene = scenes::line_of_sight({0.4, 1.5, 5}, {0, 0, 0});
  scene.camera.fov = 40;
  scene.image.width = 28;
  scene.image.height = 24;
  scene.image.background_top = {0.2, 0.4, 0.9};
  LightDescription point;
  point.position = {-5, 6, 4};
  scene.lights.push_back(point);
  return scene;
}

/// Gives each mesh its own BVH: a second object far behind the camera places it again.
SceneDescription apart(SceneDescription scene) {
  const std::size_t count = scene.objects.size();
  for (std::size_t i = 0; i < count; ++i)
    if (std::holds_alternative<MeshShape>(scene.objects[i].shape))
      scenes::place(scene, scene.objects[i].shape, scene.objects[i].material,
                    glm::translate(glm::dmat4(1), {0, 0, 500}));
  return scene;
}

/// Calls body(device, tracer) for each tracer.
template <class Body>
void on_each_tracer(Body body) {
  for (const DeviceInfo& device : picture_devices())
    for (const Tracer tracer : {Tracer::wide, Tracer::compact}) {
      if (device.native_vector_width <= 1 && tracer == Tracer::wide) continue;
      DYNAMIC_SECTION(device.label() << (tracer == Tracer::wide ? ", wide" : ", compact")) {
        body(device, tracer);
      }
    }
}

void check_alike(const DeviceInfo& device, SceneDescription scene, Tracer tracer) {
  scene.render.tracer = tracer;
  const SceneDescription each = apart(scene);
  REQUIRE(mesh_groups(scene).size() < mesh_groups(each).size());
  RenderOptions options;
  options.aovs = {"object", "normal"};
  const RenderResult together = scenes::render_on(device, scene, options),
                     alone = scenes::render_on(device, each, options);
  CHECK(same_bits(together.aovs.at("object"), alone.aovs.at("object")));
  CHECK(same_bits(together.aovs.at("normal"), alone.aovs.at("normal")));
  for (std::size_t i = 0; i < alone.image.data.size(); ++i)
    REQUIRE(together.image.data[i] == Approx(alone.image.data[i]).margin(1e-6));
}

}  // namespace

TEST_CASE("each mesh in a shared BVH keeps its own hits") {
  SceneDescription scene = small_picture();
  for (const dvec3 color : {dvec3(0.9, 0.2, 0.1), dvec3(0.1, 0.8, 0.2), dvec3(0.2, 0.2, 0.9)})
    scenes::add_white(scene), scene.materials.back().diffuse = color;
  if (GENERATE(true, false)) {  // opaque ones
    place_mesh(scene, ball(1, {0, 0, 0}), 0);
    place_mesh(scene, ball(0.8f, {0.6f, 0, 0.4f}), 1);
    place_mesh(scene, ball(0.7f, {-0.5f, 0.4f, 0.3f}), 2);
  } else {  // liquid in ice, around something
    place_mesh(scene, ball(1, {0, 0, 0}), scenes::add_dielectric(scene, 1.31, {0.2, 0.1, 0}, 2));
    place_mesh(scene, ball(0.7f, {0, 0, 0}), scenes::add_dielectric(scene, 1.4, {0, 0.4, 0.4}, 3));
    place_mesh(scene, ball(0.3f, {0.1f, 0, 0}), 0);
    scenes::place(scene, SphereShape{0.2}, 1, glm::translate(glm::dmat4(1), {-0.3, 0, 0}));
  }
  scene.render.max_depth = 5;
  on_each_tracer([&](const DeviceInfo& device, Tracer tracer) { check_alike(device, scene, tracer); });
}

TEST_CASE("a ray to a light passes any number of panes of meshes, up to what lets no light through") {
  constexpr int count = 20;
  const bool blocked = GENERATE(false, true);
  const int up = GENERATE(1, -1);  // leaves are met from their beginning, and from their end
  SceneDescription scene = scenes::line_of_sight({3, 0.05 * up, 0.1}, {0, 0, 0.1});
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {0, -up, 0};
  scene.lights.push_back(sun);
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene), glm::scale(glm::dmat4(1), dvec3(1, up, 1)));
  const int tinted = scenes::add_mirror(scene, 0);
  scene.materials.back().transmission = {0.9, 1, 1};
  place_mesh(scene, panes(count, float(up)), tinted);
  if (blocked) {
    Mesh opaque;
    add_pane(opaque, float(up) * 2.25f, 0);
    place_mesh(scene, opaque, 0);
  }
  on_each_tracer([&](const DeviceInfo& device, Tracer tracer) {
    SceneDescription own = scene;
    own.render.tracer = tracer;
    const dvec3 light = scenes::pixel_on(device, own);
    CHECK(light.x == Approx(blocked ? 0 : std::pow(0.9, count)).epsilon(1e-5));
    CHECK(light.y == Approx(blocked ? 0 : 1).epsilon(1e-5));
  });
}

TEST_CASE("surfaces inside a medium of a higher priority cannot be seen, however many") {
  SceneDescription scene = small_picture();
  const int ice = scenes::add_dielectric(scene, 1.31, {0.2, 0.1, 0}, 2);
  place_mesh(scene, ball(1, {0, 0, 0}), ice);
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene), glm::translate(glm::dmat4(1), {0, -1.2, 0}));
  SceneDescription filled = scene;
  const int liquid = scenes::add_dielectric(filled, 1.5, {0, 3, 3}, 1);
  for (int i = 0; i < 6; ++i) place_mesh(filled, ball(0.85f - 0.1f * float(i), {0, 0, 0}), liquid);
  on_each_tracer([&](const DeviceInfo& device, Tracer tracer) {
    scene.render.tracer = filled.render.tracer = tracer;
    scene.render.max_depth = filled.render.max_depth = 4;
    const Image plain = scenes::render_on(device, scene).image,
                image = scenes::render_on(device, filled).image;
    for (std::size_t i = 0; i < plain.data.size(); ++i)
      REQUIRE(image.data[i] == Approx(plain.data[i]).margin(1e-5));
  });
}
