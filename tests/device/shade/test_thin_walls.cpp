// Thin walls: what both faces make of light together, smooth and frosted, by closed forms.
#include <glm/gtc/matrix_transform.hpp>

#include "layer_testing.h"
#include "path_testing.h"
#include "single_albedo.h"

using namespace sundog;
using namespace sundog::lobes;

namespace {

Material thin_wall(double roughness, double index = 1.5) {
  Material wall = rough_glass(roughness);
  wall.flags |= MATERIAL_THIN | MATERIAL_WALL | MATERIAL_FROSTED;
  wall.transmission.w = float(index);
  return wall;
}

/// A frosted material of fixed shares.
Material fixed_wall(double roughness, float reflection, float transmission) {
  Material wall{};
  wall.flags = MATERIAL_REFLECTS | MATERIAL_TRANSMITS | MATERIAL_THIN | MATERIAL_FROSTED;
  wall.reflection = {reflection, reflection, reflection, float(roughness * roughness)};
  wall.transmission = {transmission, transmission, transmission, 0};
  return wall;
}

double reflected_by_both(double cosine, double index) {
  const double r = fresnel_of(cosine, index);
  return 2 * r / (1 + r);
}

/// The mean weights of samples that go to the side z > 0, and to the other.
glm::dvec2 shares_of(const std::vector<Lobe>& drawn) {
  glm::dvec2 sum(0);
  for (const Lobe& one : drawn) (one.wi.z > 0 ? sum.x : sum.y) += one.value.x;
  return sum / double(drawn.size());
}

dvec3 mirrored(const dvec3& d) { return {d.x, d.y, -d.z}; }

constexpr double no_medium = 1;

}  // namespace

TEST_CASE(
    "smooth and nearly smooth thin walls share light as the sum of all reflections between their faces") {
  // The sum itself: out of the second face after 2 k reflections inside.
  for (const double r : {0.04, 0.3}) {
    double back = r, ahead = 0;
    for (int k = 0; k < 60; ++k) {
      ahead += (1 - r) * (1 - r) * std::pow(r, 2 * k);
      back += (1 - r) * (1 - r) * std::pow(r, 2 * k + 1);
    }
    CHECK(back == Approx(2 * r / (1 + r)));
    CHECK(ahead == Approx((1 - r) / (1 + r)));
  }
  on_every_device([](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    for (const double roughness : {0.0, 0.02})
      for (const double index : {1.5, 2.4})
        for (const double cosine : {1.0, 0.5, 0.2}) {
          INFO(roughness << ", " << index << " at " << cosine);
          const double wanted = reflected_by_both(cosine, index);
          for (const double side : {1.0, -1.0}) {
            const dvec3 wo = side * at_cosine(cosine);
            const std::vector<Lobe> drawn = tester.draw(thin_wall(roughness, index), no_medium, wo);
            const glm::dvec2 shares = shares_of(drawn);
            CHECK((side > 0 ? shares.x : shares.y) == Approx(wanted).margin(0.003));
            CHECK((side > 0 ? shares.y : shares.x) == Approx(1 - wanted).margin(0.003));
            if (roughness > 0) continue;
            for (const Lobe& one : drawn) CHECK(one.specular);
          }
        }
    // Tinted once.
    Material tinted = thin_wall(0.02);
    tinted.transmission.x = 0.5f;
    const double through = 1 - reflected_by_both(0.7, 1.5);
    CHECK(shares_of(tester.draw(tinted, no_medium, at_cosine(0.7))).y == Approx(0.5 * through).margin(0.003));
  });
}

TEST_CASE("white frosted walls return all light and no more at every roughness, from both sides") {
  on_every_device([](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    for (const double roughness : {0.03, 0.1, 0.3, 0.6, 1.0})
      for (const double cosine : {1.0, 0.5, 0.1, -0.7}) {
        INFO(roughness << " at " << cosine);
        const dvec3 wo = cosine > 0 ? at_cosine(cosine) : -at_cosine(-cosine);
        for (const Material& wall : {thin_wall(roughness), fixed_wall(roughness, 0.2f, 0.8f)}) {
          const double mean = mean_weight(tester.draw(wall, no_medium, wo));
          CHECK(mean < 1.004);
          CHECK(mean > 0.985);
        }
        const double grey = mean_weight(tester.draw(fixed_wall(roughness, 0.1f, 0.4f), no_medium, wo));
        CHECK(grey < 0.503);
        CHECK(grey > 0.3);
      }
  });
}

