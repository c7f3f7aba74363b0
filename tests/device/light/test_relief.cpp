// Bent normals, metalness and roughness from textures, and computed patterns, where closed forms are known.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;

namespace {

ImageDescription pixel(std::vector<std::uint8_t> rgba, bool srgb = false) {
  ImageDescription image;
  image.srgb = srgb;
  image.pixels.width = image.pixels.height = 1;
  image.pixels.data = std::move(rgba);
  return image;
}

/// A plane seen from above under a directional light, with one material.
SceneDescription lit_plane(dvec3 light) {
  SceneDescription scene = scenes::line_of_sight({0.3, 5, 0.2}, {0.3, 0, 0.2}, {0, 0, 1});
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = -light;
  scene.lights.push_back(sun);
  return scene;
}

int add_image(SceneDescription& scene, const ImageDescription& image) {
  TextureDescription texture;
  texture.kind = TEXTURE_IMAGE;
  texture.image = static_cast<int>(scene.images.size());
  scene.images.push_back(image);
  scene.textures.push_back(texture);
  return static_cast<int>(scene.textures.size()) - 1;
}

int add_pattern(SceneDescription& scene, TextureKind kind, double size = 1) {
  TextureDescription texture;
  texture.kind = kind;
  texture.mapping = Mapping::object;
  texture.placement = glm::scale(glm::dmat4(1), dvec3(1 / size));
  scene.textures.push_back(texture);
  return static_cast<int>(scene.textures.size()) - 1;
}

/// What the plane gives of itself at (x, z), where the pattern is its emission.
double pattern_at(const DeviceInfo& info, SceneDescription scene, double x, double z, double height) {
  scene.camera.position = {x, height, z};
  scene.camera.target = {x, 0, z};
  return scenes::pixel_on(info, scene).x;
}

SceneDescription glowing_plane() {
  SceneDescription scene = lit_plane({0, 1, 0});
  scene.lights.clear();
  scene.materials[0].ambient = scene.materials[0].diffuse = dvec3(0);
  scene.materials[0].emission = dvec3(1);
  return scene;
}

}  // namespace

TEST_CASE("a normal map bends the normal along u and v of the surface") {
  const dvec3 light = glm::normalize(dvec3(0.3, 1, -0.2));
  SceneDescription scene = lit_plane(light);
  // On a plane u goes along x and v along z: the map's normal (0.4, -0.2, z).
  const auto byte = [](double v) { return static_cast<std::uint8_t>(std::lround(255 * (0.5 + 0.5 * v))); };
  scene.materials[0].textures.normal = add_image(scene, pixel({byte(0.4), byte(-0.2), byte(0.9), 255}));
  const auto value = [&](double v) { return byte(v) / 127.5 - 1; };
  const dvec3 n = glm::normalize(dvec3(value(0.4), value(0.9), value(-0.2)));
  on_every_device([&](const DeviceInfo& info) {
    CHECK(scenes::pixel_on(info, scene).x == Approx(glm::dot(n, light)).margin(2e-4));
  });
}

TEST_CASE("bent normals leak no light from behind the surface") {
  const dvec3 light = glm::normalize(dvec3(1, -0.05, 0));  // from just below
  SceneDescription scene = lit_plane(light);
  scene.materials[0].textures.normal = add_image(scene, pixel({255, 128, 128, 255}));
  on_every_device([&](const DeviceInfo& info) { CHECK(scenes::pixel_on(info, scene).x == 0); });
}

TEST_CASE("heights bend the normal by their slope, whatever the object's size") {
  const dvec3 light = glm::normalize(dvec3(-0.4, 1, 0.1));
  for (const double size : {1.0, 3.0}) {
    SceneDescription scene = lit_plane(light);
    scene.objects[0].world_from_object = glm::scale(glm::dmat4(1), dvec3(size));
    scene.materials[0].textures.height = add_pattern(scene, TEXTURE_GRADIENT);  // rises by 1 on a unit of x
    scene.materials[0].bump = 0.5;
    const dvec3 n = glm::normalize(dvec3(-0.5, 1, 0));
    on_every_device([&](const DeviceInfo& info) {
      CHECK(scenes::pixel_on(info, scene).x == Approx(glm::dot(n, light)).margin(1e-3));
    });
  }
}

TEST_CASE("metalness and roughness from a texture are what the same numbers are") {
  const dvec3 light = glm::normalize(dvec3(0.3, 1, 0.4));
  SceneDescription textured = lit_plane(light), plain = textured;
  const double rough = 153 / 255.0, metal = 102 / 255.0, f = 0.04, mirror = metal * (1 - rough) * (1 - rough);
  const dvec3 base{0.8, 0.5, 0.2};
  MaterialDescription& m = textured.materials[0];
  m.metal_rough = MetalRough{base, 1, 1, f};
  m.textures.metal_rough = add_image(textured, pixel({0, 153, 102, 255}));
  m.blinn = true;
  MaterialDescription& p = plain.materials[0];
  p.diffuse = base * (1 - mirror);
  p.ambient = 0.1 * p.diffuse;
  p.specular = glm::mix(dvec3(f), base, metal);
  p.reflection = base * mirror;
  p.exponent = 2 / std::pow(rough, 4) - 2;
  p.blinn = true;
  on_every_device([&](const DeviceInfo& info) {
    const dvec3 found = scenes::pixel_on(info, textured), wanted = scenes::pixel_on(info, plain);
    for (int c = 0; c < 3; ++c) CHECK(found[c] == Approx(wanted[c]).epsilon(2e-4));
  });
}

