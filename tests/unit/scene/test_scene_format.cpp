// The SceneDescription holds the values of the scene file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "catch.h"
#include "scene_text.h"

using namespace sundog;

namespace {

void check_close(const dvec3& found, const dvec3& wanted) {
  INFO(found.x << " " << found.y << " " << found.z);
  CHECK(glm::length(found - wanted) < 1e-12);
}

MaterialDescription material(std::string_view text) {
  return load_scene_text(
             scene_with(R"("media": {"ice": {"ior": 1.31}}, "materials": {"m": )" + std::string(text) + "}"))
      .materials.at(0);
}

LightDescription light(std::string_view text) {
  return load_scene_text(scene_with(R"("lights": [)" + std::string(text) + "]")).lights.at(0);
}

}  // namespace

TEST_CASE("a scene of one sphere gets every default") {
  const SceneDescription scene = load_scene_text(scene_with(""));
  CHECK(scene.file.filename() == "scene.json");
  CHECK(scene.camera.fov == 45);
  CHECK(scene.camera.near == 0);
  CHECK(std::isinf(scene.camera.far));
  CHECK(scene.image.width == 640);
  CHECK(scene.image.height == 480);
  CHECK(scene.render.max_depth == 8);
  CHECK(scene.render.samples == 1);
  CHECK(scene.render.tracer == Tracer::automatic);
  CHECK(scene.lights.empty());
  REQUIRE(scene.media.size() == 1);
  CHECK(scene.media[0].ior == 1);
  CHECK(scene.media[0].priority == world_priority);
  REQUIRE(scene.objects.size() == 1);
  CHECK(scene.objects[0].place == "/objects/0");
  CHECK(scene.objects[0].world_from_object == dmat4(1));
  CHECK(scene.warnings.empty());
}

TEST_CASE("comments and a byte order mark are read over") {
  CHECK(load_scene_text("\xEF\xBB\xBF{ // objects\n \"objects\": [ /* none */ ] }").objects.empty());
}

TEST_CASE("camera, image and render settings are read") {
  const SceneDescription scene = load_scene_text(scene_with(R"(
    "camera": {"position": [1, 2, 3], "target": [4, 5, 6], "up": [0, 0, 2], "fov": 30.5, "near": 0.5, "far": 1e30},
    "image": {"width": 320, "height": 2e2, "background": {"bottom": [0.1, 0.2, 0.3], "top": [4, 5, 6]}},
    "render": {"max_depth": 3, "samples": 16, "cutoff": 0.25, "integrator": "whitted", "tracer": "compact", "sampler": "sobol"})"));
  CHECK(scene.camera.position == dvec3(1, 2, 3));
  CHECK(scene.camera.target == dvec3(4, 5, 6));
  CHECK(scene.camera.up == dvec3(0, 0, 1));
  CHECK(scene.camera.fov == 30.5);
  CHECK(scene.camera.near == 0.5);
  CHECK(scene.camera.far == 1e30);
  CHECK(scene.image.width == 320);
  CHECK(scene.image.height == 200);
  CHECK(scene.image.background_bottom == dvec3(0.1, 0.2, 0.3));
  CHECK(scene.image.background_top == dvec3(4, 5, 6));
  CHECK(scene.render.max_depth == 3);
  CHECK(scene.render.samples == 16);
  CHECK(scene.render.cutoff == 0.25);
  CHECK(scene.render.tracer == Tracer::compact);
  CHECK(scene.render.sampler == SAMPLER_SOBOL);
}

TEST_CASE("a scene without a camera is framed: all is seen, and it fills the image") {
  for (const char* size : {R"("width": 100, "height": 200)", R"("width": 300, "height": 100)"}) {
    const SceneDescription scene =
        load_scene_text(scene_with(fmt::format(R"("camera": {{"fov": 60}}, "image": {{{}}})", size)));
    CHECK(scene.camera.fov == 60);
    CHECK(scene.camera.target == dvec3(0));
    const dvec3 view = glm::normalize(scene.camera.target - scene.camera.position);
    const dvec3 right = glm::normalize(glm::cross(view, scene.camera.up)), up = glm::cross(right, view);
    const double tall = std::tan(glm::radians(30.0)), wide = tall * scene.image.width / scene.image.height;
    double reach = 0;  // of the corners of the box around the sphere: 1 is the image's edge
    for (int corner = 0; corner < 8; ++corner) {
      const dvec3 to =
          dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1) - scene.camera.position;
      const double depth = glm::dot(to, view);
      CHECK(depth > 0);
      reach = std::max(
          {reach, std::abs(glm::dot(to, right)) / depth / wide, std::abs(glm::dot(to, up)) / depth / tall});
    }
    CHECK(reach < 1);
    CHECK(reach > 0.9);
  }
}

