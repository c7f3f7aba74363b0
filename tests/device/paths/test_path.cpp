// Path tracing against closed forms, each way of finding light against the others, and what must not change
// the mean.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "path_testing.h"
#include "same_bits.h"
#include "sdf_testing.h"

using namespace sundog;
using namespace sundog::paths;

TEST_CASE(
    "a plane under a rectangle and under a ball has its irradiance in closed form, by each way of finding "
    "light") {
  const double a = 0.6, b = 0.35, h = 0.8, albedo = 0.6;
  const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  const double rectangle = 4 / (2 * pi) * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
  const double ball = 0.3 * 0.3 / (1.1 * 1.1);
  on_picture_devices([&](const DeviceInfo& device) {
    for (const bool visible : {true, false})
      for (const u32 strategy : {STRATEGY_MIS, STRATEGY_LIGHTS, STRATEGY_SURFACES}) {
        if (!visible && strategy == STRATEGY_SURFACES) continue;  // then rays cannot meet them
        SceneDescription scene = path_scene({0, 0.6, 3}, {0, 0, 0}, strategy == STRATEGY_SURFACES ? 128 : 32);
        scene.render.light_strategy = strategy;
        scenes::place(scene, PlaneShape{}, add_matte(scene, albedo));
        scene.lights.push_back(lamp(LightType::rectangle, {0, h, 0}, 2));
        scene.lights.back().size = {2 * a, 2 * b};
        scene.lights.push_back(lamp(LightType::sphere, {0, 0, 0}, 3));
        scene.lights.back().radius = 0.3;
        scene.lights.back().position = {1.1 * std::sin(1.2), 1.1 * std::cos(1.2), 0};
        for (LightDescription& light : scene.lights) light.hidden = !visible;
        INFO("strategy " << strategy << (visible ? ", lamps are met" : ""));
        if (visible) add_lamps(scene);
        check_mean(mean_on(device, scene), albedo * (2 * rectangle + 3 * ball * std::cos(1.2)));
      }
  });
}

TEST_CASE("fog dims what is seen through it, but not the light on surfaces, by each way of finding that") {
  const double a = 0.6, h = 0.8, albedo = 0.6, density = 0.4, x = a / h, r = std::sqrt(1 + x * x);
  const double share = 4 / pi * x / r * std::atan(x / r);  // of the plane's light that the lamp's place gives
  on_picture_devices([&](const DeviceInfo& device) {
    for (const u32 strategy : {STRATEGY_MIS, STRATEGY_LIGHTS, STRATEGY_SURFACES}) {
      SceneDescription scene = path_scene({0, 0.6, 3}, {0, 0, 0}, strategy == STRATEGY_SURFACES ? 128 : 32);
      scene.render.light_strategy = strategy;
      scene.fog.color = dvec3(0);
      scene.fog.density = density;
      scene.environment.type = EnvironmentType::gradient;
      scene.environment.bottom = scene.environment.top = dvec3(0.5);
      scenes::place(scene, PlaneShape{}, add_matte(scene, albedo));
      scene.lights.push_back(lamp(LightType::rectangle, {0, h, 0}, 2));
      scene.lights.back().size = {2 * a, 2 * a};
      scene.lights.back().hidden = false;
      add_lamps(scene);
      INFO("strategy " << strategy);
      check_mean(mean_on(device, scene),
                 std::exp(-density * std::hypot(0.6, 3)) * albedo * (2 * share + 0.5 * (1 - share)));
    }
  });
}

TEST_CASE("in a white furnace white things are white for paths too, whether the furnace is chosen or met") {
  const auto white = [](SceneDescription& scene) { return add_matte(scene, 1); };
  const auto grey = [](SceneDescription& scene) { return add_matte(scene, 0.5); };
  const auto metal = [](SceneDescription& scene) {
    const int mirror = scenes::add_mirror(scene, 1);
    scene.materials.back().roughness = 0.7;
    return mirror;
  };
  const auto glass = [](SceneDescription& scene) { return scenes::add_dielectric(scene, 1.5); };
  on_picture_devices([&](const DeviceInfo& device) {
    for (const bool chosen : {false, true}) {
      const auto seen = [&](auto material) {
        SceneDescription scene = path_scene({0, 0, 4}, {0.3, 0.2, 0});
        if (chosen) {
          scene.environment.type = EnvironmentType::gradient;
          scene.environment.bottom = scene.environment.top = dvec3(1);
        } else {
          scene.image.background_bottom = scene.image.background_top = dvec3(1);
        }
        // One set of kernels for all: what is not seen has every kind of material.
        scenes::place(scene, SphereShape{0.1}, metal(scene), glm::translate(glm::dmat4(1), {0, 0, 50}));
        scenes::place(scene, SphereShape{0.1}, glass(scene), glm::translate(glm::dmat4(1), {0, 0, 60}));
        scenes::place(scene, SphereShape{1}, material(scene));
        return mean_on(device, scene);
      };
      INFO((chosen ? "chosen" : "met"));
      check_mean(seen(white), 1);
      check_mean(seen(grey), 0.5);
      check_mean(seen(glass), 1);
      CHECK(seen(metal).value.x == Approx(1).epsilon(0.012));
    }
  });
}