TEST_CASE("patterns have their values near by, and their means far away") {
  SceneDescription checker = glowing_plane(), stripes = checker, noise = checker;
  checker.materials[0].textures.emission = add_pattern(checker, TEXTURE_CHECKER, 0.5);
  stripes.materials[0].textures.emission = add_pattern(stripes, TEXTURE_STRIPES, 2);
  stripes.textures[0].parameter[0] = 0.25;
  noise.materials[0].textures.emission = add_pattern(noise, TEXTURE_NOISE, 0.7);
  noise.textures[0].parameter[0] = 4, noise.textures[0].parameter[1] = 0.5,
  noise.textures[0].parameter[2] = 1;
  on_every_device([&](const DeviceInfo& info) {
    CHECK(pattern_at(info, checker, 0.25, 0.25, 1) == Approx(0).margin(1e-6));
    CHECK(pattern_at(info, checker, 0.75, 0.25, 1) == Approx(1).margin(1e-6));
    CHECK(pattern_at(info, checker, 0.75, -0.25, 1) == Approx(0).margin(1e-6));
    CHECK(pattern_at(info, stripes, 1.0, 0, 1) == Approx(0).margin(1e-6));  // the first three quarters of 2
    CHECK(pattern_at(info, stripes, 1.8, 0, 1) == Approx(1).margin(1e-6));
    const double near = pattern_at(info, noise, 0.31, 0.17, 1);
    CHECK(near > 0.05);
    CHECK(near < 0.95);
    CHECK(near != Approx(0.5).margin(1e-3));
    for (SceneDescription* scene : {&checker, &stripes, &noise}) scene->camera.fov = 2;
    CHECK(pattern_at(info, checker, 0.1, 0.2, 4000) == Approx(0.5).margin(0.01));
    CHECK(pattern_at(info, stripes, 0.1, 0.2, 4000) == Approx(0.25).margin(0.01));
    CHECK(pattern_at(info, noise, 0.1, 0.2, 4000) == Approx(0.5).margin(1e-4));
    for (SceneDescription* scene : {&checker, &stripes, &noise}) scene->camera.fov = 1e-3;
  });
}

TEST_CASE("a pattern mixes textures, a ramp colours one, and a product is one") {
  SceneDescription scene = glowing_plane();
  const int stripes = add_pattern(scene, TEXTURE_STRIPES);
  scene.textures[0].parameter[0] = 0.5;
  TextureDescription half;
  half.offset = {0.5, 0.5, 0.5, 1};
  scene.textures.push_back(half);
  const int grey = static_cast<int>(scene.textures.size()) - 1;
  const int mixed = add_pattern(scene, TEXTURE_GRADIENT, 4);
  scene.textures.back().of[0] = grey, scene.textures.back().of[1] = stripes;
  TextureDescription ramp;
  ramp.kind = TEXTURE_RAMP;
  ramp.of[0] = mixed;
  ramp.stops = {{0, {0, 0, 0}}, {0.5, {0.2, 0, 0}}, {1, {1, 0, 0}}};
  scene.textures.push_back(ramp);
  const int colored = static_cast<int>(scene.textures.size()) - 1;
  TextureDescription product;
  product.kind = TEXTURE_PRODUCT;
  product.of[0] = colored, product.of[1] = grey;
  scene.textures.push_back(product);
  const int last = static_cast<int>(scene.textures.size()) - 1;
  const auto of_texture = [&](const DeviceInfo& info, int texture, double x) {
    scene.materials[0].textures.emission = texture;
    return pattern_at(info, scene, x, 0.1, 1);
  };
  on_every_device([&](const DeviceInfo& info) {
    CHECK(of_texture(info, mixed, 1.25) == Approx(0.5 + 1.25 / 4 * (0 - 0.5)).margin(1e-4));
    CHECK(of_texture(info, mixed, 1.75) == Approx(0.5 + 1.75 / 4 * (1 - 0.5)).margin(1e-4));
    const double t = 0.5 + 1.75 / 4 * 0.5, red = 0.2 + (t - 0.5) / 0.5 * 0.8;
    CHECK(of_texture(info, colored, 1.75) == Approx(red).margin(1e-4));
    CHECK(of_texture(info, last, 1.75) == Approx(red / 2).margin(1e-4));
  });
}

TEST_CASE("a surface of one side is not there from behind") {
  SceneDescription scene = glowing_plane();
  scene.materials[0].one_sided = true;
  scene.materials[0].emission = dvec3(0);
  scene.materials[0].ambient = dvec3(1);
  scene.lights.push_back({.type = LightType::ambient});
  scene.image.background_bottom = scene.image.background_top = {0.25, 0.25, 0.25};
  scene.objects.clear();
  scenes::place(scene, DiskShape{1, 0}, 0);
  on_every_device([&](const DeviceInfo& info) {
    CHECK(pattern_at(info, scene, 0, 0, 3) == Approx(1));
    CHECK(pattern_at(info, scene, 0, 0, -3) == Approx(0.25));
  });
}
