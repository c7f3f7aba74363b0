// Heights from a picture, and copies that are strewn over a surface.
#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/image_io.h"
#include "catch.h"
#include "scene/load.h"
#include "scene_text.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

/// A plate 4 by 4 at y = 0.5 as a mesh, with what is strewn over it. `keys` go to the scatter.
std::string strewn(const std::string& keys) {
  return R"({"materials": {"m": {}}, "meshes": {"plate": {"generate": {"type": "extrusion", "height": 0.5,
      "outline": [[-2, -2], [2, -2], [2, 2], [-2, 2]]}}},
    "objects": [{"type": "scatter", "on": "plate", "material": "m", )" +
         keys + R"(, "objects": [{"type": "sphere", "name": "ball", "radius": 0.1},
      {"type": "group", "objects": [{"type": "sphere", "radius": 0.2}, {"type": "box", "half": [0.1, 0.1, 0.1]}]}]}]})";
}

SceneError refusal(const std::string& text) {
  try {
    load_scene_text(text);
  } catch (const SceneError& error) {
    return error;
  }
  FAIL("was read");
  throw std::logic_error("");
}

}  // namespace

TEST_CASE("copies are as many as the density says of the surface's area") {
  // Both faces and four sides: 16 + 16 + 4 * 2; level and facing up: 16.
  const auto count = [](const std::string& keys) {
    std::size_t copies = 0;
    for (const Object& object : load_scene_text(strewn(keys)).objects)
      copies += !std::holds_alternative<BoxShape>(object.shape);
    return copies;
  };
  CHECK(std::abs(int(count(R"("density": 10)")) - 400) <= 1);
  CHECK(std::abs(int(count(R"("density": 10, "steepest": 10)")) - 160) <= 1);
  CHECK(count(R"("density": 0)") <= 1);
}

TEST_CASE("copies stand on the surface, sized and turned within their ranges, the same for equal seeds") {
  const std::string keys = R"("density": 20, "steepest": 10, "scale": [0.5, 2], "turn": 90)";
  const SceneDescription scene = load_scene_text(strewn(keys)), again = load_scene_text(strewn(keys)),
                         other = load_scene_text(strewn(keys + R"(, "seed": 2)"));
  dvec3 mean(0);
  double least = 9, greatest = 0, kinds[2] = {}, quadrants[4] = {};
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    CHECK(object.world_from_object == again.objects[i].world_from_object);
    if (std::holds_alternative<BoxShape>(object.shape)) continue;
    const dvec3 p(object.world_from_object[3]), x(object.world_from_object[0]);
    const double size = glm::length(x), turn = std::atan2(-x.z, x.x);
    CHECK(p.y == Approx(0.5));
    CHECK(std::max(std::abs(p.x), std::abs(p.z)) <= 2);
    CHECK((size >= 0.5 && size <= 2 && turn >= -1e-9 && turn <= M_PI / 2 + 1e-9));
    least = std::min(least, size), greatest = std::max(greatest, size);
    mean += p;
    ++kinds[object.name != "ball"];
    ++quadrants[(p.x > 0) + 2 * (p.z > 0)];
  }
  CHECK(scene.objects[0].world_from_object != other.objects[0].world_from_object);
  CHECK((least < 0.55 && greatest > 1.9));
  CHECK(glm::length(mean / 320.0 - dvec3(0, 0.5, 0)) < 0.2);
  for (const double kind : kinds) CHECK(std::abs(kind - 160) < 40);
  for (const double quadrant : quadrants) CHECK(std::abs(quadrant - 80) < 20);
}

TEST_CASE("copies stand at right angles to the surface, or upright") {
  for (const bool upright : {false, true}) {
    const std::string keys =
        fmt::format(R"("density": 5, "upright": {}, "transform": [{{"translate": [9, 0, 0]}}])", upright);
    bool aside = false;
    for (const Object& object : load_scene_text(strewn(keys)).objects) {
      const dvec3 up(object.world_from_object[1]), p = dvec3(object.world_from_object[3]) - dvec3(9, 0, 0);
      aside |= std::abs(up.y) < 0.5;
      if (!upright && std::holds_alternative<SphereShape>(object.shape) && std::abs(up.x) > 0.5)
        CHECK(p.x * up.x == Approx(2));
    }
    CHECK(aside == !upright);
  }
}

TEST_CASE("what cannot be strewn is refused with its place") {
  CHECK(refusal(strewn(R"("density": 1000)")).place == "/objects/0");
  CHECK(std::string(refusal(strewn(R"("density": 1000)")).what()).find("raise the \"limit\"") !=
        std::string::npos);
  CHECK(refusal(strewn(R"("scale": [2, 1])")).place == "/objects/0/scale");
  CHECK(refusal(strewn(R"("density": -1)")).place == "/objects/0/density");
  CHECK(
      refusal(
          R"({"materials": {"m": {}}, "objects": [{"type": "scatter", "on": "hill", "objects": [{"type": "sphere", "material": "m"}]}]})")
          .place == "/objects/0/on");
}

TEST_CASE("a terrain has the heights of its picture, whose top lies towards -z") {
  const TemporaryFolder folder;
  Image heights(3, 3, 3);
  for (std::size_t c = 0; c < 3; ++c)
    heights.data[c] = 1, heights.data[3 * 8 + c] = 0.25f;  // top left, bottom right
  write_image(heights, folder / "h.pfm");
  write_image(heights, folder / "h.png");
  for (const char* file : {"h.pfm", "h.png"}) {
    const auto scene =
        folder.write("scene.json", fmt::format(R"({{"materials": {{"m": {{}}}}, "meshes": {{"land":
        {{"generate": {{"type": "terrain", "file": "{}", "size": [6, 6], "height": 2, "cells": 6}}}}}},
      "objects": [{{"type": "mesh", "mesh": "land", "material": "m"}}]}})",
                                               file));
    const Mesh mesh = load_scene(scene).meshes.at(0);
    // Middles of pixels are the places 1, 3 and 5 of 0 to 6.
    const auto height = [&](std::size_t i, std::size_t k) { return double(mesh.positions[7 * k + i].y); };
    // Files of 8 bits say nothing of light: their levels are heights.
    const double quarter = file == std::string("h.png") ? double(srgb_from_linear(0.25f)) : 0.25;
    CHECK(height(1, 1) == Approx(2).margin(0.01));
    CHECK(height(0, 0) == Approx(2).margin(0.01));
    CHECK(height(2, 1) == Approx(1).margin(0.01));
    CHECK(height(2, 2) == Approx(0.5).margin(0.01));
    CHECK(height(5, 5) == Approx(2 * quarter).margin(0.01));
    CHECK(height(5, 1) == Approx(0).margin(0.01));
    CHECK(mesh.positions[0].z == -3);
  }
}