TEST_CASE("a frosted wall of equal shares sends the same light to both sides, mirrored") {
  const dvec3 o = at_cosine(0.6);
  on_every_device([&](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    for (const double roughness : {0.3, 0.8})
      for (const dvec3& wi : {on_sphere(0.6, 0), on_sphere(0.4, 0.1), on_sphere(0.9, 0.6)}) {
        const auto both = tester.look(fixed_wall(roughness, 0.5f, 0.5f), no_medium, o, {wi, mirrored(wi)});
        CHECK(both[0].value.x > 0);
        CHECK(both[1].value.x == Approx(both[0].value.x).epsilon(1e-4));
        CHECK(both[1].density == Approx(both[0].density).epsilon(1e-4));
      }
  });
}

TEST_CASE("the lobes of a frosted wall that scatters once are the distribution times masking and shares") {
  const double alpha = 0.2, cosine = 0.7, index = 1.6;
  const dvec3 o = at_cosine(cosine);
  on_every_device([&](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    Material wall = thin_wall(std::sqrt(alpha), index);
    wall.flags |= MATERIAL_SCATTERS_ONCE;
    for (const dvec3& wi : {on_sphere(0.7, 0), on_sphere(0.5, 0.02), on_sphere(0.9, 0.9)}) {
      const dvec3 h = glm::normalize(o + wi);
      const double width = h.z * h.z * (alpha * alpha - 1) + 1, facing = glm::dot(o, h);
      const double distribution = alpha * alpha / (pi * width * width);
      const double masking = 1 / (1 + smith_of(cosine, alpha) + smith_of(wi.z, alpha));
      const double all = pi * distribution * masking / (4 * cosine), r = reflected_by_both(facing, index);
      const auto found = tester.look(wall, no_medium, o, {wi, mirrored(wi)});
      CHECK(found[0].value.x == Approx(r * all).epsilon(2e-3));
      CHECK(found[1].value.x == Approx((1 - r) * all).epsilon(1e-3));
    }
    for (const double roughness : {0.5, 1.0})
      CHECK(mean_weight(tester.draw(
                [&] {
                  Material once = thin_wall(roughness);
                  once.flags |= MATERIAL_SCATTERS_ONCE;
                  return once;
                }(),
                no_medium, at_cosine(0.6), 4 * count)) ==
            Approx(light_met_once(0.6, roughness * roughness, 0).reflected).epsilon(0.004));
  });
}

TEST_CASE("samples of frosted walls lie as their density has it, and light takes the same way back") {
  Material matte = thin_wall(0.7);
  matte.diffuse = {0.4f, 0.4f, 0.4f, 0};
  const dvec3 o = at_cosine(0.8), above = on_sphere(0.35, 0.1), below = on_sphere(-0.6, 0.05);
  on_every_device([&](const DeviceInfo& info) {
    Tester& tester = tester_on(info);
    CHECK(chi_squared(tester, thin_wall(0.7), no_medium, at_cosine(0.7)) < 1.5);
    CHECK(chi_squared(tester, thin_wall(0.9), no_medium, -at_cosine(0.4)) < 1.5);
    CHECK(chi_squared(tester, fixed_wall(0.8, 0.4f, 0.5f), no_medium, at_cosine(0.5)) < 1.5);
    CHECK(chi_squared(tester, matte, no_medium, at_cosine(0.6)) < 1.5);
    const auto value = [&](const Material& material, const dvec3& wo, const dvec3& wi) {
      return tester.look(material, no_medium, wo, {wi})[0].value.x / std::abs(wi.z);
    };
    for (const double roughness : {0.4, 0.7, 1.0}) {
      const Material wall = thin_wall(roughness);
      CHECK(value(wall, o, above) == Approx(value(wall, above, o)).epsilon(1e-3));
      CHECK(value(wall, o, below) > 0);
      CHECK(value(wall, o, below) == Approx(value(wall, below, o)).epsilon(1e-3));
    }
  });
}

