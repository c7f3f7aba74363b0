// Solids whose faces lie in one place: of one medium they are one solid, of two there is one interface.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "catch.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dmat4;
using glm::dvec3;

namespace {

dmat4 at(dvec3 position) { return glm::translate(dmat4(1), position); }

struct Piece {
  dvec3 lower, upper;
  bool mesh = false;
};

constexpr int size = 40;

/// The box from (0, 0, 0) to (1, 1, 1).
Mesh cube() {
  Mesh mesh;
  mesh.name = "cube";
  for (int i = 0; i < 8; ++i) mesh.positions.push_back({float(i & 1), float(i >> 1 & 1), float(i >> 2 & 1)});
  for (const glm::uvec4& f : {glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5), glm::uvec4(0, 1, 5, 4),
                              glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6)}) {
    mesh.triangles.push_back({f.x, f.y, f.z});
    mesh.triangles.push_back({f.x, f.z, f.w});
  }
  return mesh;
}

void add_cube(Mesh& mesh, const Piece& piece) {
  const auto first = static_cast<unsigned>(mesh.positions.size());
  const Mesh unit = cube();
  for (const glm::vec3& p : unit.positions)
    mesh.positions.push_back(glm::vec3(piece.lower + dvec3(p) * (piece.upper - piece.lower)));
  for (const glm::uvec3& t : unit.triangles) mesh.triangles.push_back(t + first);
}

/// A mesh and one of each solid that is used here, far off: scenes of the same shapes share their kernels.
void add_bystanders(SceneDescription& scene) {
  scene.meshes.push_back(cube());
  const int material = scenes::add_glow(scene, {0, 0, 0});
  double x = 300;
  for (const Shape& shape :
       {Shape(MeshShape{0}), Shape(BoxShape{}), Shape(SphereShape{}), Shape(CylinderShape{}),
        Shape(RoundBoxShape{}), Shape(ConeShape{}), Shape(DiskShape{})})
    scenes::place(scene, shape, material, at({x += 5, 0, 300}));
  scenes::place(scene, PlaneShape{}, material, at({0, -500, 0}));
}

/// A checkered floor at y = -1 under a light, seen from above.
SceneDescription over_a_floor() {
  SceneDescription scene = scenes::line_of_sight({2.4, 2.0, 4.6}, {0, 0, 0});
  scene.camera.fov = 36;
  scene.image.width = scene.image.height = size;
  scene.image.background_bottom = {0.7, 0.75, 0.8};
  scene.image.background_top = {0.15, 0.3, 0.6};
  scene.render.max_depth = 8;
  scene.render.cutoff = 1e-3;
  LightDescription point;
  point.position = {-4, 6, 4};
  scene.lights.push_back(point);
  const int floor = scenes::add_white(scene);
  MaterialDescription& material = scene.materials[static_cast<std::size_t>(floor)];
  material.checker = true;
  material.checker_diffuse = {0.1, 0.15, 0.3};
  material.checker_size = 0.55;
  scenes::place(scene, PlaneShape{}, floor, at({0, -1.2, 0}));
  add_bystanders(scene);
  return scene;
}

/// The line of sight of a closed form.
SceneDescription along(dvec3 from, dvec3 to, dvec3 up = {0, 1, 0}) {
  SceneDescription scene = scenes::line_of_sight(from, to, up);
  scene.render.max_depth = 4;  // what most of these need: the straight path through two media, without echoes
  add_bystanders(scene);
  return scene;
}

/// Places the pieces, meshes as scaled instances of one cube.
void place_pieces(SceneDescription& scene, const std::vector<Piece>& pieces, int material,
                  const dmat4& turn = dmat4(1)) {
  for (const Piece& piece : pieces) {
    if (piece.mesh) {
      scenes::place(scene, MeshShape{0}, material,
                    turn * glm::scale(at(piece.lower), piece.upper - piece.lower));
    } else
      scenes::place(scene, BoxShape{0.5 * (piece.upper - piece.lower)}, material,
                    turn * at(0.5 * (piece.lower + piece.upper)));
  }
}

std::vector<Piece> grid_of_cubes(bool mesh) {
  std::vector<Piece> pieces;
  for (int i = 0; i < 8; ++i) {
    const dvec3 lower((i & 1) - 1, (i >> 1 & 1) - 1, (i >> 2 & 1) - 1);
    pieces.push_back({lower, lower + 1.0, mesh});
  }
  return pieces;
}

