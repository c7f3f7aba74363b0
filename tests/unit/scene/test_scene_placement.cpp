// Solids, groups and transforms: every shape has its size and is where the file says.
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

dvec3 point(const dmat4& matrix, const dvec3& p) { return dvec3(matrix * glm::dvec4(p, 1)); }

/// Where an object's transform takes a point.
dvec3 placed(std::string_view object, const dvec3& p) {
  return point(load_scene_text(scene_of(object)).objects.at(0).world_from_object, p);
}

template <class Kind>
Kind shape(std::string_view object) {
  return std::get<Kind>(load_scene_text(scene_of(object)).objects.at(0).shape);
}

}  // namespace

TEST_CASE("transforms are applied in the order of the list") {
  check_close(placed(R"({"type": "sphere", "material": "m", "transform": [
    {"scale": [2, 3, 4]}, {"rotate": {"axis": [0, 0, 5], "degrees": 90}}, {"translate": [10, 0, 0]}]})",
                     {1, 1, 1}),
              {7, 2, 4});
  check_close(
      placed(R"({"type": "sphere", "material": "m", "transform": [{"translate": [10, 0, 0]}, {"scale": 2}]})",
             {1, 0, 0}),
      {22, 0, 0});
  check_close(placed(R"({"type": "sphere", "material": "m",
    "transform": [{"matrix": [0, 1, 0, 5, 0, 0, 1, 6, 1, 0, 0, 7, 0, 0, 0, 1]}]})",
                     {1, 2, 3}),
              {7, 9, 8});
}

TEST_CASE("groups place what is in them, and lend it their material and name") {
  const SceneDescription scene = load_scene_text(R"({"materials": {"a": {}, "b": {}}, "objects": [
    {"type": "group", "name": "table", "material": "b", "transform": [{"translate": [1, 0, 0]}], "objects": [
      {"type": "group", "transform": [{"scale": 2}], "objects": [
        {"type": "sphere", "center": [1, 0, 0]}, {"type": "sphere", "name": "top", "material": "a"}]},
      {"type": "disk"}]}]})");
  REQUIRE(scene.objects.size() == 3);
  check_close(point(scene.objects[0].world_from_object, {0, 0, 0}), {3, 0, 0});
  CHECK(scene.objects[0].material == 1);
  CHECK(scene.objects[0].name == "table");
  CHECK(scene.objects[0].place == "/objects/0/objects/0/objects/0");
  CHECK(scene.objects[1].material == 0);
  CHECK(scene.objects[1].name == "top");
  CHECK(scene.objects[2].material == 1);
}

TEST_CASE("uneven scales of any size are no singular transforms") {
  check_close(placed(R"({"type": "sphere", "material": "m", "transform": [{"scale": [1e-6, 1, 1e6]},
    {"rotate": {"axis": [1, 1, 1], "degrees": 120}}]})",
                     {0, 1, 0}),
              {0, 0, 1});
  check_close(placed(R"({"type": "sphere", "material": "m", "transform": [
    {"rotate": {"axis": [1, 1, 1], "degrees": 120}}, {"scale": [-1, 1, 1e-7]}]})",
                     {0, 0, 1}),
              {-1, 0, 0});
}

