// Solids whose faces lie in one place: of one medium they are one solid, of two there is one interface.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "catch.h"
#include "devices.h"
#include "touching_scenes.h"

using namespace sundog;
using glm::dmat4, glm::dvec3;
using namespace touching;

namespace {

/// The part of light that passes from a medium of one index straight into another.
double passed(double a, double b) { return 1 - std::pow((a - b) / (a + b), 2); }

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

/// Calls body(device, tracer) for each tracer.
template <class Body>
void with_each_tracer(Body body) {
  for (const DeviceInfo& device : picture_devices())
    for (const Tracer tracer : {Tracer::wide, Tracer::compact}) {
      if (device.native_vector_width <= 1 && tracer == Tracer::wide) continue;
      DYNAMIC_SECTION(device.label() << (tracer == Tracer::wide ? ", wide" : ", compact")) {
        body(device, tracer);
      }
    }
}

/// `parts` in any order of the file look like `whole`, but for `most` pixels. On borders of the floor's
/// cells, a pixel wide, rounding is magnified by the cells' size over a pixel's.
void check_alike(const SceneDescription& whole, const SceneDescription& parts, int most = 0) {
  constexpr float filtered = 1e-3f;
  SceneDescription backwards = parts;
  std::reverse(backwards.objects.begin(), backwards.objects.end());
  with_each_tracer([&](const DeviceInfo& device, Tracer tracer) {
    const std::vector<float> wanted = picture(device, tracer, whole);
    CHECK(pixels_that_differ(wanted, picture(device, tracer, parts), filtered) <= most);
    CHECK(pixels_that_differ(wanted, picture(device, tracer, backwards), filtered) <= most);
  });
}

const Piece whole_box{{-1, -1, -1}, {1, 1, 1}};

void check_like_whole(const std::vector<Piece>& pieces) {
  SceneDescription whole = over_a_floor();
  const int glass = add_glass(whole);
  SceneDescription parts = whole;
  place_pieces(whole, {{whole_box.lower, whole_box.upper, pieces[0].mesh}}, glass);
  place_pieces(parts, pieces, glass);
  check_alike(whole, parts);
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
  const int glass = add_glass(whole);
  SceneDescription parts = whole;
  place_pieces(whole, {{whole_box.lower, whole_box.upper, true}}, glass);
  parts.meshes.emplace_back();
  for (const Piece& piece : grid_of_cubes(true)) add_cube(parts.meshes.back(), piece);
  scenes::place(parts, MeshShape{static_cast<int>(parts.meshes.size()) - 1}, glass);
  check_alike(whole, parts);
}

TEST_CASE("boxes, meshes and spheres on a lattice are one solid, turned and scaled too") {
  const unsigned seed = GENERATE(range(1u, 6u));
  std::mt19937 random(seed);
  SceneDescription whole = over_a_floor();
  const int glass = add_glass(whole);
  SceneDescription parts = whole;
  std::vector<Piece> pieces;
  cut(whole_box, random, pieces);
  dmat4 turn(1);
  if (seed % 2 == 0) turn = glm::scale(glm::rotate(dmat4(1), 0.7, dvec3(0.3, 1, 0.2)), dvec3(0.8, 1.1, 0.9));
  place_pieces(whole, {whole_box}, glass, turn);
  place_pieces(parts, pieces, glass, turn);
  const unsigned spheres = seed > 2 ? seed : 0;
  for (unsigned i = 0; i < spheres; ++i) {
    const auto lattice = [&] { return -1 + 0.4 * static_cast<double>(random() % 6); };
    const double x = lattice(), y = lattice(), z = lattice();
    const Shape sphere = SphereShape{0.2 * static_cast<double>(1 + random() % 3)};
    scenes::place(whole, sphere, glass, turn * at({x, y, z}));
    for (unsigned times = 1 + random() % 2; times; --times)
      scenes::place(parts, sphere, glass, turn * at({x, y, z}));
  }
  INFO(pieces.size() << " pieces");
  // Round surfaces magnify the rounding of what light meets before them.
  check_alike(whole, parts, spheres ? 4 : 0);
}

TEST_CASE("round solids in one place are one solid") {
  SceneDescription once = over_a_floor();
  const int glass = add_glass(once);
  const std::size_t first = once.objects.size();
  const dmat4 turn = glm::rotate(dmat4(1), 0.3, dvec3(1, 0, 0.5));
  scenes::place(once, SphereShape{0.5}, glass, at({-0.7, 0.5, 0}));
  scenes::place(once, CylinderShape{0.45, 0.5, true}, glass, at({0.7, 0.5, 0}) * turn);
  scenes::place(once, RoundBoxShape{{0.5, 0.45, 0.4}, 0.12}, glass, at({-0.7, -0.6, 0}) * turn);
  scenes::place(once, ConeShape{0.5, 0.25, 0.4, true}, glass, at({0.7, -0.6, 0}) * turn);
  scenes::place(once, TorusShape{0.4, 0.15}, glass, at({0, 0.2, 0.8}) * turn);
  SceneDescription twice = once;
  twice.objects.insert(twice.objects.end(), once.objects.begin() + std::ptrdiff_t(first), once.objects.end());
  check_alike(once, twice);
}

TEST_CASE("faces just before the nearest hit, by rounding, are crossed with it") {
  // The tracer leaves out a mesh whose box begins behind a hit, and its face may lie before both.
  SceneDescription whole = over_a_floor();
  const int glass = add_glass(whole);
  whole.camera.fov = 90;
  SceneDescription parts = whole;
  place_pieces(whole, {whole_box}, glass);
  place_pieces(parts, {{{-1, -1, -1}, {-0.6, 1, 1}}, {{-0.6, -1, -1}, {1, 1, 1}, true}}, glass);
  place_pieces(parts, {{{-0.6, -1, -1}, {0.6, 0.6, 1}, true}}, glass);
  const int place = GENERATE(0, 1, 2);
  for (SceneDescription* scene : {&whole, &parts}) {
    scene->camera.position = place == 0   ? dvec3(-0.600897, -0.05, 0.61)
                             : place == 1 ? dvec3(-0.60022, 0.24, 0.66)
                                          : dvec3(-0.600637, -0.78, 0.46);
    scene->camera.target = place == 0   ? dvec3(0, 0, 0.1)
                           : place == 1 ? dvec3(0, 0, 0.2)
                                        : dvec3(0, 0.1, -0.2);
  }
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label() << ", place " << place) {
      CHECK(scenes::render_on(device, parts).counts[COUNT_STRAY_EXIT] == 0);
    }
}

