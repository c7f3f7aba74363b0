// Rays that go through the tracer together find what each finds alone, to the bit, and nothing else about a
// batch matters: its company, rays that hit nothing, rays that are no rays.
#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "base/image_compare.h"
#include "bench/rays/ray_tracer.h"
#include "catch.h"
#include "devices.h"
#include "every_kind.h"
#include "scene/load.h"
#include "scenes.h"
#include "test_meshes.h"

using namespace sundog;

namespace {

using glm::vec3;

constexpr float infinity = std::numeric_limits<float>::infinity();

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-24f; }
vec3 in_cube(std::mt19937& random) {
  const float x = uniform(random), y = uniform(random), z = uniform(random);
  return 2.0f * vec3(x, y, z) - 1.0f;
}

/// One mesh where it lies.
SceneDescription lone_mesh() { return scene_of(bumpy_sphere(40)); }

/// Meshes turned, mirrored, squeezed and overlapping, solids and a plane.
SceneDescription mixed_scene() {
  SceneDescription scene = scenes::line_of_sight({0, 0, 5}, {0, 0, 0});
  const int white = scenes::add_white(scene);
  scene.meshes = {bumpy_sphere(30), random_triangles(300, 0.4f)};
  const glm::dmat4 one(1);
  scenes::place(scene, MeshShape{0}, white);
  scenes::place(scene, MeshShape{0}, white);  // the same again: every hit a tie
  scenes::place(scene, MeshShape{1}, white, glm::rotate(one, 0.7, glm::dvec3(1, 2, 3)));
  scenes::place(scene, MeshShape{1}, white, glm::scale(glm::translate(one, {1.5, 0.2, 0}), {-0.5, 0.1, 1}));
  for (int i = 0; i < 12; ++i) {
    const glm::dmat4 there =
        glm::scale(glm::translate(one, {1.2 * std::cos(i), 0.3 * i - 2, 1.2 * std::sin(i)}), glm::dvec3(0.3));
    if (i % 2)
      scenes::place(scene, SphereShape{}, white, there);
    else
      scenes::place(scene, BoxShape{}, white, glm::rotate(there, 0.2 * i, {0, 1, 1}));
  }
  scenes::place(scene, PlaneShape{}, white, glm::translate(one, {0, -1.7, 0}));
  return scene;
}

/// Solids of every kind, turned, squeezed, mirrored and overlapping, some twice in one place; no mesh.
SceneDescription solids(int count) {
  SceneDescription scene = scenes::line_of_sight({0, 0, 5}, {0, 0, 0});
  const int white = scenes::add_white(scene);
  const std::vector<Shape> shapes = solids_of_many_sizes();
  std::mt19937 random(7);
  const double size = 0.6 / std::cbrt(count);
  glm::dmat4 place(1);
  for (int i = 0; i < count; ++i) {
    if (i % 10 != 9) {  // else again where the last one is
      place = glm::translate(glm::dmat4(1), glm::dvec3(in_cube(random)));
      if (i % 4 != 1)
        place = glm::rotate(place, 6.0 * uniform(random), glm::dvec3(in_cube(random)) + glm::dvec3(0, 2, 0));
      place = glm::scale(place, size * glm::dvec3(i % 3 ? 1 : -1, i % 5 ? 1 : 0.4, 1));
    }
    scenes::place(scene, shapes[static_cast<std::size_t>(i) % shapes.size()], white, place);
  }
  scenes::place(scene, SphereShape{}, white, glm::dmat4(1));  // where it lies, so without a transform
  scenes::place(scene, PlaneShape{}, white, glm::translate(glm::dmat4(1), {0, -1.7, 0}));
  return scene;
}

/// Sixteens that run close together, wider and wider; every seventh holds rays of other kinds too.
std::vector<Ray> bundles(std::size_t count) {
  std::mt19937 random(3);
  std::vector<Ray> rays;
  vec3 from(0), to(0);
  float width = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 16 == 0) {
      from = 3.0f * in_cube(random);
      to = in_cube(random);
      width = std::pow(10.0f, -4.0f * uniform(random));
    }
    const vec3 o = from + (i / 16 % 2 ? 0.1f * width * in_cube(random) : vec3(0));
    vec3 d = to + width * in_cube(random) - o;
    Ray ray{o.x, o.y, o.z, 0, d.x, d.y, d.z, infinity};
    if (i / 16 % 3 == 1) ray.t_max = uniform(random) * 1.5f;
    if (i / 16 % 5 == 1) ray.t_min = uniform(random);
    if (i / 16 % 7 == 0 && random() % 3 == 0) switch (random() % 6) {
        case 0:
          ray.ox = std::numeric_limits<float>::quiet_NaN();
          break;
        case 1:
          ray.dy = infinity;
          break;
        case 2:
          ray.dx = ray.dy = ray.dz = 0;
          break;
        case 3:
          ray.t_max = ray.t_min;
          break;
        case 4:
          ray.dx = -0.0f;
          break;
        case 5:
          ray.dy = 0.0f;
          break;
      }
    rays.push_back(ray);
  }
  return rays;
}

constexpr int lattice = 40;
float lattice_line(int i) { return 0.1f * static_cast<float>(i); }

/// Steps over a lattice: the corners lie on its lines, and so do the faces of many boxes of the BVH.
SceneDescription lattice_steps() {
  Mesh mesh;
  for (int i = 0; i <= lattice; ++i)
    for (int j = 0; j <= lattice; ++j)
      mesh.positions.emplace_back(lattice_line(i), lattice_line(j), 0.3f * static_cast<float>(i * j % 3));
  const auto index = [](int i, int j) { return static_cast<unsigned>(i * (lattice + 1) + j); };
  for (int i = 0; i < lattice; ++i)
    for (int j = 0; j < lattice; ++j) {
      mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i, j + 1));
      mesh.triangles.emplace_back(index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
    }
  return scene_of(std::move(mesh));
}

