#include "devices.h"

#include <cstdlib>
#include <sstream>

#include "catch.h"

void prepare_opencl_environment() {
  setenv("RUSTICL_ENABLE", "llvmpipe", 0);
  // Tests move XDG_CACHE_HOME about; Mesa's own cache stays where it is.
  const char *xdg = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
  if (xdg && *xdg)
    setenv("MESA_SHADER_CACHE_DIR", xdg, 0);
  else if (home)
    setenv("MESA_SHADER_CACHE_DIR", (std::string(home) + "/.cache").c_str(), 0);
}

const std::vector<sundog::DeviceInfo>& test_devices() {
  static const std::vector<sundog::DeviceInfo> devices = [] {
    const char* listed = std::getenv("SUNDOG_TEST_DEVICES");
    std::istringstream in(listed ? listed : "all");
    std::vector<std::string> specs;
    for (std::string spec; std::getline(in, spec, ',');) specs.push_back(spec);
    return sundog::select_devices(sundog::enumerate_devices(), specs);
  }();
  return devices;
}

sundog::Program build_text(sundog::Device& device, const std::string& text,
                           const sundog::KernelDefines& defines) {
  return device.build("test.cl", defines, nullptr, {{"test.cl", text}});
}