TEST_CASE("cylinders and cones that stand on each other or on boxes are one solid") {
  SceneDescription whole = over_a_floor();
  const int glass = add_glass(whole);
  SceneDescription parts = whole;
  const auto tin = [&](SceneDescription& scene, double radius, double from, double to) {
    scenes::place(scene, CylinderShape{radius, 0.5 * (to - from), true}, glass,
                  at({0, 0.5 * (from + to), 0}));
  };
  SECTION("three cylinders") {
    tin(whole, 0.8, -1, 1);
    tin(parts, 0.8, -1, -0.3);
    tin(parts, 0.8, -0.3, 0.4);
    tin(parts, 0.8, 0, 1);
  }
  SECTION("two cones") {
    scenes::place(whole, ConeShape{0.9, 0.3, 1, true}, glass);
    scenes::place(parts, ConeShape{0.9, 0.6, 0.5, true}, glass, at({0, -0.5, 0}));
    scenes::place(parts, ConeShape{0.6, 0.3, 0.5, true}, glass, at({0, 0.5, 0}));
  }
  SECTION("a cylinder in a box, its top in the box's") {
    place_pieces(whole, {whole_box}, glass);
    place_pieces(parts, {whole_box}, glass);
    tin(parts, 0.6, -0.5, 1);
  }
  check_alike(whole, parts);
}