/// Sixteens of rays that run exactly along the lattice's lines, or between two of them.
std::vector<Ray> lattice_rays(std::size_t count) {
  std::mt19937 random(5);
  std::vector<Ray> rays;
  const auto line = [&] { return static_cast<int>(random() % (lattice + 12)) - 6; };
  int x = 0, y = 0;
  float up = 1, zero = 0, between = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 16 == 0) {
      x = line(), y = line();
      up = random() % 2 ? 1.0f : -1.0f;
      zero = random() % 2 ? 0.0f : -0.0f;
      between = random() % 4 ? 0.0f : 0.05f;
    }
    const int u = x + static_cast<int>(i % 4), v = y + static_cast<int>(i / 4 % 4);
    rays.push_back({lattice_line(u) + between, lattice_line(v), -3 * up, 0, zero, zero, up, infinity});
  }
  return rays;
}

/// Hits to the bit, and whether there are any.
void check_same(const std::vector<Hit>& expected, const std::vector<Hit>& found,
                const std::vector<u32>& occluded) {
  std::size_t differ = 0, any_differs = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    differ += std::memcmp(&expected[i], &found[i], sizeof(Hit)) != 0;
    any_differs += (expected[i].instance != NO_INSTANCE) != (occluded[i] != 0);
  }
  CHECK(differ == 0);
  CHECK(any_differs == 0);
}

void compare_together_and_alone(const SceneDescription& scene,
                                std::vector<Ray> (*make_rays)(std::size_t) = bundles) {
  const CompiledScene flat = compile(scene);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    RayTracer tracer(device, flat);
    const std::vector<Ray> rays = make_rays(info.native_vector_width > 1 ? 200'009 : 2'009);
    const std::vector<Hit> together = tracer.trace(rays, true), alone = tracer.trace(rays, false);
    const std::vector<u32> occluded = tracer.occlusion(rays, true);
    check_same(alone, together, occluded);
    const auto hits = static_cast<std::size_t>(std::count_if(
        alone.begin(), alone.end(), [](const Hit& hit) { return hit.instance != NO_INSTANCE; }));
    CHECK(hits > rays.size() / 10);
    CHECK(hits < rays.size());
  });
}

/// Without the processor's own instructions, as other compilers have it.
void compare_with_portable(const SceneDescription& scene) {
  const CompiledScene flat = compile(scene);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    RayTracer own(device, flat), portable(device, flat, {{"SUNDOG_PORTABLE", "1"}});
    const std::vector<Ray> rays = bundles(info.native_vector_width > 1 ? 50'003 : 2'009);
    for (const bool coherent : {false, true}) {
      CAPTURE(coherent);
      const std::vector<Hit> expected = own.trace(rays, coherent), found = portable.trace(rays, coherent);
      const std::vector<u32> occluded = portable.occlusion(rays, coherent);
      check_same(expected, found, occluded);
    }
  });
}

void compare_wide_and_compact(SceneDescription scene, std::vector<Ray> (*make_rays)(std::size_t) = bundles) {
  on_every_device([&](const DeviceInfo& info) {
    if (info.native_vector_width <= 1) return;  // runs the compact tracer anyway
    Device device(info);
    const std::vector<Ray> rays = make_rays(50'003);
    scene.render.tracer = Tracer::wide;
    RayTracer wide(device, compile(scene));
    scene.render.tracer = Tracer::compact;
    RayTracer compact(device, compile(scene));
    const std::vector<Hit> expected = wide.trace(rays), found = compact.trace(rays);
    const std::vector<u32> occluded = compact.occlusion(rays);
    check_same(expected, found, occluded);
  });
}

}  // namespace

TEST_CASE("rays together find what each finds alone: one mesh") { compare_together_and_alone(lone_mesh()); }
TEST_CASE("rays together find what each finds alone: instances, solids and a plane") {
  compare_together_and_alone(mixed_scene());
}
TEST_CASE("rays together find what each finds alone: few solids, some solids, many solids") {
  compare_together_and_alone(solids(GENERATE(3, 9, 40, 300)));
}
TEST_CASE("rays together find what each finds alone: along the faces of boxes") {
  compare_together_and_alone(lattice_steps(), lattice_rays);
}

TEST_CASE("without a processor's own instructions the hits are the same") {
  compare_with_portable(GENERATE(0, 1) ? solids(40) : mixed_scene());
}

TEST_CASE("the compact tracer finds what the wide one finds: one mesh") {
  compare_wide_and_compact(lone_mesh());
}
TEST_CASE("the compact tracer finds what the wide one finds: instances, solids and a plane") {
  compare_wide_and_compact(mixed_scene());
}
TEST_CASE("the compact tracer finds what the wide one finds: some solids, many solids") {
  compare_wide_and_compact(solids(GENERATE(9, 300)));
}
TEST_CASE("the compact tracer finds what the wide one finds: along the faces of boxes") {
  compare_wide_and_compact(lattice_steps(), lattice_rays);
}
TEST_CASE("both tracers draw the same picture") {
  on_every_device([&](const DeviceInfo& info) {
    if (info.native_vector_width <= 1) return;
    SceneDescription scene =
        load_scene(SUNDOG_SOURCE_DIR "/scenes/nested_glass.json",
                   {"/image/width=64", "/image/height=48", "/render/samples=1", "/render/tracer=\"wide\""});
    const Image wide = scenes::render_on(info, scene).image;
    scene.render.tracer = Tracer::compact;
    const ImageDifference difference = compare_images(wide, scenes::render_on(info, scene).image, 1e-3);
    CHECK(difference.mean < 1e-5);
  });
}
