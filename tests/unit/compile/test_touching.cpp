// Which instances are marked as touching others: all that do, and none of the usual ones that do not.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "compile/touching/box_tree.h"
#include "compile/touching/touching_triangles.h"
#include "device/device_rules.h"
#include "render/device/kernel_config.h"
#include "scene/load.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;
using glm::dmat4;
using glm::dvec3;

namespace {

dmat4 at(dvec3 position) { return glm::translate(dmat4(1), position); }

/// Two solids of glass, or the second one opaque.
bool touch(const Shape& a, const dmat4& place_a, const Shape& b, const dmat4& place_b, bool opaque = false) {
  SceneDescription scene = scenes::line_of_sight({0, 0, 9}, {0, 0, 0});
  const int glass = scenes::add_dielectric(scene, 1.5), white = scenes::add_white(scene);
  scene.meshes.push_back(bumpy_sphere(12));
  scenes::place(scene, a, glass, place_a);
  scenes::place(scene, b, opaque ? white : glass, place_b);
  const CompiledScene flat = compile(scene);
  const bool both = flat.instances[0].touch > 0 && flat.instances[1].touch > 0;
  CHECK(both == (flat.instances[0].touch > 0 || flat.instances[1].touch > 0));
  CHECK(flat.features.touching == both);
  return both;
}

const Shape box = BoxShape{}, ball = SphereShape{1}, tin = CylinderShape{1, 1, true},
            soft = RoundBoxShape{{1, 1, 1}, 0.2}, ring = TorusShape{1, 0.25}, mesh = MeshShape{0};

}  // namespace

TEST_CASE("solids with faces in one place are marked") {
  CHECK(touch(box, dmat4(1), box, at({2, 0.3, 0})));
  CHECK(touch(box, dmat4(1), box, at({2.0000002, 0.3, 0})));
  CHECK(touch(box, dmat4(1), BoxShape{{0.5, 0.5, 0.5}}, at({0.5, 0, 0})));
  CHECK(touch(box, dmat4(1), PlaneShape{}, at({0, -1, 0}), true));
  CHECK(touch(tin, at({0, 2, 0}), box, dmat4(1)));
  CHECK(touch(tin, dmat4(1), tin, at({0, 1, 0})));
  CHECK(touch(tin, dmat4(1), CylinderShape{0.5, 1, true}, at({0.5, 1, 0})));
  CHECK(touch(ball, dmat4(1), ball, dmat4(1)));
  CHECK(touch(ball, dmat4(1), ball, at({2, 0, 0})));
  CHECK(touch(ball, dmat4(1), tin, dmat4(1)));
  CHECK(touch(soft, dmat4(1), soft, at({0.3, 0, 0})));
  CHECK(touch(ring, dmat4(1), ring, dmat4(1)));
  CHECK(touch(mesh, dmat4(1), mesh, dmat4(1)));
  const dmat4 turned = glm::rotate(dmat4(1), 0.5, dvec3(1, 2, 3));
  CHECK(touch(box, turned, box, turned * at({2, 0, 0})));
  CHECK(touch(mesh, turned, mesh, turned));
}

TEST_CASE("a ray of a GPU has room for four faces of each solid that touches others, for 16 with a mesh") {
  const auto room = [](const Shape& a, const Shape& b, double apart) {
    SceneDescription scene = scenes::line_of_sight({0, 0, 9}, {0, 0, 0});
    const int glass = scenes::add_dielectric(scene, 1.5);
    scene.meshes.push_back(bumpy_sphere(12));
    scenes::place(scene, a, glass, dmat4(1));
    scenes::place(scene, b, glass, at({apart, 0, 0}));
    scenes::place(scene, ball, glass, at({0, 9, 0}));
    return make_kernel_config(compile(scene), typical_gpu("nvidia")).numbers.at("MOST_TOUCHING");
  };
  CHECK(room(box, box, 2) == 8);
  CHECK(room(box, box, 3) == 1);
  CHECK(room(mesh, mesh, 0) == 16);
}

TEST_CASE("it has room for one face of each field that touches others") {
  const CompiledScene flat =
      compile(load_scene(std::string(SUNDOG_SOURCE_DIR) + "/scenes/gallery/glass_julia.json"));
  unsigned touching = 0;
  for (const Instance& instance : flat.instances) touching += instance.touch > 0;
  CHECK(touching > 0);
  CHECK(make_kernel_config(flat, typical_gpu("nvidia")).numbers.at("MOST_TOUCHING") == touching);
}

