// The public interface on each driver that is installed, and on all of them at once.
#include <cmath>
#include <future>
#include <map>

#include "library_testing.h"

namespace {

/// The first device of each driver; of those of SUNDOG_TEST_DEVICES where it is set.
std::vector<sundog::Device> one_a_driver() {
  std::vector<sundog::Device> all = sundog::devices();
  if (const char* listed = std::getenv("SUNDOG_TEST_DEVICES")) {
    std::vector<std::string> specs(1);
    for (const char* at = listed; *at; ++at)
      *at == ',' ? specs.emplace_back() : (specs.back() += *at, specs.back());
    all = sundog::choose_devices(specs);
  }
  std::map<int, sundog::Device> first;
  for (const sundog::Device& device : all)
    if (device.usable) first.emplace(device.platform, device);
  std::vector<sundog::Device> result;
  for (const auto& [platform, device] : first) result.push_back(device);
  return result;
}

/// Few features: some drivers compile for long.
sundog::Scene plain_scene() {
  sundog::Scene scene;
  scene.set_size(24, 16).set_camera({.position = {0, 0, 5}});
  scene.add_light({.type = "directional", .direction = {-1, -1, -1}}).add_light({.type = "ambient"});
  scene.add_material("red", {.color = {0.8, 0.1, 0.1}});
  scene.add_sphere({0, 0, 0}, 1, {.material = "red"});
  return scene;
}

double difference(const sundog::Image& a, const sundog::Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i) sum += std::abs(a.pixels()[i] - b.pixels()[i]);
  return sum / static_cast<double>(a.pixels().size());
}

}  // namespace

TEST_CASE("sessions on all drivers at once draw, edit after edit, what render() draws on each") {
  const std::vector<sundog::Device> devices = one_a_driver();
  REQUIRE_FALSE(devices.empty());
  sundog::Scene scene = plain_scene();
  std::vector<sundog::Image> drawn;
  {
    std::vector<sundog::Session> sessions;
    for (const sundog::Device& device : devices) sessions.emplace_back(std::vector{device});
    for (const double intensity : {0.5, 1.0, 1.5})  // the last one while all draw
      for (sundog::Session& session : sessions) session.start(scene.set("/lights/0/intensity", intensity));
    // Each ends once it has its picture. One that rests builds kernels for edits to come, on llvmpipe for a
    // minute.
    std::vector<std::future<sundog::Image>> pictures;
    for (sundog::Session& session : sessions)
      pictures.push_back(std::async(std::launch::async, [&session] {
        const sundog::Session mine = std::move(session);
        return mine.finish();
      }));
    for (std::future<sundog::Image>& picture : pictures) drawn.push_back(picture.get());
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    CAPTURE(devices[i].label);
    const sundog::Film film = sundog::render(scene, {.devices = {devices[i]}});
    CHECK(film.complete());
    CHECK(same_pixels(film.image(), drawn[i]));
    CHECK(film.image().pixels()[4 * (8 * 24 + 12)] > 0.4f);
    CHECK(difference(drawn[i], drawn[0]) < 1e-3);
    CHECK(film.figures().devices.at(0).label == devices[i].label);
  }
  if (devices.size() < 2) WARN("there is but one driver here: two at once are not tried");
}