TEST_CASE("lights of every type are read") {
  const LightDescription ambient = light(R"({"type": "ambient", "color": [1, 0.5, 0], "intensity": 0.2})");
  CHECK(ambient.type == LightType::ambient);
  CHECK(ambient.color == dvec3(1, 0.5, 0));
  CHECK(ambient.intensity == 0.2);
  const LightDescription sun = light(R"({"type": "directional", "direction": [0, -2, 0]})");
  CHECK(sun.type == LightType::directional);
  CHECK(sun.direction == dvec3(0, -1, 0));
  CHECK(sun.intensity == 1);
  const LightDescription lamp =
      light(R"({"type": "point", "position": [1, 2, 3], "falloff": {"quadratic": 0.5}})");
  CHECK(lamp.type == LightType::point);
  CHECK(lamp.position == dvec3(1, 2, 3));
  CHECK(lamp.falloff == dvec3(1, 0, 0.5));
  const LightDescription spot =
      light(R"({"type": "spot", "position": [0, 5, 0], "target": [0, 0, 0], "outer_angle": 15})");
  CHECK(spot.type == LightType::spot);
  CHECK(spot.direction == dvec3(0, -1, 0));
  CHECK(spot.outer_angle == 15);
  CHECK(spot.inner_angle == 10);
}

TEST_CASE("media are read, and absorption may be a colour at a distance") {
  const SceneDescription scene = load_scene_text(scene_with(R"("media": {
    "a": {"ior": 1.31, "absorption": [1, 2, 3], "priority": -4},
    "b": {"absorption": {"color": [1, 0.5, 0.25], "distance": 2}}})"));
  REQUIRE(scene.media.size() == 3);
  CHECK(scene.media[1].name == "a");
  CHECK(scene.media[1].ior == 1.31);
  CHECK(scene.media[1].absorption == dvec3(1, 2, 3));
  CHECK(scene.media[1].priority == -4);
  check_close(scene.media[2].absorption, {0, std::log(2.0) / 2, std::log(4.0) / 2});
  CHECK(!std::signbit(scene.media[2].absorption.x));
}

TEST_CASE("Dispersion: media disperse by a name, by Abbe's number or by a formula") {
  const SceneDescription scene = load_scene_text(scene_with(R"("media": {
    "plain": {"ior": 1.5},
    "named": {"ior": "BK7", "priority": 3},
    "abbe": {"ior": 1.6, "abbe": 40},
    "cauchy": {"cauchy": [1.5, 0.004]},
    "sellmeier": {"sellmeier": [1.25, 0.01]}},
    "materials": {"m": {"type": "dielectric", "ior": "diamond"}, "n": {"type": "dielectric", "ior": 1.7, "abbe": 30}})"));
  const auto medium = [&](std::string_view name) {
    return *std::ranges::find(scene.media, name, &MediumDescription::name);
  };
  const auto index = [&](std::string_view name, double wavelength) {
    const MediumDescription found = medium(name);
    return index_at(found.dispersion, found.ior, wavelength);
  };
  CHECK(medium("plain").dispersion.kind == DispersionKind::none);
  CHECK(medium("named").ior == Approx(1.5168).epsilon(1e-5));
  CHECK(medium("named").priority == 3);
  CHECK(index("named", line_F) == Approx(1.52238).epsilon(1e-5));
  CHECK(medium("abbe").ior == Approx(1.6));
  CHECK(index("abbe", line_F) - index("abbe", line_C) == Approx(0.6 / 40));
  CHECK(index("cauchy", 500) == Approx(1.516));
  CHECK(medium("cauchy").ior == Approx(1.5 + 0.004 / 0.345229).epsilon(1e-5));
  CHECK(index("sellmeier", 500) == Approx(std::sqrt(1 + 1.25 * 0.25 / 0.24)));
  CHECK(medium("m").ior == Approx(2.4175).epsilon(1e-4));
  CHECK(index("n", line_d) == Approx(1.7));
}