TEST_CASE("solids are read with their sizes") {
  CHECK(shape<SphereShape>(R"({"type": "sphere", "material": "m", "radius": 3})").radius == 3);
  CHECK(shape<BoxShape>(R"({"type": "box", "material": "m"})").half == dvec3(1));
  CHECK(shape<BoxShape>(R"({"type": "box", "material": "m", "half": 2})").half == dvec3(2));
  CHECK(shape<BoxShape>(R"({"type": "box", "material": "m", "min": [0, 1, 2], "max": [2, 5, 8]})").half ==
        dvec3(1, 2, 3));
  const auto round = shape<RoundBoxShape>(R"({"type": "round_box", "material": "m", "half": [1, 2, 0.05]})");
  CHECK(round.half == dvec3(1, 2, 0.05));
  CHECK(round.radius == 0.05);
  CHECK(shape<RoundBoxShape>(R"({"type": "round_box", "material": "m", "radius": 0.2})").radius == 0.2);
  const auto cylinder = shape<CylinderShape>(
      R"({"type": "cylinder", "material": "m", "radius": 2, "height": 3, "capped": false})");
  CHECK(cylinder.radius == 2);
  CHECK(cylinder.half_height == 1.5);
  CHECK(!cylinder.capped);
  const auto cone = shape<ConeShape>(
      R"({"type": "cone", "material": "m", "bottom_radius": 0, "top_radius": 2, "from": [0, 0, 0], "to": [3, 4, 0]})");
  CHECK(cone.bottom_radius == 0);
  CHECK(cone.top_radius == 2);
  CHECK(cone.half_height == 2.5);
  CHECK(cone.capped);
  const auto disk =
      shape<DiskShape>(R"({"type": "disk", "material": "m", "radius": 2, "inner_radius": 1.5})");
  CHECK(disk.radius == 2);
  CHECK(disk.inner_radius == 1.5);
  const auto rectangle = shape<RectangleShape>(R"({"type": "rectangle", "material": "m", "size": [3, 0.5]})");
  CHECK(rectangle.half == dvec2(1.5, 0.25));
  const auto torus = shape<TorusShape>(R"({"type": "torus", "material": "m", "major_radius": 2})");
  CHECK(torus.major_radius == 2);
  CHECK(torus.minor_radius == 0.5);
}

TEST_CASE("shorthands put solids where they say") {
  check_close(
      placed(R"({"type": "sphere", "material": "m", "center": [1, 2, 3], "transform": [{"scale": 2}]})",
             {0, 0, 1}),
      {2, 4, 8});
  check_close(placed(R"({"type": "box", "material": "m", "min": [0, 1, 2], "max": [2, 5, 8]})", {0, 0, 0}),
              {1, 3, 5});
  const std::string_view plane =
      R"({"type": "plane", "material": "m", "point": [1, 2, 3], "normal": [3, 0, 4]})";
  check_close(placed(plane, {0, 0, 0}), {1, 2, 3});
  check_close(placed(plane, {0, 1, 0}), {1.6, 2, 3.8});
  const std::string_view bar =
      R"({"type": "cylinder", "material": "m", "from": [1, 2, 3], "to": [1, -2, 3]})";
  check_close(placed(bar, {0, -2, 0}), {1, 2, 3});
  check_close(placed(bar, {0, 2, 0}), {1, -2, 3});
  const std::string_view cone = R"({"type": "cone", "material": "m", "from": [0, 0, 0], "to": [2, 4, 4]})";
  check_close(placed(cone, {0, -3, 0}), {0, 0, 0});
  check_close(placed(cone, {0, 3, 0}), {2, 4, 4});
  check_close(
      placed(R"({"type": "torus", "material": "m", "axis": [-1, 0, 0], "center": [0, 0, 5]})", {0, 1, 0}),
      {-1, 0, 5});
  check_close(placed(R"({"type": "disk", "material": "m", "normal": [0, -1, 0]})", {0, 1, 0}), {0, -1, 0});
}

TEST_CASE("shorthands only turn and move: no shape is mirrored or stretched") {
  for (const char* normal :
       {"[0, 1, 0]", "[0, -1, 0]", "[1, 0, 0]", "[1e-9, -1, 0]", "[-3, -4, 5]", "[2, 1e-7, 2]"}) {
    INFO(normal);
    const SceneDescription scene = load_scene_text(
        scene_of(R"({"type": "disk", "material": "m", "normal": )" + std::string(normal) + "}"));
    const glm::dmat3 linear(scene.objects[0].world_from_object);
    const glm::dmat3 product = linear * glm::transpose(linear);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) CHECK(std::abs(product[i][j] - (i == j)) < 1e-12);
    CHECK(glm::determinant(linear) == Approx(1).epsilon(1e-12));
  }
}