TEST_CASE("layers over a frosted wall stand on both of its sides") {
  OpenPbr values{.specular_roughness = 0.5, .transmission_weight = 1};
  values.geometry_thin_walled = true;
  values.coat_weight = 0.8, values.coat_roughness = 0.3, values.coat_color = {0.9, 0.6, 0.5};
  values.fuzz_weight = 0.5, values.transmission_color = {0.9, 0.8, 0.7};
  OpenPbr white = values;
  white.coat_color = white.transmission_color = dvec3(1), white.coat_darkening = 0;
  const dvec3 o = at_cosine(0.8), below = on_sphere(-0.6, 0.05);
  Tester& tester = tester_on(picture_devices().front(), true);
  tester.set_layers(values);
  const Layered made = layered(values);
  REQUIRE((made.material.flags & MATERIAL_WALL) != 0);
  CHECK(chi_squared(tester, made.material, no_medium, at_cosine(0.7)) < 1.5);
  CHECK(chi_squared(tester, made.material, no_medium, -at_cosine(0.5)) < 1.5);
  const auto value = [&](const dvec3& wo, const dvec3& wi) {
    return tester.look(made.material, no_medium, wo, {wi})[0].value.x / std::abs(wi.z);
  };
  CHECK(value(o, below) > 0);
  CHECK(value(o, below) == Approx(value(below, o)).epsilon(1e-3));
  CHECK(value(o, below) == Approx(value(mirrored(o), mirrored(below))).epsilon(1e-3));
  tester.set_layers(white);
  for (const double cosine : {1.0, 0.5, 0.2}) {
    INFO(cosine);
    const double mean =
        mean_weight(tester.draw(layered(white).material, no_medium, at_cosine(cosine), 4 * count));
    CHECK(mean < 1.005);
    CHECK(mean > 0.93);
  }
}

TEST_CASE("a white wall that is frosted in part, and else metal or matte, returns all light and no more") {
  Tester& tester = tester_on(picture_devices().front(), true);
  for (const double metalness : {0.0, 0.5})
    for (const double roughness : {0.3, 0.6, 1.0}) {
      OpenPbr values{.base_color = dvec3(1), .base_metalness = metalness, .specular_roughness = roughness};
      values.transmission_weight = 0.5, values.geometry_thin_walled = true;
      tester.set_layers(values);
      for (const double cosine : {1.0, 0.5, 0.2}) {
        INFO(metalness << " metal of roughness " << roughness << " at " << cosine);
        const double mean =
            mean_weight(tester.draw(layered(values).material, no_medium, at_cosine(cosine), 4 * count));
        CHECK(mean < 1.01);
        CHECK(mean > 0.98);
      }
    }
}

namespace {

using sundog::paths::add_matte, sundog::paths::check_mean, sundog::paths::lamp, sundog::paths::mean_on,
    sundog::paths::Mean, sundog::paths::path_scene;

glm::dmat4 at_height(double y) { return glm::translate(glm::dmat4(1), {0, y, 0}); }

int add_wall(SceneDescription& scene, double roughness, double index = 1.5) {
  MaterialDescription wall;
  wall.type = MaterialType::dielectric;
  wall.ambient = wall.diffuse = dvec3(0);
  wall.reflection = wall.transmission = dvec3(1);
  wall.wall_ior = index;
  wall.roughness = roughness;
  scene.materials.push_back(wall);
  return int(scene.materials.size()) - 1;
}

/// A floor of the albedo 1/2 below a wall without end, and a sky of radiance 1; the camera is between.
SceneDescription below_wall(double roughness, u32 strategy) {
  SceneDescription scene = path_scene({0, 0.5, 0.4}, {0, 0, 0}, 64);
  scene.render.light_strategy = strategy;
  scene.environment.type = EnvironmentType::gradient;
  scene.environment.bottom = scene.environment.top = dvec3(1);
  scenes::place(scene, PlaneShape{}, add_matte(scene, 0.5));
  scenes::place(scene, PlaneShape{}, add_wall(scene, roughness), at_height(1));
  return scene;
}

/// The floor's radiance: of what the wall lets in, and gives back, of light from all around.
double lit_floor(double albedo, double returned) { return albedo * (1 - returned) / (1 - albedo * returned); }

}  // namespace

