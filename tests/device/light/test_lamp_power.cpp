// The power of lamps: what reaches a floor is what the lamp sends there of its watts.
#include <cmath>

#include "base/file.h"
#include "catch.h"
#include "devices.h"
#include "scene/load.h"
#include "scenes.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

constexpr double half = 20,
                 height = 1;  // of the square of floor that the picture shows; of the lamps over it

SceneDescription floor_under(const std::string& lamp, double unit = 1) {
  const TemporaryFolder folder;
  folder.write("scene.json", R"({
    "camera": {"position": [0, 0.5, 0], "target": [0, 0, 0], "up": [0, 0, -1], "orthographic": 40},
    "image": {"width": 128, "height": 128}, "render": {"samples": 4}, "unit": )" +
                                 std::to_string(unit) + R"(,
    "lights": [{"position": [0, 1, 0], )" +
                                 lamp + R"(}],
    "materials": {"white": {"color": [1, 1, 1], "diffuse": 1, "ambient": 0}},
    "objects": [{"type": "plane", "material": "white"}]})");
  return load_scene(folder.path() / "scene.json");
}

/// The luminance of the power that the floor in the picture receives, for a floor that returns all of it.
double power_on_floor(const DeviceInfo& device, const SceneDescription& scene) {
  const Image image = scenes::render_on(device, scene).image;
  const double pixel = 2 * half / image.width;
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* c = image.pixel(x, y);
      sum += 0.2126 * double(c[0]) + 0.7152 * double(c[1]) + 0.0722 * double(c[2]);
    }
  return sum * M_PI * pixel * pixel * scene.unit * scene.unit;
}

}  // namespace

TEST_CASE("the light that leaves a lamp is the power that its watts say") {
  // The share of a point's light that meets the square: its solid angle over that of all directions.
  const double square = half * half, below = 4 * std::asin(square / (square + height * height)) / (4 * M_PI);
  on_picture_devices([&](const DeviceInfo& device) {
    const auto check = [&](const std::string& lamp, double wanted) {
      CAPTURE(lamp);
      CHECK(power_on_floor(device, floor_under(lamp)) == Approx(wanted).epsilon(0.015));
    };
    check(R"("type": "point", "watts": 3)", 3 * below);
    check(R"("type": "sphere", "radius": 0.3, "watts": 3, "visible": false)", 3 * below);
    // A lamp that sends half its light as Lambert does, straight down: all but a four-hundredth meets it.
    check(R"("type": "rectangle", "direction": [0, -1, 0], "size": [0.5, 0.3], "watts": 3)", 3);
    check(R"("type": "disk", "direction": [0, -1, 0], "radius": 0.3, "watts": 3)", 3);
    check(R"("type": "spot", "direction": [0, -1, 0], "outer_angle": 70, "inner_angle": 20, "watts": 3)", 3);
    check(
        R"("type": "spot", "direction": [0, -1, 0], "outer_angle": 70, "inner_angle": 10, "square_edge": true, "watts": 3)",
        3);
    check(R"("type": "disk", "direction": [0, -1, 0], "color": [1, 0.3, 0.1], "watts": 3)", 3);
    check(R"("type": "disk", "direction": [0, -1, 0], "temperature": 2700, "lumens": 358)", 2);
    CHECK(power_on_floor(device, floor_under(R"("type": "disk", "direction": [0, -1, 0], "watts": 3)",
                                             0.1)) == Approx(3).epsilon(0.015));
  });
}
