// Filter importance sampling: pictures whose filtered pixels have closed forms.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "catch.h"
#include "compile/view/filter.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// Where the edge lies, in pixels to the right of the middle of column 4: a filter that is too wide or too
/// narrow shows there, and not at the middle.
constexpr double edge = 0.35;

/// A black plane that ends in a white one, seen from above: nine pixels a row.
SceneDescription edge_scene(Filter filter, int samples) {
  SceneDescription scene = scenes::line_of_sight({0, 10, 0}, {0, 0, 0}, {0, 0, -1});
  scene.image.width = 9;
  scene.image.height = 3;
  scene.camera.fov = 2;
  scene.image.background_bottom = scene.image.background_top = {0, 0, 0};
  scene.render.filter = filter;
  scene.render.samples = samples;
  scene.render.sampler = SAMPLER_SOBOL;
  scene.render.max_depth = 1;
  const double pixel = 2 * 9.999 * std::tan(glm::radians(scene.camera.fov) / 2) / scene.image.height;
  scenes::place(scene, BoxShape{{50, 0.001, 50}}, scenes::add_glow(scene, {1, 1, 1}),
                glm::translate(glm::dmat4(1), dvec3(50 + edge * pixel, 0, 0)));
  return scene;
}

/// The filter's share that lies beyond `x`.
double share_beyond(Filter filter, double radius, double x) {
  double all = 0, beyond = 0;
  constexpr int steps = 20'000;
  for (int i = 0; i < steps; ++i) {
    const double at = radius * (2.0 * (i + 0.5) / steps - 1);
    all += filter_value(filter, radius, at);
    if (at > x) beyond += filter_value(filter, radius, at);
  }
  return beyond / all;
}

}  // namespace

TEST_CASE("an edge is drawn as the filter's integral, each filter's own, and a plain picture stays plain") {
  for (const Filter filter :
       {Filter::box, Filter::tent, Filter::gaussian, Filter::blackman_harris, Filter::mitchell})
    on_picture_devices([&](const DeviceInfo& info) {
      const SceneDescription scene = edge_scene(filter, 256);
      const Image image = scenes::render_on(info, scene).image;
      const double radius = filter_radius(scene.render);
      // Samples that count -1 add noise.
      const double margin = filter == Filter::mitchell ? 0.012 : 0.007;
      INFO(static_cast<int>(filter));
      for (int x = 0; x < image.width; ++x)
        for (int y = 0; y < image.height; ++y)
          CHECK(image.pixel(x, y)[0] == Approx(share_beyond(filter, radius, 4 + edge - x)).margin(margin));
      CHECK(image.pixel(8, 1)[0] == Approx(1).margin(1e-6));
    });
}