TEST_CASE(
    "a floor under a sky behind a thin wall has the light of all reflections, by each way of finding it") {
  double returned = 0;
  constexpr int steps = 1000;
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    returned += 2 * cosine * reflected_by_both(cosine, 1.5) / steps;
  }
  on_picture_devices([&](const DeviceInfo& device) {
    for (const u32 strategy : {STRATEGY_MIS, STRATEGY_LIGHTS, STRATEGY_SURFACES}) {
      INFO("strategy " << strategy);
      for (const double roughness : {0.0, 0.1})
        if (roughness == 0 || strategy != STRATEGY_LIGHTS)
          check_mean(mean_on(device, below_wall(roughness, strategy)), lit_floor(0.5, returned));
      SceneDescription fixed = below_wall(0.7, strategy);
      MaterialDescription& wall = fixed.materials.back();
      wall.type = MaterialType::phong;
      wall.wall_ior = 0;
      wall.reflection = dvec3(0.3), wall.transmission = dvec3(0.7);
      const Mean found = mean_on(device, fixed);
      INFO(found.value.x << " +- " << found.error);
      CHECK(found.value.x == Approx(lit_floor(0.5, 0.3)).epsilon(0.006).margin(3 * found.error));
    }
  });
}

TEST_CASE(
    "a ball of frosted wall that transmits all returns no more than it gets, beside what shadow rays pass") {
  for (const bool beside : {false, true}) {
    SceneDescription scene = path_scene({0, 0, 5}, {0, 0, 0}, 128);
    scene.environment.type = EnvironmentType::gradient;
    scene.environment.bottom = scene.environment.top = dvec3(1);
    scenes::place(scene, SphereShape{}, add_wall(scene, 1));
    MaterialDescription& frosted = scene.materials.back();
    frosted.type = MaterialType::phong;
    frosted.wall_ior = 0;
    frosted.reflection = dvec3(0);
    if (beside) scenes::place(scene, SphereShape{}, add_wall(scene, 0), at_height(50));
    const Mean found = mean_on(picture_devices().front(), scene);
    INFO((beside ? "beside another, " : "alone, ") << found.value.x << " +- " << found.error);
    CHECK(found.value.x == Approx(0.996).margin(0.004));
  }
}

TEST_CASE("what fuzz and a coat take from light behind a smooth wall, each way of finding it knows") {
  OpenPbr values{.specular_roughness = 0, .transmission_weight = 1};
  values.geometry_thin_walled = true;
  values.coat_weight = 1, values.coat_color = {0.7, 0.8, 0.9}, values.coat_roughness = 0.2;
  values.fuzz_weight = 0.6;
  Mean means[2];
  for (const u32 strategy : {STRATEGY_LIGHTS, STRATEGY_SURFACES}) {
    SceneDescription scene = below_wall(0, strategy);
    scene.render.samples = 512;
    scene.render.max_depth = 6;
    MediumDescription inside;
    set_openpbr(values, scene.materials.back(), inside);
    means[strategy == STRATEGY_LIGHTS ? 0 : 1] = mean_on(picture_devices().front(), scene);
  }
  const auto [lights, surfaces] = means;
  INFO(lights.value.x << " +- " << lights.error << ", " << surfaces.value.x << " +- " << surfaces.error);
  const double error = std::hypot(lights.error, surfaces.error);
  CHECK(lights.error < 0.01);
  for (int channel = 0; channel < 3; ++channel)
    CHECK(lights.value[channel] == Approx(surfaces.value[channel]).epsilon(0).margin(3.5 * error));
}

