#include "devices.h"

#include <cstdlib>
#include <sstream>

#include "catch.h"

void prepare_opencl_environment() { setenv("RUSTICL_ENABLE", "llvmpipe", 0); }

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
