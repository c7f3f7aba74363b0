// Media that scatter: furnaces, light that is scattered once by quadrature, and each way of finding light
// against the others.
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "path_testing.h"

using namespace sundog;
using namespace sundog::paths;

namespace {

double phase(double g, double cosine) {
  return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// The middle of `count` even parts of [0, length], summed.
double integral(double length, const std::function<double(double)>& f) {
  constexpr int count = 20000;
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += f((i + 0.5) * length / count);
  return sum * length / count;
}

/// A small mesh far from all that is seen: with it a scene has the kernels of the closed room.
void place_far_mesh(SceneDescription& scene) {
  scenes::place(scene, MeshShape{add_room(scene)}, add_matte(scene, 0),
                glm::scale(glm::translate(glm::dmat4(1), {0, 0, -1000}), dvec3(0.01)));
}

}  // namespace

TEST_CASE("a closed room that shines stays as bright in a white medium, and darkens by what one absorbs") {
  const dvec3 from{0.2, -0.1, 0.3}, at{0.2, -0.1, 1};
  on_picture_devices([&](const DeviceInfo& device) {
    // Lights chosen alone, on walls that may be as near as can be, are too noisy for a mean.
    for (const u32 strategy : {STRATEGY_MIS, STRATEGY_SURFACES}) {
      SceneDescription scene = path_scene(from, at, 32);
      scene.render.light_strategy = strategy;
      scene.render.max_depth = 200;
      const int wall = add_matte(scene, 0);
      scene.materials.back().emission = dvec3(1);
      scene.media.resize(1);
      scene.media[0].scattering = {1.5, 0, 4};  // one colour is only absorbed
      scene.media[0].absorption = {0, 0.6, 0};
      scene.media[0].anisotropy = 0.7;
      // A ball of another such medium lies in the way, of the same index.
      scenes::place(scene, SphereShape{0.1}, scenes::add_dielectric(scene, 1, {0, 0.9, 0}, 1),
                    glm::translate(glm::dmat4(1), {0.2, -0.1, 0.6}));
      scene.media.back().scattering = {8, 0, 2};
      scene.media.back().anisotropy = -0.4;
      const int room = add_room(scene);
      scenes::place(scene, MeshShape{room}, wall);
      const Mean mean = mean_on(device, scene);
      INFO("strategy " << strategy << ": " << mean.value.x << " " << mean.value.y << " " << mean.value.z);
      check_mean(mean, 1);
      CHECK(std::abs(mean.value.y - std::exp(-0.6 * 0.5 - 0.9 * 0.2)) < 0.04);
      CHECK(std::abs(mean.value.z - 1) < 0.04);
    }
  });
}

TEST_CASE("light that fog scatters once towards the camera is what quadrature has, of points and balls") {
  const double sigma_s = 0.4, sigma_a = 0.1, sigma = sigma_s + sigma_a, length = 4, g = 0.5;
  const dvec3 light{0.7, 0, 1.5};
  const auto fog = [&] {
    // A black wall 4 ahead; what lies in the fog scatters once.
    SceneDescription scene = path_scene({0, 0, 0}, {0, 0, 1}, 64);
    scene.fog = {dvec3(sigma_s / sigma), sigma, g};
    scene.render.max_depth = 1;
    scenes::place(scene, BoxShape{{10, 10, 0.1}}, add_matte(scene, 0),
                  glm::translate(glm::dmat4(1), {0, 0, length + 0.1}));
    place_far_mesh(scene);
    return scene;
  };
  const auto scattered = [&](double t, const dvec3& to, double distance) {
    return sigma_s * std::exp(-sigma * (t + distance)) * phase(g, to.z);
  };
  const double r = 0.02;  // a small ball, so far off that it is nearly a point
  const auto lit = [&](double of_point, double of_ball, u32 strategy) {
    SceneDescription scene = fog();
    scene.render.light_strategy = strategy;
    scene.lights.push_back(lamp(LightType::point, light, of_point));
    scene.lights.back().falloff = {0, 0, 1};
    scene.lights.push_back(lamp(LightType::sphere, light, of_ball));
    scene.lights.back().radius = r;
    scene.lights.back().hidden = false;
    add_lamps(scene);
    return scene;
  };
  const dvec3 near{0.3, 0, 3};  // to the ray
  const double from_point = integral(length, [&](double t) {
    const dvec3 way = near - dvec3(0, 0, t);
    const double d = glm::length(way);
    return scattered(t, way / d, d) * 2 * pi / (d * d);
  });
  const double from_ball = integral(length, [&](double t) {
    const dvec3 way = light - dvec3(0, 0, t);
    const double d = glm::length(way);
    return scattered(t, way / d, d - r) * 500 * pi * r * r / (d * d);
  });
  on_picture_devices([&](const DeviceInfo& device) {
    check_mean(mean_on(device, lit(0, 500, STRATEGY_MIS)), from_ball);
    check_mean(mean_on(device, lit(0, 500, STRATEGY_LIGHTS)), from_ball);
  });
  // The ball would shade the point in its middle.
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = lit(2, 0, STRATEGY_MIS);
    scene.lights.front().position = near;
    scene.lights.back().position = {0, 50, 0};
    scene.objects.back().world_from_object = glm::translate(glm::dmat4(1), {0, 50, 0});
    check_mean(mean_on(device, scene), from_point);
  });
}

TEST_CASE("all ways of finding light agree about what a cloud sends back, and so do roulettes") {
  on_picture_devices([&](const DeviceInfo& device) {
    const auto cloud = [&](u32 strategy, int samples) {
      SceneDescription scene = path_scene({0, 0, 5}, {0.2, 0.1, 0}, samples);
      scene.render.light_strategy = strategy;
      scenes::place(scene, SphereShape{1}, scenes::add_dielectric(scene, 1, {0.1, 0, 0}, 1));
      scene.media.back().scattering = {2, 3, 4};
      scene.media.back().anisotropy = 0.8;
      scenes::place(scene, PlaneShape{}, add_matte(scene, 0.5), glm::translate(glm::dmat4(1), {0, -1.5, 0}));
      place_far_mesh(scene);
      scene.lights.push_back(lamp(LightType::sphere, {2, 2, -1}, 10));
      scene.lights.back().radius = 0.8;
      scene.lights.push_back(lamp(LightType::rectangle, {0, 3, 1}, 4));
      scene.lights.back().direction = {0, -1, 0};
      for (LightDescription& light : scene.lights) light.hidden = false;
      add_lamps(scene);
      return scene;
    };
    const Mean both = mean_on(device, cloud(STRATEGY_MIS, 64));
    SceneDescription early = cloud(STRATEGY_MIS, 64);
    early.render.roulette = 2;
    const Mean others[] = {mean_on(device, cloud(STRATEGY_LIGHTS, 64)),
                           mean_on(device, cloud(STRATEGY_SURFACES, 256)), mean_on(device, early)};
    for (const Mean& other : others) {
      INFO(both.value.x << " +- " << both.error << ", " << other.value.x << " +- " << other.error);
      CHECK(std::abs(both.value.x - other.value.x) < 3 * std::hypot(both.error, other.error));
    }
  });
}
