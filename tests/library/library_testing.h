// Shared by tests of the public interface. They include <sundog/...> and no header of the host: the names
// are the same.
#pragma once
#include <sundog/sundog.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "catch.h"

/// The first of SUNDOG_TEST_DEVICES; else PoCL, or where it is not installed the default device.
inline const std::string& test_spec() {
  static const std::string spec = [] {
    if (const char* listed = std::getenv("SUNDOG_TEST_DEVICES"))
      return std::string(listed).substr(0, std::string(listed).find(','));
    try {
      return sundog::choose_devices({"portable"}).size() == 1 ? std::string("portable") : std::string();
    } catch (const sundog::Error&) {
      return std::string();
    }
  }();
  return spec;
}

inline std::vector<sundog::Device> test_device() {
  return test_spec().empty() ? sundog::choose_devices() : sundog::choose_devices({test_spec()});
}

/// The Error that `f` throws; fails the test where it throws none.
template <class F>
sundog::Error error_of(const F& f) {
  try {
    f();
  } catch (const sundog::Error& error) {
    return error;
  }
  FAIL("no error was thrown");
  throw;
}

inline bool same_pixels(const sundog::Image& a, const sundog::Image& b) {
  return a.width() == b.width() && a.channels() == b.channels() && std::ranges::equal(a.pixels(), b.pixels());
}

inline std::filesystem::path shipped_scene(const std::string& name) {
  return std::filesystem::path(SUNDOG_SOURCE_DIR) / "scenes" / (name + ".json");
}

/// A mirror ball over a floor, small.
inline sundog::Scene small_scene() {
  sundog::Scene scene;
  scene.set_size(64, 48).set_camera({.position = {0, 1, 5}, .target = {0, 0.5, 0}, .fov = 40});
  scene.set_background({0.1, 0.1, 0.2}, {0.5, 0.6, 0.9});
  scene.add_light({.type = "ambient", .intensity = 0.4});
  scene.add_light({.type = "point", .position = {3, 5, 4}});
  scene.add_material("red", {.color = {0.8, 0.1, 0.1}, .diffuse = 0.7, .specular = 0.3, .reflection = 0.3});
  scene.add_material("floor", {.color = {0.7, 0.7, 0.7}});
  scene.add_sphere({0, 1, 0}, 1, {.material = "red", .name = "ball"});
  scene.add_plane({0, 0, 0}, {0, 1, 0}, {.material = "floor", .name = "ground"});
  return scene;
}