TEST_CASE("where two media touch there is one interface") {
  const bool mesh = GENERATE(false, true);
  SceneDescription scene = along({0, 0, 9}, {0, 0, 0});
  const int first = scenes::add_dielectric(scene, 1.5), second = scenes::add_dielectric(scene, 1.2);
  place_pieces(scene, {{{-5, -4, 0}, {5, 5, 2}, mesh}}, first);
  place_pieces(scene, {{{-5, -4, -3}, {5, 5, 0}, mesh}}, second);
  if (GENERATE(false, true)) std::reverse(scene.objects.begin(), scene.objects.end());
  scenes::place(scene, DiskShape{1, 0}, scenes::add_glow(scene, {1, 1, 1}),
                glm::rotate(at({0, 0, -5}), glm::radians(90.0), dvec3(1, 0, 0)));
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label()) {
      CHECK(scenes::pixel_on(device, scene).x ==
            Approx(passed(1, 1.5) * passed(1.5, 1.2) * passed(1.2, 1)).epsilon(1e-5));
    }
}

TEST_CASE("a film between touching solids is entered and left, as thin as rounding, as offsets, or thinner") {
  SceneDescription scene = along({0, 0, 9}, {0, 0, 0});
  const int first = scenes::add_dielectric(scene, 1.5), second = scenes::add_dielectric(scene, 1.2),
            film = scenes::add_dielectric(scene, 1.5, {1, 1, 1});
  const double thickness = GENERATE(1e-7, 3.74e-6, 4.01e-6, 4.29e-6, 5.67e-6);  // first: both at one t
  place_pieces(scene, {{{-5, -4, 0}, {5, 5, 2}}}, first);
  place_pieces(scene, {{{-5, -4, -thickness}, {5, 5, 0}}}, film);
  place_pieces(scene, {{{-5, -4, -3}, {5, 5, -thickness}}}, second);
  scenes::place(scene, DiskShape{1, 0}, scenes::add_glow(scene, {1, 1, 1}),
                glm::rotate(at({0, 0, -5}), glm::radians(90.0), dvec3(1, 0, 0)));
  SceneDescription echoes = scene;
  echoes.render.cutoff = 1e-4;
  echoes.image.width = echoes.image.height = 16;
  echoes.camera.fov = 10;
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label() << ", " << thickness) {
      CHECK(scenes::render_on(device, echoes).counts[COUNT_STRAY_EXIT] == 0);
      CHECK(scenes::pixel_on(device, scene).x ==
            Approx(passed(1, 1.5) * passed(1.5, 1.2) * passed(1.2, 1)).epsilon(1e-5));
    }
}

TEST_CASE("where a clear face and a shining one touch, the shining one is seen") {
  SceneDescription scene = along({0, 0, 9}, {0, 0, 0});
  const int one = scenes::add_dielectric(scene, 1.2),
            other = scenes::add_dielectric(scene, 1.2, {0.1, 0.1, 0.1});
  const bool swapped = GENERATE(false, true);
  scene.materials[static_cast<std::size_t>(swapped ? one : other)].ambient = {0.5, 0.25, 0.125};
  place_pieces(scene, {{{-5, -4, 0}, {5, 5, 2}}}, swapped ? other : one);
  place_pieces(scene, {{{-5, -4, -3}, {5, 5, 0}}}, swapped ? one : other);
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label() << swapped) {
      const dvec3 light = scenes::pixel_on(device, scene);
      // Its far face shines too; the other box, or it, absorbs.
      const double both = passed(1, 1.2) * std::exp(swapped ? -0.2 : 0) * (1 + std::exp(swapped ? 0 : -0.3));
      CHECK(light.x == Approx(0.5 * both).epsilon(1e-5));
      CHECK(light.y == Approx(0.25 * both).epsilon(1e-5));
    }
}

