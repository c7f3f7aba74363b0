// Rough reflection and transmission: nothing is made of nothing, little is lost, and highlights are as wide
// as the distribution has them.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "devices.h"
#include "scenes.h"
#include "single_albedo.h"

using namespace sundog;
using glm::dvec3;

namespace {

double mean_of(const Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.data.size(); i += 4) sum += double(image.data[i]);
  return 4 * sum / double(image.data.size());
}

/// A ball seen slightly off its middle, 144 times, in a white surrounding.
SceneDescription furnace(int material(SceneDescription&), double roughness, const dvec3& at) {
  SceneDescription scene = scenes::line_of_sight({0, 0, 4}, at);
  scene.image.width = scene.image.height = 12;
  scene.render.samples = 16;
  scene.render.max_depth = 12;
  scene.image.background_bottom = scene.image.background_top = {1, 1, 1};
  scenes::place(scene, SphereShape{1}, material(scene));
  scene.materials.back().roughness = roughness;
  return scene;
}

int white_metal(SceneDescription& scene) { return scenes::add_mirror(scene, 1); }
int glass(SceneDescription& scene) { return scenes::add_dielectric(scene, 1.5); }

}  // namespace

TEST_CASE("in a white furnace rough metal is white at every roughness, as its lost light is given back") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double roughness : {0.2, 0.5, 0.8, 1.0})
      for (const dvec3& at : {dvec3(0.1, 0, 0), dvec3(0.85, 0.2, 0)}) {
        INFO(roughness << " at " << at.x);
        CHECK(mean_of(scenes::render_on(device, furnace(white_metal, roughness, at)).image) ==
              Approx(1).epsilon(0.012));
      }
  });
}

TEST_CASE("in a white furnace rough metal is white where it is partly there, by every integrator") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const char* integrator : {"whitted", "path"})
      for (const double roughness : {0.5, 0.9}) {
        INFO(integrator << " " << roughness);
        SceneDescription scene = furnace(white_metal, roughness, {0.3, 0.1, 0});
        scene.render.integrator = integrator;
        scene.materials.back().opacity = 0.4;
        CHECK(mean_of(scenes::render_on(device, scene).image) == Approx(1).epsilon(0.02));
      }
  });
}

TEST_CASE("in a white furnace rough glass is white at every roughness") {
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
      INFO(roughness);
      CHECK(mean_of(scenes::render_on(device, furnace(glass, roughness, {0.3, 0.1, 0})).image) ==
            Approx(1).epsilon(0.015));
    }
  });
}

TEST_CASE("in a white furnace rough surfaces that scatter once keep what quadrature has") {
  // A floor, and what is below it where it transmits.
  const auto kept = [](const DeviceInfo& device, int material(SceneDescription&), double roughness,
                       double cosine) {
    SceneDescription scene = scenes::line_of_sight({3 * std::sqrt(1 - cosine * cosine), 3 * cosine, 0}, {});
    scene.image.width = scene.image.height = 12;
    scene.render.samples = 16;
    scene.image.background_bottom = scene.image.background_top = {1, 1, 1};
    scenes::place(scene, PlaneShape{}, material(scene));
    scene.materials.back().roughness = roughness;
    scene.materials.back().multiple_scattering = false;
    return mean_of(scenes::render_on(device, scene).image);
  };
  on_picture_devices([&](const DeviceInfo& device) {
    for (const double roughness : {0.5, 1.0})
      for (const double cosine : {0.9, 0.4}) {
        INFO(roughness << " at " << cosine);
        const double alpha = roughness * roughness;
        CHECK(kept(device, white_metal, roughness, cosine) ==
              Approx(light_met_once(cosine, alpha, 0).reflected).epsilon(0.012));
        const OnceLight once = light_met_once(cosine, alpha, 1.5);
        CHECK(kept(device, glass, roughness, cosine) ==
              Approx(once.reflected + once.transmitted).epsilon(0.012));
      }
  });
}

TEST_CASE("a rough floor shows a lamp blurred by its roughness, a smooth one sharp") {
  // A lamp above the far end, the floor seen where a mirror would show it, and beside that.
  const auto seen = [](const DeviceInfo& device, double roughness, double beside) {
    SceneDescription scene = scenes::line_of_sight({0, 1, 3}, {0, 0, beside});
    scene.image.width = scene.image.height = 12;
    scene.render.samples = 32;
    scenes::place(scene, PlaneShape{}, scenes::add_mirror(scene, 1));
    scene.materials.back().roughness = roughness;
    scenes::place(scene, SphereShape{0.3}, scenes::add_glow(scene, {1, 1, 1}),
                  glm::translate(glm::dmat4(1), {0, 1, -3}));
    return mean_of(scenes::render_on(device, scene).image);
  };
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(seen(device, 0, 0) == Approx(1).epsilon(1e-4));
    CHECK(seen(device, 0, 0.8) == 0);
    const double middle = seen(device, 0.4, 0), side = seen(device, 0.4, 0.8);
    CHECK(middle < 0.6);
    CHECK(side > 0.02);
    CHECK(middle > 1.5 * side);
    CHECK(seen(device, 0.05, 0) > 0.95);
  });
}
