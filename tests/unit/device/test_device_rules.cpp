// Options of compilers go to the drivers that know them.
#include "device/device_rules.h"

#include <fmt/format.h>

#include "base/environment.h"
#include "catch.h"
#include "device/build_options.h"

using namespace sundog;

namespace {

DeviceInfo gpu(const std::string& vendor, const std::string& platform) {
  DeviceInfo device;
  device.type = "gpu";
  device.device_class = DeviceClass::gpu;
  device.vendor = vendor;
  device.platform_name = platform;
  return device;
}

std::string options_of(const DeviceInfo& device, const std::string& entry) {
  return all_build_options(device, {}, {.entry = "entry/" + entry + ".cl"});
}

}  // namespace

TEST_CASE("paths get more registers by Intel's own driver, and nothing by others that they may refuse") {
  const DeviceInfo own = gpu("Intel(R) Corporation", "Intel(R) OpenCL Graphics");
  const std::string paths = options_of(own, "render_path");
  CHECK_THAT(paths, ContainsSubstring("-cl-intel-256-GRF-per-thread"));
  CHECK_THAT(options_of(own, "trace_photons"), ContainsSubstring("-cl-intel-256-GRF-per-thread"));
  CHECK_THAT(options_of(own, "render_whitted"), !ContainsSubstring("-cl-intel-256-GRF-per-thread"));
  CHECK_THAT(options_of(own, "trace_rays"),
             ContainsSubstring("-DDEVICE_SUBGROUP=16") && ContainsSubstring("-cl-intel-256-GRF-per-thread"));
  for (const char* platform : {"rusticl", "Intel Gen OCL Driver", "Apple"}) {
    const std::string others = options_of(gpu("Intel", platform), "render_path");
    CHECK_THAT(others, ContainsSubstring("-DNODE_LOOP=2") && !ContainsSubstring("-cl-intel"));
  }
}

TEST_CASE("NVIDIA's tracer by itself takes half the registers") {
  const DeviceInfo nvidia = gpu("NVIDIA Corporation", "NVIDIA CUDA");
  CHECK_THAT(options_of(nvidia, "trace_rays"), ContainsSubstring("-cl-nv-maxrregcount=64"));
  CHECK_THAT(options_of(nvidia, "render_path"), ContainsSubstring("-cl-nv-maxrregcount=128"));
}

TEST_CASE("a tuning's options take the place of the rule's, and a user's take theirs") {
  DeviceInfo nvidia = gpu("NVIDIA Corporation", "NVIDIA CUDA");
  const auto with = [&](const std::string& options) {
    return all_build_options(nvidia, {.tuned = options}, {.entry = "entry/render_path.cl"});
  };
  for (const char* entry : {"aov", "trace_photons", "light_media"})  // tune compared none of theirs
    CHECK_THAT(
        all_build_options(nvidia, {.tuned = "-DNODE_LOOP=2"}, {.entry = fmt::format("entry/{}.cl", entry)}),
        !ContainsSubstring("NODE_LOOP"));
  const std::string tuned = with("-cl-nv-maxrregcount=96");
  CHECK_THAT(tuned, ContainsSubstring("=96"));
  CHECK_THAT(portable_options(nvidia, tuned), !ContainsSubstring("-cl-nv"));  // where the driver refuses it
  CHECK(with("") == "-cl-std=CL1.2 -cl-kernel-arg-info -DDEVICE_INLINES_ALL -cl-nv-maxrregcount=128");
  CHECK(with("-cl-nv-maxrregcount=96 -DNODE_LOOP=2 !-DDEVICE_INLINES_ALL") ==
        "-cl-std=CL1.2 -cl-kernel-arg-info -cl-nv-maxrregcount=96 -DNODE_LOOP=2");
  HostEnvironment environment;
  environment.build_options = "-cl-nv-maxrregcount=64";
  nvidia.environment = std::make_shared<const HostEnvironment>(environment);
  CHECK(with("-cl-nv-maxrregcount=96") ==
        "-cl-std=CL1.2 -cl-kernel-arg-info -DDEVICE_INLINES_ALL -cl-nv-maxrregcount=64");
  for (const std::vector<std::string>& values : options_to_try(nvidia, "entry/render_path.cl", true))
    CHECK_THAT(values.front(), !ContainsSubstring("maxrregcount"));  // the user has decided
}

