// Prepares the drivers, lists the tests' devices and compiles small kernels for them.
#include "devices.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <type_traits>

#include "base/environment.h"
#include "catch.h"
#include "shared/features.h"
#include "shared/sampler.h"
#include "shared/shapes.h"

void prepare_opencl_environment(bool every_driver) {
  if (every_driver) setenv("RUSTICL_ENABLE", "llvmpipe", 0);
  // Without LLVM's optimiser, llvmpipe compiles a third faster and draws the same bits.
  setenv("GALLIVM_PERF", "nopt", 0);
  // Tests change XDG_CACHE_HOME; Mesa's cache stays in the user's folder, if there is one.
  const char *xdg = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
  const std::string cache = xdg && *xdg ? xdg : home ? std::string(home) + "/.cache" : "";
  std::error_code error;
  if (!cache.empty()) std::filesystem::create_directories(cache, error);
  if (!cache.empty() && access(cache.c_str(), W_OK) == 0) setenv("MESA_SHADER_CACHE_DIR", cache.c_str(), 0);
}

const std::vector<sundog::DeviceInfo>& test_devices() {
  // Never destroyed: at exit, drivers have already freed data that the release of a context uses.
  static const auto& devices = *new const std::vector<sundog::DeviceInfo>([] {
    const char* listed = std::getenv("SUNDOG_TEST_DEVICES");
    std::istringstream in(listed ? listed : "all");
    std::vector<std::string> specs;
    for (std::string spec; std::getline(in, spec, ',');) specs.push_back(spec);
    auto chosen = sundog::select_devices(sundog::enumerate_devices(sundog::plain_environment()), specs);
    for (sundog::DeviceInfo& device : chosen) device = sundog::share_context(std::move(device));
    return chosen;
  }());
  return devices;
}

int& calls_on_devices() {
  static int calls = 0;
  return calls;
}

std::span<const sundog::DeviceInfo> picture_devices() {
  const std::span<const sundog::DeviceInfo> all = test_devices();
  return std::getenv("SUNDOG_TEST_DEVICES") ? all : all.first(1);
}

sundog::KernelDefines all_features() {
  using sundog::u32;
  sundog::KernelDefines defines;
  for (const char* shape : {"HAS_MESH", "HAS_BVH", "HAS_SDF"}) defines[shape] = "1";
#define SUNDOG_DEFINE_SOLID(constant, type, name, effect) defines["HAS_" #constant] = "1";
  SOLIDS(SUNDOG_DEFINE_SOLID)
#undef SUNDOG_DEFINE_SOLID
#define SUNDOG_DEFINE_FEATURE(type, definition, name, effect) \
  defines[#definition] = std::is_same_v<type, bool> ? "1" : "3";
  SCENE_FEATURES(SUNDOG_DEFINE_FEATURE)
#undef SUNDOG_DEFINE_FEATURE
  defines["SAMPLER"] = std::to_string(SAMPLER_AUTO);
  return defines;
}

sundog::Program build_text(sundog::Device& device, const std::string& text,
                           const sundog::KernelDefines& defines) {
  sundog::KernelDefines all = defines;
  all.merge(all_features());
  return device.build("test.cl", all, nullptr, {{"test.cl", text}});
}
