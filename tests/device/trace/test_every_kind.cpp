// Each kind of solid and light is there on each device: a ray finds the solid where double precision does, a
// light shines, and no two lights alike.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>
#include <set>

#include "bench/rays/check_hits.h"
#include "catch.h"
#include "each_tracer.h"
#include "every_kind.h"
#include "scene/kinds.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

constexpr double apart = 4;  // solids in a row

SceneDescription row_of_solids() {
  SceneDescription scene = scenes::line_of_sight({0, 0, 20}, {0, 0, 0});
  const int white = scenes::add_white(scene);
  double x = 0;
  for (const Shape& solid : every_bounded_solid()) {
    const glm::dmat4 there = glm::translate(glm::dmat4(1), dvec3(x, 0, 0));
    scenes::place(scene, solid, white, glm::rotate(there, 0.6, dvec3(1, 0.4, 0.2)));
    x += apart;
  }
  scenes::place(scene, PlaneShape{}, white, glm::translate(glm::dmat4(1), dvec3(0, -2, 0)));
  return scene;
}

/// From the side of each solid towards it, and towards the plane below.
std::vector<Ray> rays_at_solids(std::size_t solids) {
  std::mt19937 random(5);
  const auto uniform = [&] { return static_cast<float>(random() >> 8) * 0x1p-23f - 1; };
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < 64 * solids; ++i) {
    const float x = static_cast<float>(apart) * static_cast<float>(i / 64);
    const glm::vec3 o(x + 1.5f * uniform(), 1.5f * uniform(), 4), to(x + uniform(), uniform(), uniform());
    rays.push_back(
        {o.x, o.y, o.z, 0, to.x - o.x, to.y - o.y, to.z - o.z, std::numeric_limits<float>::infinity()});
  }
  return rays;
}

}  // namespace

TEST_CASE("rays meet each kind of solid where it is") {
  const std::vector<Ray> rays = rays_at_solids(every_bounded_solid().size());
  for_each_tracer(row_of_solids(), [&](const CompiledScene& flat, RayTracer& tracer, bool coherent) {
    const std::vector<Hit> hits = tracer.trace(rays, coherent);
    std::set<u32> met;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      CAPTURE(i, hits[i].t, hits[i].instance);
      CHECK(is_right(flat, rays[i], hits[i]));
      if (hits[i].instance != NO_INSTANCE) met.insert(flat.instances[hits[i].instance].shape);
    }
    for (const Shape& solid : every_solid()) {
      INFO(name_of(solid));
      CHECK(met.count(static_cast<u32>(solid.index())) == 1);
    }
  });
}

TEST_CASE("each type of light shines, and in a way of its own") {
  SceneDescription scene = scenes::line_of_sight({0, 2, 6}, {0, 0, 0});
  scene.camera.fov = 60;
  scene.image.width = scene.image.height = 16;
  const int white = scenes::add_white(scene);
  scene.materials[static_cast<std::size_t>(white)].ambient = dvec3(0.3);
  scenes::place(scene, PlaneShape{}, white, glm::translate(glm::dmat4(1), dvec3(0, -1, 0)));
  scenes::place(scene, SphereShape{}, white);
  for (const DeviceInfo& info : picture_devices()) DYNAMIC_SECTION(info.label()) {
      std::set<std::vector<float>> pictures;
      for (const LightDescription& light : every_light()) {
        INFO(facts_of(light.type).name);
        scene.lights = {light};
        const std::vector<float> picture = scenes::render_on(info, scene).image.data;
        double sum = 0;
        for (std::size_t i = 0; i < picture.size(); ++i) sum += i % 4 == 3 ? 0 : double(picture[i]);
        CHECK(sum > 1);
        CHECK(pictures.insert(picture).second);
      }
    }
}