TEST_CASE("every device crosses faces that lie in one place once") {
  // Few shapes and no lights: its kernels are small.
  SceneDescription scene = scenes::line_of_sight({0, 0, 9}, {0, 0, 0});
  scene.render.max_depth = 3;
  const int glass = scenes::add_dielectric(scene, 1.5);
  place_pieces(scene, {{{-5, -4, 0}, {5, 5, 2}}, {{-5, -4, -3}, {5, 5, 0}}, {{-4, -3, -3}, {5, 5, 2}}},
               glass);
  scenes::place(scene, PlaneShape{}, scenes::add_glow(scene, {1, 1, 1}),
                glm::rotate(at({0, 0, -5}), glm::radians(90.0), dvec3(1, 0, 0)));
  on_picture_devices([&](const DeviceInfo& device) {
    CHECK(scenes::pixel_on(device, scene).x == Approx(0.96 * 0.96).epsilon(1e-5));
  });
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
  for (const double height : {6.0, 2.01}) {
    whole.camera.position.y = halves.camera.position.y = height;
    for (const DeviceInfo& device : picture_devices())
      DYNAMIC_SECTION(device.label() << ", from " << height) {
        const dvec3 a = scenes::pixel_on(device, whole), b = scenes::pixel_on(device, halves);
        CHECK(a.x > 0.01);
        CHECK(glm::length(a - b) <= 1e-6);
      }
  }
}

TEST_CASE("a light is filtered by one interface where two media touch") {
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
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label()) {
      const dvec3 light = scenes::pixel_on(device, scene);
      CHECK(light.x == Approx(clear * std::exp(-0.3)).epsilon(1e-5));
      CHECK(light.y == Approx(clear * std::exp(-0.4)).epsilon(1e-5));
      CHECK(light.z == Approx(clear).epsilon(1e-5));
    }
}

TEST_CASE("glass that stands on the floor shows it as glass that is sunk into it") {
  const bool mesh = GENERATE(false, true);
  SceneDescription sunk = over_a_floor();
  const int glass = add_glass(sunk);
  SceneDescription standing = sunk;
  place_pieces(sunk, {{{-1, -1.5, -1}, {1, 0.8, 1}, mesh}}, glass);
  place_pieces(standing, {{{-1, -1.2, -1}, {1, 0.8, 1}, mesh}}, glass);
  check_alike(sunk, standing);
}

TEST_CASE("liquid that is flush with the rim of its glass has one surface") {
  const bool mesh = GENERATE(false, true);
  SceneDescription scene = along({0.1, 9, 0.2}, {0.1, 0, 0.2}, {0, 0, 1});
  const int priority = GENERATE(0, 1);
  const int glass = scenes::add_dielectric(scene, 1.5);
  const int liquid = scenes::add_dielectric(scene, 1.3, {0.5, 0.2, 0.1}, priority);
  place_pieces(scene, {{{-1, -1, -1}, {1, 1, 1}, mesh}}, glass);
  place_pieces(scene, {{{-0.7, -0.5, -0.7}, {0.7, 1, 0.7}}}, liquid);
  if (GENERATE(false, true)) std::reverse(scene.objects.begin(), scene.objects.end());
  scenes::place(scene, PlaneShape{}, scenes::add_glow(scene, {1, 1, 1}), at({0, -2, 0}));
  const double clear = passed(1, 1.3) * passed(1.3, 1.5) * passed(1.5, 1);
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label()) {
      const dvec3 light = scenes::pixel_on(device, scene);
      CHECK(light.x == Approx(clear * std::exp(-0.5 * 1.5)).epsilon(1e-5));
      CHECK(light.z == Approx(clear * std::exp(-0.1 * 1.5)).epsilon(1e-5));
    }
}

