// AOVs of light: whatever adds to a path's light adds to one of its parts.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "compile/compiled_scene.h"
#include "light_boards.h"
#include "path_testing.h"
#include "render/film/film.h"
#include "same_bits.h"
#include "scene/load.h"
#include "temporary_folder.h"

using namespace sundog;
using namespace sundog::paths;

namespace {

/// The greatest difference between a pixel's colour and the sum of its parts as they come from the device, of
/// what the parts are together: rounding, if nothing is lost.
float lost_light(const Film& film) {
  float most = 0;
  for (std::size_t i = 0; i < film.sums.size(); ++i) {
    const auto* floats = reinterpret_cast<const float*>(&film.aovs[film.layout.vectors() * i]);
    const float whole[3] = {film.sums[i].x, film.sums[i].y, film.sums[i].z};
    for (std::size_t c = 0; c < 3; ++c) {
      float sum = 0, size = 1e-12f;
      for (std::size_t k = 0; k < light_part_names.size(); ++k) {
        const float part = floats[4 * film.layout.first_light() + 3 * k + c];
        sum += part;
        size += std::abs(part);
      }
      most = std::max(most, std::abs(sum - whole[c]) / size);
    }
  }
  return most;
}

/// Whether the AOVs, added in their order, are the picture.
bool sum_to_picture(const RenderResult& result) {
  Image sum(result.image.width, result.image.height, 3);
  for (const std::string& part : light_part_names)
    for (std::size_t i = 0; i < sum.data.size(); ++i) sum.data[i] += result.aovs.at(part).data[i];
  for (std::size_t i = 0; i < sum.data.size(); ++i)
    if (sum.data[i] != result.image.data[i / 3 * 4 + i % 3]) return false;
  return true;
}

float greatest_difference(const Image& a, const Image& b) {
  float most = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) most = std::max(most, std::abs(a.data[i] - b.data[i]));
  return most;
}

RenderResult render_parts(const DeviceInfo& device, const SceneDescription& scene) {
  RenderOptions options;
  options.aovs = light_part_names;
  return scenes::render_on(device, scene, options);
}

/// The shipped scene by paths.
SceneDescription small(const std::string& name) {
  SceneDescription scene = scenes::shipped_small(name);
  scene.render.integrator = "path";
  return scene;
}

/// A ball of milk in fog that scatters, lit by a lamp that paths may meet.
SceneDescription milk_in_fog() {
  SceneDescription scene = path_scene({0, 2, 6}, {0, 0, 0}, 4);
  scene.camera.fov = 40;
  scene.render.max_depth = 6;
  scene.render.max_component = 0.5;
  scene.image.width = scene.image.height = 24;
  scene.fog = {.color = {0.5, 0.7, 0.9}, .density = 0.05, .anisotropy = 0.5};
  LightDescription light = lamp(LightType::sphere, {0.5, 2, 1}, 20);
  light.radius = 0.4;
  light.hidden = false;
  scene.lights.push_back(light);
  scenes::place(scene, SphereShape{0.8}, scenes::add_dielectric(scene, 1.3, {0.1, 0.2, 0.4}));
  scene.media.back().scattering = dvec3(3);
  scenes::place(scene, PlaneShape{}, add_matte(scene, 0.5), glm::translate(glm::dmat4(1), {0, -1, 0}));
  return scene;
}

/// light_boards.
SceneDescription boards_scene(int samples) {
  const TemporaryFolder folder;
  SceneDescription scene = load_scene(folder.write("boards.json", light_boards));
  scene.render.samples = samples;
  return scene;
}

/// The parts of the pixel that have light.
std::string parts_at(const AovImages& aovs, int x, int y) {
  std::string seen;
  for (const std::string& part : light_part_names)
    if (aovs.at(part).pixel(x, y)[0] > 1e-4f) seen += part + " ";
  return seen;
}

void check_parts(const DeviceInfo& device, const SceneDescription& scene) {
  const RenderResult result = render_parts(device, scene);
  CHECK(lost_light(result.film) < 1e-5f);
  CHECK(sum_to_picture(result));
  const Image alone = scenes::render_on(device, scene).image;
  // Colours of single wavelengths are partly negative.
  if (compile(scene).features.dispersion)
    CHECK(greatest_difference(result.image, alone) < 1e-5f);
  else
    CHECK(same_bits(result.image, alone));
}

}  // namespace

TEST_CASE("the parts of light sum to the picture, which they leave as it is") {
  // Photons and rough glass, wavelengths and guides, a sky with a sun, layers, frosted walls, fields that
  // glow, fog, parallax, cut-outs, lens and motion.
  for (const char* name : {"glass_path", "prism", "ice_path", "materials", "frosted_panes", "mandelbulb",
                           "mandelbox", "relief", "textures", "lens"}) {
    INFO(name);
    const SceneDescription scene = small(name);
    on_picture_devices([&](const DeviceInfo& device) { check_parts(device, scene); });
  }
}

TEST_CASE("the parts of light in media sum to the picture") {
  on_picture_devices([](const DeviceInfo& device) { check_parts(device, milk_in_fog()); });
}

TEST_CASE("light belongs to the lobe that the camera sees, and is direct where nothing else scattered it") {
  on_picture_devices([](const DeviceInfo& device) {
    const AovImages aovs = render_parts(device, boards_scene(64)).aovs;
    CHECK(parts_at(aovs, 5, 12) == "diffuse_direct ");
    CHECK(parts_at(aovs, 9, 12) == "glossy_direct ");
    CHECK(aovs.at("glossy_direct").pixel(9, 12)[0] == Approx(0.9f * 0.2f));
    CHECK(parts_at(aovs, 13, 12) == "emission ");
    CHECK(aovs.at("emission").pixel(13, 12)[1] == Approx(2));
    CHECK(parts_at(aovs, 18, 12) == "diffuse_direct glossy_direct ");
    CHECK(parts_at(aovs, 22, 12) == "diffuse_direct sky ");
    CHECK(aovs.at("sky").pixel(22, 12)[2] == Approx(0.4f).margin(0.1));
    CHECK(parts_at(aovs, 27, 12) == "glossy_direct transmission_indirect ");
    CHECK(parts_at(aovs, 16, 17) == "glossy_direct transmission_direct ");
    CHECK(parts_at(aovs, 16, 5) == "volume_direct volume_indirect sky ");
    CHECK(parts_at(aovs, 3, 3) == "sky ");
  });
}

TEST_CASE("a coloured plastic's gloss is that of a black one") {
  on_picture_devices([](const DeviceInfo& device) {
    SceneDescription scene = boards_scene(16);
    const AovImages red = render_parts(device, scene).aovs;
    MediumDescription inside;
    for (MaterialDescription& material : scene.materials)
      if (material.name == "plastic")
        set_openpbr({.base_color = dvec3(0), .specular_roughness = 0.5}, material, inside);
    const AovImages black = render_parts(device, scene).aovs;
    for (int c = 0; c < 3; ++c) {
      CHECK(red.at("glossy_direct").pixel(18, 12)[c] ==
            Approx(black.at("glossy_direct").pixel(18, 12)[c]).epsilon(0.05));
      CHECK(black.at("diffuse_direct").pixel(18, 12)[c] == 0);
    }
  });
}