/// Halves a box at lattice planes, again and again.
void cut(const Piece& whole, std::mt19937& random, std::vector<Piece>& pieces) {
  const dvec3 extent = whole.upper - whole.lower;
  const int axis = static_cast<int>(random() % 3);
  const int steps = static_cast<int>(std::lround(extent[axis] / 0.4));
  if (random() % 4 == 0 || steps < 2) {
    pieces.push_back(whole);
    pieces.back().mesh = random() % 2;
    return;
  }
  Piece first = whole, second = whole;
  first.upper[axis] = second.lower[axis] =
      whole.lower[axis] + 0.4 * (1 + static_cast<int>(random() % static_cast<unsigned>(steps - 1)));
  cut(first, random, pieces);
  cut(second, random, pieces);
}

/// Calls body(device, tracer) for each device and each tracer that it has.
template <class Body>
void with_each_tracer(Body body) {
  for (const DeviceInfo& device : test_devices())
    for (const Tracer tracer : {Tracer::wide, Tracer::compact}) {
      if (device.native_vector_width <= 1 && tracer == Tracer::wide) continue;
      DYNAMIC_SECTION(device.label() << (tracer == Tracer::wide ? ", wide" : ", compact")) {
        body(device, tracer);
      }
    }
}

std::vector<float> picture(const DeviceInfo& device, Tracer tracer, SceneDescription scene) {
  scene.render.tracer = tracer;
  return scenes::render_on(device, scene).image.data;
}

int pixels_that_differ(const std::vector<float>& a, const std::vector<float>& b, float tolerance = 1e-5f) {
  REQUIRE(a.size() == b.size());
  const std::size_t channels = a.size() / (size * size);
  int count = 0;
  for (std::size_t i = 0; i < a.size(); i += channels) {
    bool differs = false;
    for (std::size_t k = 0; k < channels; ++k) differs |= !(std::abs(a[i + k] - b[i + k]) <= tolerance);
    count += differs;
  }
  return count;
}

const Piece whole_box{{-1, -1, -1}, {1, 1, 1}};

void check_like_whole(const std::vector<Piece>& pieces, const dmat4& turn = dmat4(1)) {
  SceneDescription whole = over_a_floor();
  const int glass = scenes::add_dielectric(whole, 1.5, {0.3, 0.1, 0.05});
  SceneDescription parts = whole;
  place_pieces(whole, {{whole_box.lower, whole_box.upper, pieces[0].mesh}}, glass, turn);
  place_pieces(parts, pieces, glass, turn);
  SceneDescription backwards = parts;
  std::reverse(backwards.objects.begin(), backwards.objects.end());
  with_each_tracer([&](const DeviceInfo& device, Tracer tracer) {
    const std::vector<float> wanted = picture(device, tracer, whole);
    CHECK(pixels_that_differ(wanted, picture(device, tracer, parts)) == 0);
    CHECK(pixels_that_differ(wanted, picture(device, tracer, backwards)) == 0);
  });
}

}  // namespace

TEST_CASE("boxes of one medium that share a face are one box") {
  const bool mesh = GENERATE(false, true);
  SECTION("side by side") {
    check_like_whole({{{-1, -1, -1}, {0, 1, 1}, mesh}, {{0, -1, -1}, {1, 1, 1}, mesh}});
  }
  SECTION("overlapping, four faces of each in common planes") {
    check_like_whole({{{-1, -1, -1}, {0.3, 1, 1}, mesh}, {{0.1, -1, -1}, {1, 1, 1}, mesh}});
  }
  SECTION("a small one inside with a face in common") {
    check_like_whole({{whole_box.lower, whole_box.upper, mesh}, {{0.2, -0.5, -0.5}, {1, 0.4, 0.5}, mesh}});
  }
  SECTION("eight cubes") { check_like_whole(grid_of_cubes(mesh)); }
  SECTION("the same box twice") { check_like_whole({whole_box, {whole_box.lower, whole_box.upper, mesh}}); }
}

TEST_CASE("eight touching cubes of one mesh are one box") {
  SceneDescription whole = over_a_floor();
  const int glass = scenes::add_dielectric(whole, 1.5, {0.3, 0.1, 0.05});
  SceneDescription parts = whole;
  place_pieces(whole, {{whole_box.lower, whole_box.upper, true}}, glass);
  parts.meshes.emplace_back();
  for (const Piece& piece : grid_of_cubes(true)) add_cube(parts.meshes.back(), piece);
  scenes::place(parts, MeshShape{1}, glass);
  with_each_tracer([&](const DeviceInfo& device, Tracer tracer) {
    CHECK(pixels_that_differ(picture(device, tracer, whole), picture(device, tracer, parts)) == 0);
  });
}

TEST_CASE("boxes and meshes on a lattice are one box, turned and scaled too") {
  const unsigned seed = GENERATE(range(1u, 5u));
  std::mt19937 random(seed);
  std::vector<Piece> pieces;
  cut(whole_box, random, pieces);
  dmat4 turn(1);
  if (seed % 2 == 0) turn = glm::scale(glm::rotate(dmat4(1), 0.7, dvec3(0.3, 1, 0.2)), dvec3(0.8, 1.1, 0.9));
  INFO(pieces.size() << " pieces");
  check_like_whole(pieces, turn);
}