TEST_CASE("tune tries options of a device's rule by name, those that change a build") {
  using Lists = std::vector<std::vector<std::string>>;
  const auto to_try = [](const DeviceInfo& device, const char* entry, bool compact = true) {
    return options_to_try(device, fmt::format("entry/{}.cl", entry), compact);
  };
  CHECK(to_try(DeviceInfo(), "render_path") == Lists{{"-DNODE_LOOP=1", "-DNODE_LOOP=2"}});
  CHECK(to_try(DeviceInfo(), "render_path", false).empty());
  CHECK(to_try(gpu("NVIDIA Corporation", "NVIDIA CUDA"), "render_path") ==
        Lists{{"!-DDEVICE_INLINES_ALL"},
              {"-DNODE_LOOP=1", "-DNODE_LOOP=2"},
              {"-cl-nv-maxrregcount=96", "-cl-nv-maxrregcount=168", "!-cl-nv-maxrregcount"}});
  const DeviceInfo intel = gpu("Intel(R) Corporation", "Intel(R) OpenCL Graphics");
  const auto registers_of = [&](const char* entry) { return to_try(intel, entry)[2]; };
  CHECK(registers_of("render_path") == std::vector<std::string>{"!-cl-intel-256-GRF-per-thread"});
  CHECK(registers_of("render_whitted") == std::vector<std::string>{"-cl-intel-256-GRF-per-thread"});
}

TEST_CASE("without its maker's options a device is built for with all the others") {
  const DeviceInfo intel = gpu("Intel(R) Corporation", "Intel(R) OpenCL HD Graphics");
  const std::string portable = portable_options(intel, options_of(intel, "render_path") + " -DMORE=1");
  CHECK_THAT(portable, !ContainsSubstring("-cl-intel") && ContainsSubstring("-cl-std=CL1.2 ") &&
                           ContainsSubstring("-DDEVICE_INLINES_ALL") && ContainsSubstring("-DMORE=1"));
  const DeviceInfo nvidia = gpu("NVIDIA Corporation", "NVIDIA CUDA");
  for (const char* entry : {"render_path", "trace_rays"})
    CHECK_THAT(portable_options(nvidia, options_of(nvidia, entry)), !ContainsSubstring("-cl-nv"));
  const DeviceInfo any = gpu("Acme", "Acme");
  const std::string options = options_of(any, "render_path");
  CHECK(portable_options(any, options) == options);
}

TEST_CASE("an option that begins with a rule's option replaces none") {
  DeviceInfo nvidia = gpu("NVIDIA Corporation", "NVIDIA CUDA"), amd = gpu("Advanced Micro Devices", "AMD");
  HostEnvironment environment;
  environment.build_options = "-DNODE_LOOP2=1 -DMORE=-DDEVICE_WAVES -cl-nv-maxrregcount=12 -cl-nv";
  nvidia.environment = amd.environment = std::make_shared<const HostEnvironment>(environment);
  CHECK_THAT(options_of(amd, "render_path"), ContainsSubstring(" -DNODE_LOOP=2 -DDEVICE_WAVES=10 "));
  const std::string own = options_of(nvidia, "render_path");
  CHECK_THAT(own, !ContainsSubstring("maxrregcount=128") && !ContainsSubstring("maxrregcount=64"));
  CHECK_THAT(portable_options(nvidia, own), ContainsSubstring(" -cl-nv-maxrregcount=12 -cl-nv"));
  environment.build_options = "!-DNODE_LOOP -DMORE";  // takes away, and is no option itself
  amd.environment = std::make_shared<const HostEnvironment>(environment);
  CHECK_THAT(options_of(amd, "render_path"), !ContainsSubstring("NODE_LOOP") && ContainsSubstring("-DMORE"));
}