TEST_CASE("the world's medium gives way to all others") {
  const SceneDescription scene = load_scene_text(
      scene_with(R"("world": {"medium": "sea"}, "media": {"air": {}, "sea": {"ior": 1.33, "priority": 7}},
                    "materials": {"m": {"medium": "sea"}})"));
  REQUIRE(scene.media.size() == 3);
  CHECK(scene.media[0].ior == 1.33);
  CHECK(scene.media[0].priority == world_priority);
  CHECK(scene.media[2].priority == 7);
  CHECK(scene.materials[0].medium == 2);
}

TEST_CASE("a material's colour goes into its ambient and diffuse terms") {
  const MaterialDescription plain = material("{}");
  CHECK(plain.type == MaterialType::phong);
  CHECK(plain.ambient == dvec3(0.1));
  CHECK(plain.diffuse == dvec3(0.8));
  CHECK(plain.specular == dvec3(0));
  CHECK(plain.reflection == dvec3(0));
  CHECK(plain.transmission == dvec3(0));
  CHECK(plain.medium == -1);
  const MaterialDescription red =
      material(R"({"color": [1, 0.5, 0], "ambient": 0.5, "diffuse": {"coefficient": 0.25}})");
  CHECK(red.ambient == dvec3(0.5, 0.25, 0));
  CHECK(red.diffuse == dvec3(0.25, 0.125, 0));
  const MaterialDescription own =
      material(R"({"color": [1, 0, 0], "ambient": {"color": [0, 1, 0], "coefficient": 0.5}})");
  CHECK(own.ambient == dvec3(0, 0.5, 0));
  CHECK(own.diffuse == dvec3(0.8, 0, 0));
}

TEST_CASE("a material's other terms are read") {
  const MaterialDescription m =
      material(R"({"specular": {"color": [1, 1, 0], "coefficient": 0.5, "exponent": 80},
    "shading": "blinn", "reflection": 0.25, "transmission": {"color": [1, 0.5, 0], "coefficient": 0.5},
    "medium": "ice", "shadow": "opaque", "vertex_color": true})");
  CHECK(m.specular == dvec3(0.5, 0.5, 0));
  CHECK(m.exponent == 80);
  CHECK(m.blinn);
  CHECK(m.reflection == dvec3(0.25));
  CHECK(m.transmission == dvec3(0.5, 0.25, 0));
  CHECK(m.medium == 1);
  CHECK(m.shadow_opaque);
  CHECK(m.vertex_color);
}

TEST_CASE("a checkerboard's odd cells hold their own colour, whatever the even ones'") {
  const MaterialDescription m =
      material(R"({"color": {"checker": [[0, 0, 0], [1, 0.5, 0]], "size": 2}, "diffuse": 0.5})");
  CHECK(m.checker);
  CHECK(m.checker_size == 2);
  CHECK(m.diffuse == dvec3(0));
  CHECK(m.checker_diffuse == dvec3(0.5, 0.25, 0));
  CHECK(m.checker_ambient == dvec3(0.1, 0.05, 0));
  const MaterialDescription own =
      material(R"({"color": {"checker": [[0, 0, 0], [1, 1, 1]]}, "ambient": {"color": [1, 0, 0]}})");
  CHECK(own.ambient == dvec3(0.1, 0, 0));
  CHECK(own.checker_ambient == dvec3(0.1, 0, 0));
}

TEST_CASE("a surface's colour as bytes is a warning") {
  const auto warnings = [](const char* color) {
    return load_scene_text(scene_with(R"("materials": {"m": {"color": )" + std::string(color) + "}}"))
        .warnings;
  };
  CHECK(warnings("[1, 0.5, 2]").empty());
  REQUIRE(warnings("[0, 128, 255]").size() == 1);
  CHECK(warnings("[0, 128, 255]")[0].find("/materials/m/color: ") != std::string::npos);
}

TEST_CASE("a dielectric has no local terms and clear rays unless it says so") {
  const MaterialDescription glass = material(R"({"type": "dielectric", "ior": 1.5})");
  CHECK(glass.type == MaterialType::dielectric);
  CHECK(glass.ambient == dvec3(0));
  CHECK(glass.diffuse == dvec3(0));
  CHECK(glass.specular == dvec3(0));
  CHECK(glass.reflection == dvec3(1));
  CHECK(glass.transmission == dvec3(1));
  const MaterialDescription milky =
      material(R"({"type": "dielectric", "medium": "ice", "color": [1, 0.5, 0], "diffuse": 0.5})");
  CHECK(milky.diffuse == dvec3(0.5, 0.25, 0));
  CHECK(milky.medium == 1);
}

TEST_CASE("an index of refraction of its own makes a medium of its own") {
  const SceneDescription scene = load_scene_text(
      scene_with(R"("media": {"ice": {}}, "materials": {"a": {"ior": 1.5}, "m": {"ior": 1.7}})"));
  REQUIRE(scene.media.size() == 4);
  CHECK(scene.materials[0].medium == 2);
  CHECK(scene.materials[1].medium == 3);
  CHECK(scene.media[2].ior == 1.5);
  CHECK(scene.media[3].ior == 1.7);
  CHECK(scene.media[3].priority == 0);
}

TEST_CASE("the same scene gives the same description, whatever the order of its keys") {
  const SceneDescription one = load_scene_text(R"({"materials": {"a": {}, "b": {"ior": 2}}, "objects": []})");
  const SceneDescription two = load_scene_text(R"({"objects": [], "materials": {"b": {"ior": 2}, "a": {}}})");
  REQUIRE(one.materials.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(one.materials[i].name == two.materials[i].name);
    CHECK(one.materials[i].medium == two.materials[i].medium);
  }
}