TEST_CASE("round solids in one place are one solid") {
  SceneDescription once = over_a_floor();
  const int glass = scenes::add_dielectric(once, 1.5, {0.3, 0.1, 0.05});
  const std::size_t first = once.objects.size();
  const dmat4 turn = glm::rotate(dmat4(1), 0.3, dvec3(1, 0, 0.5));
  scenes::place(once, SphereShape{0.5}, glass, at({-0.7, 0.5, 0}));
  scenes::place(once, CylinderShape{0.45, 0.5, true}, glass, at({0.7, 0.5, 0}) * turn);
  scenes::place(once, RoundBoxShape{{0.5, 0.45, 0.4}, 0.12}, glass, at({-0.7, -0.6, 0}) * turn);
  scenes::place(once, ConeShape{0.5, 0.25, 0.4, true}, glass, at({0.7, -0.6, 0}) * turn);
  SceneDescription twice = once;
  twice.objects.insert(twice.objects.end(), once.objects.begin() + std::ptrdiff_t(first), once.objects.end());
  with_each_tracer([&](const DeviceInfo& device, Tracer tracer) {
    CHECK(pixels_that_differ(picture(device, tracer, once), picture(device, tracer, twice)) == 0);
  });
}

TEST_CASE("two halves of a cylinder, one on the other, are one") {
  SceneDescription whole = over_a_floor();
  const int glass = scenes::add_dielectric(whole, 1.5, {0.3, 0.1, 0.05});
  SceneDescription halves = whole;
  scenes::place(whole, CylinderShape{0.8, 1, true}, glass);
  scenes::place(halves, CylinderShape{0.8, 0.5, true}, glass, at({0, -0.5, 0}));
  scenes::place(halves, CylinderShape{0.8, 0.5, true}, glass, at({0, 0.5, 0}));
  with_each_tracer([&](const DeviceInfo& device, Tracer tracer) {
    CHECK(pixels_that_differ(picture(device, tracer, whole), picture(device, tracer, halves)) == 0);
  });
}

TEST_CASE("where two media touch there is one interface") {
  const bool mesh = GENERATE(false, true);
  const auto passed = [](double a, double b) { return 1 - std::pow((a - b) / (a + b), 2); };
  SceneDescription scene = along({0, 0, 9}, {0, 0, 0});
  const int first = scenes::add_dielectric(scene, 1.5), second = scenes::add_dielectric(scene, 1.2);
  place_pieces(scene, {{{-5, -4, 0}, {5, 5, 2}, mesh}}, first);
  place_pieces(scene, {{{-5, -4, -3}, {5, 5, 0}, mesh}}, second);
  if (GENERATE(false, true)) std::reverse(scene.objects.begin(), scene.objects.end());
  scenes::place(scene, DiskShape{1, 0}, scenes::add_glow(scene, {1, 1, 1}),
                glm::rotate(at({0, 0, -5}), glm::radians(90.0), dvec3(1, 0, 0)));
  for (const DeviceInfo& device : test_devices()) DYNAMIC_SECTION(device.label()) {
      CHECK(scenes::pixel_on(device, scene).x ==
            Approx(passed(1, 1.5) * passed(1.5, 1.2) * passed(1.2, 1)).epsilon(1e-5));
    }
}

TEST_CASE("light that comes slantwise through touching media bends as their indices say") {
  // Snell holds between the outer sides whatever lies between them; from glass to glass nothing is turned
  // back.
  SceneDescription whole = along({0, 6, 1.5}, {0, 0, 0});
  const int glass = scenes::add_dielectric(whole, 1.5, {0.4, 0.2, 0.1});
  scenes::place(whole, PlaneShape{}, scenes::add_glow(whole, {0.5, 0.6, 0.7}), at({0, -3, 0}));
  SceneDescription halves = whole;
  place_pieces(whole, {{{-9, -2, -9}, {9, 2, 9}}}, glass);
  place_pieces(halves, {{{-9, -2, -9}, {9, 0, 9}}, {{-9, 0, -9}, {9, 2, 9}}}, glass);
  for (const double height : {6.0, 2.5, 2.01}) {
    whole.camera.position.y = halves.camera.position.y = height;
    for (const DeviceInfo& device : test_devices()) DYNAMIC_SECTION(device.label() << ", from " << height) {
        const dvec3 a = scenes::pixel_on(device, whole), b = scenes::pixel_on(device, halves);
        CHECK(a.x > 0.01);
        CHECK(glm::length(a - b) <= 1e-6);
      }
  }
}