TEST_CASE("a closed room that shines has the sum of all its reflections, with and without roulette") {
  const double albedo = 0.7, shine = 0.3;
  on_picture_devices([&](const DeviceInfo& device) {
    for (const int roulette : {1, 5, 65}) {
      SceneDescription scene = path_scene({0.2, -0.1, 0.3}, {0.9, 0.4, -0.2}, 32);
      scene.render.roulette = roulette;
      const int wall = add_matte(scene, albedo);
      scene.materials.back().emission = dvec3(shine);
      const int room = add_room(scene);
      scenes::place(scene, MeshShape{room}, wall);
      INFO("roulette from ray " << roulette);
      check_mean(mean_on(device, scene), shine / (1 - albedo));
    }
    // Cut off at a depth: so many terms of the sum.
    SceneDescription scene = path_scene({0.2, -0.1, 0.3}, {0.9, 0.4, -0.2}, 16);
    scene.render.max_depth = 3;
    const int wall = add_matte(scene, albedo);
    scene.materials.back().emission = dvec3(shine);
    const int room = add_room(scene);
    scenes::place(scene, MeshShape{room}, wall);
    check_mean(mean_on(device, scene), shine * (1 + albedo + albedo * albedo + albedo * albedo * albedo));
  });
}

TEST_CASE("what surfaces scatter sees texels as fine as the pixels do") {
  const double albedo = 0.7, shine = 0.3;
  // Half of the picture shines: the room's coordinates end five texels before the dark half.
  StoredImage halves;
  halves.width = halves.height = 256;
  halves.channels = 1;
  for (int i = 0; i < halves.width * halves.height; ++i)
    halves.data.push_back(i % halves.width < halves.width / 2 ? 255 : 0);
  SceneDescription scene = path_scene({0.2, -0.1, 0.3}, {0.9, 0.4, -0.2}, 32);
  const int wall = add_matte(scene, albedo);
  scene.materials.back().emission = dvec3(shine);
  scene.materials.back().textures.emission = 0;
  scene.images.emplace_back().pixels = std::move(halves);
  scene.images.back().srgb = false;
  scene.textures.emplace_back().kind = TEXTURE_IMAGE;
  scene.textures.back().image = 0;
  const int room = add_room(scene);
  for (const glm::vec3 p : scene.meshes.back().positions)
    scene.meshes.back().uvs.push_back(
        {0.25f + 0.23f * (p.x + p.y + p.z) / 3, 0.5f + 0.4f * (p.x - p.y + p.z / 2) / 2.5f});
  scenes::place(scene, MeshShape{room}, wall);
  on_picture_devices(
      [&](const DeviceInfo& device) { check_mean(mean_on(device, scene), shine / (1 - albedo)); });
}

TEST_CASE("work-groups that fill none of a device's vectors end their paths") {
  on_every_device([&](const DeviceInfo& device) {
    if (is_quick(device)) return;  // many pixels a work-item: invariance has its groups
    SceneDescription scene = path_scene({0.2, -0.1, 0.3}, {0.9, 0.4, -0.2}, 2);
    scene.image.width = 9, scene.image.height = 6;
    const int wall = add_matte(scene, 0.7);
    scene.materials.back().emission = dvec3(0.3);
    const int room = add_room(scene);
    scenes::place(scene, MeshShape{room}, wall);
    const auto drawn = [&](std::size_t group) {
      RenderOptions options;
      options.work_group = {WorkGroup::Kind::fixed, group, 1};
      return scenes::render_on(device, scene, options);
    };
    const RenderResult whole = drawn(8);
    for (const std::size_t group : {1u, 3u}) {
      const RenderResult made = drawn(group);
      CHECK(same_bits(made.image, whole.image));
      CHECK(made.devices.front().notes.empty());
      CHECK(made.devices.front().failures == 0);
    }
  });
}

