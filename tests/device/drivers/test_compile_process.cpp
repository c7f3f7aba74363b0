// Programs that another process builds ahead: what it made is what runs, and its failure is no one's.
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "base/environment.h"
#include "base/error.h"
#include "base/faults.h"
#include "base/memory_file.h"
#include "catch.h"
#include "compile/compiled_scene.h"
#include "device/compile_process.h"
#include "devices.h"
#include "path_testing.h"
#include "render/device/frame_kernels.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

const GeneratedFiles files = {{"add.cl", R"(
__kernel void add(__global float* values, float what, uint count) {
  const uint i = get_global_id(0);
  if (i < count) values[i] += what;
}
)"}};
using AddKernel = Kernel<Buffer<float>, float, u32>;

struct Ended : StartedProgram {
  explicit Ended(ProgramEnd as) : how(as) {}
  std::optional<ProgramEnd> ended() override { return how; }
  void end() override {}
  ProgramEnd how;
};

std::string text_of(int file) {
  std::string text(std::size_t{1} << 20, '\0');
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(::pread(file, text.data(), text.size(), 0), 0)));
  return text;
}

/// Stands for the processes that would be started: keeps what they are asked for. Where `works`, it builds in
/// this process a program that adds twice as much.
struct StandIn {
  std::vector<std::string> asked;
  bool works = true;
  ProgramEnd failure{1, 0};

  std::unique_ptr<StartedProgram> start(const std::vector<std::string>& arguments,
                                        const std::vector<HandedDown>& descriptors) {
    asked.push_back(text_of(descriptors[0].here));
    std::string text = asked.back();
    const std::size_t at = text.find("+= what");
    if (!works || at == std::string::npos) return std::make_unique<Ended>(failure);
    const int in = memory_file(text.replace(at, 7, "+= 2 * what"));
    serve_compile(nullptr, arguments.at(1), in, descriptors[1].here);
    ::close(in);
    return std::make_unique<Ended>(ProgramEnd{});
  }
};

/// The device with a cache of its own, and with processes that the stand-in is asked for.
DeviceInfo with(const DeviceInfo& info, StandIn& stand_in, const TemporaryFolder& cache,
                const std::string& faults = "") {
  HostEnvironment environment = value_of(info.environment);
  environment.cache = cache.path();
  environment.kernel_cache = true;
  if (!faults.empty()) environment.faults = std::make_shared<Faults>(faults);
  environment.start_program = [&](const std::vector<std::string>& arguments,
                                  const std::vector<HandedDown>& descriptors) {
    return stand_in.start(arguments, descriptors);
  };
  DeviceInfo changed = info;
  changed.environment = std::make_shared<const HostEnvironment>(std::move(environment));
  return changed;
}

bool begin(Device& device) {
  return device.build_ahead("add.cl", {}, AddKernel::empty_launch("add", 64), files);
}

float sum_of(Device& device, BuildReport& report) {
  auto add = device.build("add.cl", {}, &report, files).kernel<Buffer<float>, float, u32>("add");
  const auto values = device.upload<float>(std::vector<float>(64, 1.0f));
  device.run(add, {.x = 64, .local_x = 64}, values, 3.0f, 64u);
  std::vector<float> result(64);
  device.read(values, std::span<float>(result));
  return result[63];
}

/// Devices of drivers that cannot build two programs at once.
std::vector<DeviceInfo> slow_builders() {
  std::vector<DeviceInfo> devices;
  for (const DeviceInfo& device : test_devices())
    if (device.platform_name == "Portable Computing Language" && device.type == "cpu")
      devices.push_back(device);
  if (std::thread::hardware_concurrency() < 2) devices.clear();
  return devices;
}

}  // namespace

TEST_CASE("a program that another process has built ahead is the one that runs, and is cached") {
  for (const DeviceInfo& info : slow_builders()) {
    StandIn stand_in;
    const TemporaryFolder cache;
    BuildReport report;
    {
      Device device(with(info, stand_in, cache));
      CHECK(begin(device));
      CHECK(begin(device));
      CHECK(sum_of(device, report) == 7);
      CHECK_FALSE(report.cached);
      CHECK_FALSE(begin(device));
    }
    Device device(with(info, stand_in, cache));
    CHECK_FALSE(begin(device));
    CHECK(sum_of(device, report) == 7);
    CHECK(report.cached);
    REQUIRE(stand_in.asked.size() == 1);
    CHECK(stand_in.asked[0].find("\nadd 64 1 0 4 4\n") != std::string::npos);
  }
}

TEST_CASE("what another process cannot build, or is killed at, is built here") {
  for (const DeviceInfo& info : slow_builders())
    for (const ProgramEnd failure : {ProgramEnd{1, 0}, ProgramEnd{0, 9}, ProgramEnd{0, 0}}) {
      StandIn stand_in{{}, false, failure};
      const TemporaryFolder cache;
      Device device(with(info, stand_in, cache));
      BuildReport report;
      CHECK(begin(device));
      CHECK(sum_of(device, report) == 4);
      CHECK(report.note.empty());
    }
}

TEST_CASE("nothing is built ahead where a driver can build beside, or no process can be started") {
  for (const DeviceInfo& info : test_devices()) {
    StandIn stand_in;
    const TemporaryFolder cache;
    DeviceInfo alone = with(info, stand_in, cache);
    if (info.platform_name == "Portable Computing Language") {
      HostEnvironment environment = value_of(alone.environment);
      environment.start_program = {};
      alone.environment = std::make_shared<const HostEnvironment>(std::move(environment));
    }
    Device device(alone);
    CHECK_FALSE(begin(device));
    CHECK(stand_in.asked.empty());
  }
}

TEST_CASE("an empty launch changes nothing, and what it made ready is cached") {
  on_every_device([&](const DeviceInfo& info) {
    StandIn stand_in{{}, false};
    const TemporaryFolder cache;
    {
      Device device(with(info, stand_in, cache));
      auto add = device.build("add.cl", {}, nullptr, files).kernel<Buffer<float>, float, u32>("add");
      device.make_ready(add, 64);
      CHECK(device.times().empty());
    }
    Device device(with(info, stand_in, cache));
    BuildReport report;
    CHECK(sum_of(device, report) == 4);
    CHECK(report.cached);
  });
}

TEST_CASE("the kernel of photons is begun before the integrator's is built") {
  for (const DeviceInfo& info : slow_builders()) {
    SceneDescription scene = paths::path_scene({0, 0.6, 2}, {0, 0, 0}, 1);
    scene.render.caustics = true;
    scene.lights.push_back(paths::lamp(LightType::point, {0, 3, 0}, 4));
    scenes::place(scene, SphereShape{0.5}, scenes::add_dielectric(scene, 1.5));
    const CompiledScene compiled = compile(scene);
    REQUIRE(compiled.features.caustics);
    StandIn stand_in{{}, false};
    const TemporaryFolder cache;
    Device device(with(info, stand_in, cache,
                       "build@" + std::to_string(info.platform) + ":" + std::to_string(info.device)));
    RenderTimes times;
    FrameKernels kernels;
    CHECK_THROWS_AS(update_frame_kernels(device, compiled, {}, {}, false, kernels, times), BuildError);
    REQUIRE(stand_in.asked.size() == 1);
    CHECK(stand_in.asked[0].find("\ntrace_photons 4 1 0 ") != std::string::npos);
  }
}