TEST_CASE("a light is filtered by one interface where two media touch") {
  const auto passed = [](double a, double b) { return 1 - std::pow((a - b) / (a + b), 2); };
  SceneDescription scene = along({3, 0.5, 0}, {0, 0, 0});
  LightDescription sun;
  sun.type = LightType::directional;
  sun.direction = {0, -1, 0};
  scene.lights = {sun};
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  const int first = scenes::add_dielectric(scene, 1.5, {0.3, 0, 0}),
            second = scenes::add_dielectric(scene, 1.2, {0, 0.4, 0});
  place_pieces(scene, {{{-2, 1, -2}, {2, 2, 2}}}, first);
  place_pieces(scene, {{{-2, 2, -2}, {2, 3, 2}}}, second);
  const double clear = passed(1, 1.5) * passed(1.5, 1.2) * passed(1.2, 1);
  for (const DeviceInfo& device : test_devices()) DYNAMIC_SECTION(device.label()) {
      const dvec3 light = scenes::pixel_on(device, scene);
      CHECK(light.x == Approx(clear * std::exp(-0.3)).epsilon(1e-5));
      CHECK(light.y == Approx(clear * std::exp(-0.4)).epsilon(1e-5));
      CHECK(light.z == Approx(clear).epsilon(1e-5));
    }
}

TEST_CASE("glass that stands on the floor shows it as glass that is sunk into it") {
  const bool mesh = GENERATE(false, true);
  SceneDescription sunk = over_a_floor();
  const int glass = scenes::add_dielectric(sunk, 1.5, {0.3, 0.1, 0.05});
  SceneDescription standing = sunk;
  place_pieces(sunk, {{{-1, -1.5, -1}, {1, 0.8, 1}, mesh}}, glass);
  place_pieces(standing, {{{-1, -1.2, -1}, {1, 0.8, 1}, mesh}}, glass);
  if (GENERATE(false, true)) std::reverse(standing.objects.begin(), standing.objects.end());
  with_each_tracer([&](const DeviceInfo& device, Tracer tracer) {
    CHECK(pixels_that_differ(picture(device, tracer, sunk), picture(device, tracer, standing)) == 0);
  });
}

TEST_CASE("liquid that is flush with the rim of its glass has one surface") {
  const bool mesh = GENERATE(false, true);
  const auto passed = [](double a, double b) { return 1 - std::pow((a - b) / (a + b), 2); };
  SceneDescription scene = along({0.1, 9, 0.2}, {0.1, 0, 0.2}, {0, 0, 1});
  const int priority = GENERATE(0, 1);
  const int glass = scenes::add_dielectric(scene, 1.5);
  const int liquid = scenes::add_dielectric(scene, 1.3, {0.5, 0.2, 0.1}, priority);
  place_pieces(scene, {{{-1, -1, -1}, {1, 1, 1}, mesh}}, glass);
  place_pieces(scene, {{{-0.7, -0.5, -0.7}, {0.7, 1, 0.7}}}, liquid);
  if (GENERATE(false, true)) std::reverse(scene.objects.begin(), scene.objects.end());
  scenes::place(scene, PlaneShape{}, scenes::add_glow(scene, {1, 1, 1}), at({0, -2, 0}));
  const double clear = passed(1, 1.3) * passed(1.3, 1.5) * passed(1.5, 1);
  for (const DeviceInfo& device : test_devices()) DYNAMIC_SECTION(device.label()) {
      const dvec3 light = scenes::pixel_on(device, scene);
      CHECK(light.x == Approx(clear * std::exp(-0.5 * 1.5)).epsilon(1e-5));
      CHECK(light.z == Approx(clear * std::exp(-0.1 * 1.5)).epsilon(1e-5));
    }
}

TEST_CASE("a camera inside touching solids of one medium sees as inside one") {
  SceneDescription whole = over_a_floor();
  whole.camera.position = {0.3, 0.2, 0.5};
  whole.camera.target = {-1, -1, -2};
  const int glass = scenes::add_dielectric(whole, 1.5, {0.3, 0.1, 0.05});
  SceneDescription parts = whole;
  place_pieces(whole, {whole_box}, glass);
  // Two lie on each other at the top: the line that leads out of the camera's box leaves both at once.
  place_pieces(parts, {{{-1, -1, -1}, {1, 1, 1}}, {{0, -0.5, 0}, {0.8, 1, 0.8}}, {{-1, -1, -1}, {0, 1, 1}}},
               glass);
  with_each_tracer([&](const DeviceInfo& device, Tracer tracer) {
    CHECK(pixels_that_differ(picture(device, tracer, whole), picture(device, tracer, parts)) == 0);
  });
}