TEST_CASE("light from within nested media is absorbed by each, and loses radiance to lower indices") {
  const double radiance = 5, r = 0.05;
  const auto nested = [&](double index, const dvec3& from, const dvec3& at) {
    SceneDescription scene = path_scene(from, at);
    scene.lights.push_back(lamp(LightType::sphere, {0, 0, 0}, radiance));
    scene.lights.back().radius = r;
    scene.lights.back().hidden = false;
    add_lamps(scene);
    scenes::place(scene, SphereShape{2}, scenes::add_dielectric(scene, 1, {0.3, 0.1, 0}, 1));
    scenes::place(scene, SphereShape{1}, scenes::add_dielectric(scene, index, {0.5, 0, 0.2}, 2));
    scenes::place(scene, PlaneShape{}, add_matte(scene, 0.5), glm::translate(glm::dmat4(1), {0, -3, 0}));
    return scene;
  };
  on_picture_devices([&](const DeviceInfo& device) {
    const double kept = std::exp(-0.5 * (1 - r) - 0.3);
    check_mean(mean_on(device, nested(1, {0, 0, 9}, {0, 0, 0})), radiance * kept);
    const double n = 1.5, through = 4 * n / ((n + 1) * (n + 1));
    check_mean(mean_on(device, nested(n, {0, 0, 9}, {0, 0, 0})), radiance * kept * through / (n * n));
    // On the plane below, as chosen, as met, and as both find it.
    const double from_lamp = 0.5 * radiance * (r * r) / 9;
    for (const u32 strategy : {STRATEGY_MIS, STRATEGY_LIGHTS}) {
      SceneDescription scene = nested(1, {0, 0, 9}, {0, -3, 0});
      scene.render.light_strategy = strategy;
      // Nothing of the plane is thrown back by the media, whose indices are alike.
      // The mean depth of the lamp's disk is two thirds of its radius.
      check_mean(mean_on(device, scene), from_lamp * std::exp(-0.5 * (1 - r * 2 / 3) - 0.3));
    }
  });
}

TEST_CASE("paths choose among lamps, points, suns and an environment, and add up all of them") {
  const double albedo = 0.8;
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = path_scene({0, 0.6, 3}, {0, 0, 0}, 64);
    scenes::place(scene, PlaneShape{}, add_matte(scene, albedo));
    scene.environment.type = EnvironmentType::gradient;
    scene.environment.bottom = scene.environment.top = dvec3(0.25);
    double expected = 0.25;
    LightDescription point = lamp(LightType::point, {0, 1, 0}, 0.5);
    scene.lights.push_back(point);
    expected += 0.5;
    LightDescription sun = lamp(LightType::directional, {0, 0, 0}, 0.4);
    sun.direction = {0, -1, 0};
    sun.angle = 4;
    scene.lights.push_back(sun);
    expected += 0.4;
    for (const double angle : {0.4, 0.9}) {  // chosen by the tree
      scene.lights.push_back(lamp(LightType::sphere, {2 * std::sin(angle), 2 * std::cos(angle), 0}, 4));
      scene.lights.back().radius = 0.2;
      scene.lights.back().hidden = false;
      expected += 0.01 * std::cos(angle) * (4 - 0.25);  // in front of the environment
    }
    add_lamps(scene);
    check_mean(mean_on(device, scene), albedo * expected);
  });
}

TEST_CASE("a mesh that shines lights a plane as the rectangle of its shape does, with either integrator") {
  const double a = 0.6, b = 0.35, h = 0.8, albedo = 0.6;
  const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  const double seen = 4 / (2 * pi) * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
  on_picture_devices([&](const DeviceInfo& device) {
    for (const char* integrator : {"path", "whitted"})
      for (const double mirrored : {1.0, -1.0}) {
        SceneDescription scene = path_scene({0, 0.6, 3}, {0, 0, 0});
        scene.render.integrator = integrator;
        scene.render.max_depth = 2;
        scenes::place(scene, PlaneShape{}, add_matte(scene, albedo));
        Mesh mesh;  // two triangles that face downwards, and one that is nothing
        mesh.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 1, 2}};
        mesh.source_vertex_count = 4;
        scene.meshes.push_back(mesh);
        const int shine = add_matte(scene, 0);
        scene.materials.back().emission = dvec3(2);
        const dvec3 size(a * mirrored, 1, b);
        scenes::place(scene, MeshShape{0}, shine, glm::scale(glm::translate(glm::dmat4(1), {0, h, 0}), size));
        INFO(integrator << ", " << mirrored);
        check_mean(mean_on(device, scene), albedo * 2 * seen);
      }
  });
}

TEST_CASE("a large lamp that is chosen or met is weighed by how often each finds it") {
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = path_scene({3, 0.3, 0}, {0, 0, 0}, 64);
    scenes::place(scene, PlaneShape{}, add_matte(scene, 0.8));
    scene.lights.push_back(lamp(LightType::sphere, {0, 1.5, 0}, 2));
    scene.lights.back().radius = 1.2;
    scene.lights.back().hidden = false;
    scene.lights.push_back(lamp(LightType::point, {5, 0.5, 0}, 1));
    add_lamps(scene);
    const double of_lamp = 2 * (1.2 * 1.2) / (1.5 * 1.5), of_point = 0.5 / std::hypot(5, 0.5);
    check_mean(mean_on(device, scene), 0.8 * (of_lamp + of_point));
  });
}