TEST_CASE("solids that only cross or lie inside of each other are not marked") {
  CHECK_FALSE(touch(box, dmat4(1), box, at({0.3, 0.4, 0.5})));
  CHECK_FALSE(touch(box, dmat4(1), BoxShape{{0.9, 0.8, 0.99}}, dmat4(1)));
  CHECK_FALSE(touch(box, dmat4(1), box, at({2.001, 0, 0})));
  CHECK_FALSE(touch(ball, dmat4(1), ball, at({1, 0, 0})));
  CHECK_FALSE(touch(ball, dmat4(1), SphereShape{0.98}, dmat4(1)));
  CHECK_FALSE(touch(ball, dmat4(1), PlaneShape{}, at({0, 0.2, 0}), true));
  CHECK_FALSE(touch(ball, at({0, 1, 0}), PlaneShape{}, dmat4(1), true));
  CHECK_FALSE(touch(ball, at({0, 2, 0}), box, dmat4(1)));
  CHECK_FALSE(touch(soft, dmat4(1), SphereShape{0.1}, at({0.84, 0.45, 0.75})));
  CHECK_FALSE(touch(soft, dmat4(1), BoxShape{{0.68, 0.56, 0.6}}, dmat4(1)));
  CHECK_FALSE(touch(tin, dmat4(1), CylinderShape{0.9, 0.9, true}, dmat4(1)));
  CHECK_FALSE(touch(mesh, dmat4(1), mesh, glm::rotate(dmat4(1), 0.5, dvec3(1, 2, 3))));
  CHECK_FALSE(touch(mesh, dmat4(1), box, at({0.2, 0.3, 0.4})));
}

TEST_CASE("the scenes that come along touch nothing where glass is nested") {
  for (const char* name : {"hollow_ice", "hollow_ice_exact", "nested_glass", "spheres"}) {
    INFO(name);
    CHECK_FALSE(
        compile(load_scene(std::string(SUNDOG_SOURCE_DIR) + "/scenes/" + name + ".json")).features.touching);
  }
}

TEST_CASE("triangles lie on others, but not on their neighbours") {
  const auto triangle = [](dvec3 a, dvec3 b, dvec3 c) { return PlacedTriangle{{a, b, c}}; };
  const PlacedTriangle t = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  CHECK(lies_on(t, t, 1e-6));
  CHECK(lies_on(t, triangle({0.2, 0.2, 0}, {5, 0.2, 0}, {0.2, 5, 0}), 1e-6));
  CHECK(lies_on(t, triangle({0.1, 0.1, 5e-7}, {0.1, 0.2, 5e-7}, {0.2, 0.1, 5e-7}), 1e-6));
  CHECK_FALSE(lies_on(t, triangle({0.1, 0.1, 5e-6}, {0.1, 0.2, 5e-6}, {0.2, 0.1, 5e-6}), 1e-6));
  CHECK_FALSE(lies_on(t, triangle({1, 0, 0}, {1, 1, 0}, {0, 1, 0}), 1e-6));
  CHECK_FALSE(lies_on(t, triangle({0, 0, 0}, {1, 0, 0}, {0, -1, 0}), 1e-6));
  CHECK_FALSE(lies_on(t, triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0.1}), 1e-6));
}

TEST_CASE("balls that cross at an angle are not marked, those that lie against each other are") {
  for (const double apart : {0.3, 0.9, 1.5, 1.9, 2.1})
    CHECK_FALSE(touch(ball, dmat4(1), ball, at({0, apart, 0})));
  const Shape small = SphereShape{0.25};
  CHECK_FALSE(touch(ball, dmat4(1), small, at({0.5, 0, 0})));
  CHECK(touch(ball, dmat4(1), small, at({0, 1.25, 0})));
  CHECK_FALSE(touch(ball, dmat4(1), small, at({0, 1, 0})));
}

TEST_CASE("a tree of boxes finds all that overlap a box, and no other") {
  std::vector<LooseBox> boxes;
  for (int i = 0; i < 300; ++i) {
    const auto place = [&](int step) { return float(std::fmod(i * step * 0.6180339887, 10)); };
    const float x = place(1), y = place(7), z = place(13), half = 0.1f + float(i % 7) * 0.1f;
    boxes.push_back({{Lanes{x - half, y - half, z - half, 0}, Lanes{x + half, y + half, z + half, 0}},
                     i % 50 == 0 ? 1.0 : 1e-6});
  }
  boxes.push_back({{lanes(-INFINITY), lanes(INFINITY)}, 0});
  const BoxTree tree(boxes);
  std::vector<u32> found;
  for (u32 i = 0; i < boxes.size(); ++i) {
    std::vector<u32> expected;
    for (u32 k = i + 1; k < boxes.size(); ++k)
      if (overlap(boxes[i].box, boxes[k].box, std::max(boxes[i].slack, boxes[k].slack)))
        expected.push_back(k);
    tree.find(boxes[i], i, found);
    CHECK(found == expected);
  }
}