TEST_CASE("where a surface is not there, its layers are not: paths see what lies behind as it is") {
  const auto seen = [](double opacity, bool one_sided) {
    OpenPbr values{.base_color = dvec3(0)};
    values.coat_weight = 1, values.coat_color = {0.5, 0.1, 0.1}, values.fuzz_weight = 0.6;
    values.geometry_opacity = opacity;
    SceneDescription scene = path_scene({0, -1, 0.4}, {0, 0, 0}, 16);
    scene.environment.type = EnvironmentType::gradient;
    scene.environment.bottom = scene.environment.top = dvec3(1);
    scenes::place(scene, PlaneShape{}, add_matte(scene, 0));
    MediumDescription inside;
    set_openpbr(values, scene.materials.back(), inside);
    scene.materials.back().one_sided = one_sided;
    return mean_on(picture_devices().front(), scene).value;
  };
  for (int channel = 0; channel < 3; ++channel) {
    CHECK(seen(0, false)[channel] == Approx(1).epsilon(1e-5));
    CHECK(seen(1, true)[channel] == Approx(1).epsilon(1e-5));
  }
}

TEST_CASE("light of a lamp goes straight through smooth thin walls, and stops at frosted ones for paths") {
  const auto seen = [](const DeviceInfo& device, double roughness, const char* integrator, double height) {
    SceneDescription scene = path_scene({0, 0.5, 0.4}, {0, 0, 0}, 1);
    scene.render.integrator = integrator;
    scene.render.max_depth = 1;
    scene.lights.push_back(lamp(LightType::directional, {0, 0, 0}, 1));
    scene.lights.back().direction = {-std::sqrt(0.75), -0.5, 0};
    scenes::place(scene, PlaneShape{}, add_matte(scene, 1));
    scenes::place(scene, PlaneShape{}, add_wall(scene, roughness), at_height(height));
    return mean_on(device, scene).value.x;
  };
  const double through = 1 - reflected_by_both(0.5, 1.5);
  on_picture_devices([&](const DeviceInfo& device) {
    for (const char* integrator : {"path", "whitted"}) {
      const double open = seen(device, 0, integrator, -1);
      CHECK(open > 0);
      CHECK(seen(device, 0, integrator, 1) == Approx(through * open).epsilon(1e-4));
    }
    CHECK(seen(device, 0.5, "path", 1) == 0);
    CHECK(seen(device, 0.5, "whitted", 1) == Approx(through * seen(device, 0, "whitted", -1)).epsilon(1e-4));
  });
}

TEST_CASE("whitted's shadow of a thin wall with a clear coat lacks what the coat reflects, too") {
  on_picture_devices([](const DeviceInfo& device) {
    const auto seen = [&](double height) {
      SceneDescription scene = path_scene({0, 0.5, 0.4}, {0, 0, 0}, 1);
      scene.render.integrator = "whitted";
      scene.lights.push_back(lamp(LightType::directional, {0, 0, 0}, 1));
      scene.lights.back().direction = {0, -1, 0};
      scenes::place(scene, PlaneShape{}, add_matte(scene, 1));
      scenes::place(scene, PlaneShape{}, add_wall(scene, 0), at_height(height));
      OpenPbr values{.specular_roughness = 0, .transmission_weight = 1, .coat_weight = 1};
      values.geometry_thin_walled = true;
      MediumDescription inside;
      set_openpbr(values, scene.materials.back(), inside);
      return mean_on(device, scene).value.x;
    };
    const double by_coat = 1 - std::pow((1.6 - 1) / (1.6 + 1), 2);
    CHECK(seen(1) == Approx(by_coat * (1 - reflected_by_both(1, 1.5)) * seen(-1)).epsilon(1e-3));
  });
}

TEST_CASE(
    "a frosted wall is no way into a medium: in a ball that absorbs, the light of both sides stays "
    "absorbed") {
  on_picture_devices([](const DeviceInfo& device) {
    SceneDescription scene = path_scene({0, 0, 0.5}, {0, 0, -4}, 16);
    scene.image.background_bottom = scene.image.background_top = dvec3(1);
    scenes::place(scene, SphereShape{2}, scenes::add_dielectric(scene, 1, dvec3(0.3)));
    scenes::place(scene, RectangleShape{}, add_wall(scene, 0.011),
                  glm::rotate(glm::dmat4(1), pi / 2, dvec3(1, 0, 0)));
    // 0.5 to the wall, and 2 from there on, whether light is reflected or not.
    check_mean(mean_on(device, scene), std::exp(-0.3 * 2.5));
  });
}