TEST_CASE("liquid that fills a cup of touching walls to the rim is liquid inside of a block") {
  const bool mesh = GENERATE(false, true);
  SceneDescription block = over_a_floor();
  const int glass = add_glass(block), liquid = scenes::add_dielectric(block, 1.33, {0.02, 0.3, 0.3});
  SceneDescription cup = block;
  place_pieces(block, {whole_box}, glass);
  place_pieces(block, {{{-0.7, -0.7, -0.7}, {0.7, 1, 0.7}}}, liquid);
  place_pieces(cup,
               {{{-1, -1, -1}, {1, -0.7, 1}, mesh},
                {{-1, -0.7, -1}, {-0.7, 1, 1}, mesh},
                {{0.7, -0.7, -1}, {1, 1, 1}, mesh},
                {{-0.7, -0.7, -1}, {0.7, 1, -0.7}, mesh},
                {{-0.7, -0.7, 0.7}, {0.7, 1, 1}, mesh}},
               glass);
  place_pieces(cup, {{{-0.7, -0.7, -0.7}, {0.7, 1, 0.7}, mesh}}, liquid);
  check_alike(block, cup);
}

TEST_CASE("a camera inside touching solids of one medium sees as inside one") {
  const bool mesh = GENERATE(false, true);
  SceneDescription whole = over_a_floor();
  const int glass = add_glass(whole);
  SceneDescription parts = whole;
  for (SceneDescription* scene : {&whole, &parts}) {
    scene->camera.position = {0.3, 0.2, 0.5};
    scene->camera.target = {-1, -1, -2};
  }
  place_pieces(whole, {whole_box}, glass);
  // Three lie on each other at the top: the line that leads out of the camera's box leaves all at once.
  place_pieces(parts,
               {{{-1, -1, -1}, {1, 0.7, 1}, mesh},
                {{0, -0.5, 0}, {0.8, 0.7, 0.8}, !mesh},
                {{-0.1, -0.6, -0.1}, {0.9, 0.7, 0.9}, mesh},
                {{-1, 0.7, -1}, {1, 1, 1}, mesh},
                {{-1, -1, -1}, {0, 1, 1}}},
               glass);
  check_alike(whole, parts, 2);
}

TEST_CASE("extra images show the faces that are shaded, a disk that lies on glass among them") {
  SceneDescription scene = over_a_floor();
  const int glass = add_glass(scene), liquid = scenes::add_dielectric(scene, 1.33, {0.02, 0.3, 0.3}),
            paint = scenes::add_white(scene);
  place_pieces(scene, {whole_box}, glass);
  place_pieces(scene, {{{-0.7, -0.7, -0.7}, {0.7, 1, 0.7}}}, liquid);
  const std::size_t disk = scene.objects.size();
  scenes::place(scene, DiskShape{0.6, 0}, paint, at({0.4, 1, 0}));
  SceneDescription backwards = scene, above = scene;
  std::reverse(backwards.objects.begin(), backwards.objects.end());
  above.objects[disk].world_from_object = at({0.4, 1.001, 0});
  RenderOptions options;
  options.aovs = {"material", "depth", "normal"};
  for (const DeviceInfo& device : picture_devices()) DYNAMIC_SECTION(device.label()) {
      const RenderResult one = scenes::render_on(device, scene, options),
                         other = scenes::render_on(device, backwards, options),
                         lifted = scenes::render_on(device, above, options);
      for (const std::string& name : options.aovs)
        CHECK(pixels_that_differ(one.aovs.at(name).data, other.aovs.at(name).data) == 0);
      int painted = 0, wet = 0, unlike = 0;
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          const auto material = [&](const RenderResult& of) {
            return static_cast<int>(of.aovs.at("material").pixel(x, y)[0]);
          };
          wet += material(one) == liquid;
          if (material(one) != paint || material(lifted) != paint) continue;
          ++painted;
          unlike += std::abs(one.image.pixel(x, y)[0] - lifted.image.pixel(x, y)[0]) > 1e-3f;
        }
      CHECK(wet > 20);
      CHECK(painted > 20);
      CHECK(unlike == 0);
    }
}
