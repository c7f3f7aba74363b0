// Devices at work: launches, memory, failures, times.
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "base/error.h"
#include "catch.h"
#include "device/cl_status.h"
#include "devices.h"

using namespace sundog;

TEST_CASE("a launch covers exactly the items it was asked for, whatever the local size") {
  const std::string text = R"(
    #include "shared/types.h"
    kernel void square(global const float* in, global float* out, u32 count) {
      const u32 i = get_global_id(0);
      if (i < count) out[i] = in[i] * in[i];
    })";
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    auto square = build_text(device, text).kernel<Buffer<float>, Buffer<float>, u32>("square");
    std::vector<float> values(1009);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    const auto in = device.upload<float>(values);
    for (const std::size_t local : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{64}}) {
      auto out = device.upload<float>(std::vector<float>(values.size() + 64, -1.0f));
      device.run(square, {.x = 1000, .local_x = local}, in, out, 1000u);
      std::vector<float> result(out.count);
      device.read(out, std::span<float>(result));
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < result.size(); ++i)
        wrong += result[i] != (i < 1000 ? values[i] * values[i] : -1.0f);
      CHECK(wrong == 0);
    }
    device.finish();
    CHECK(device.times().at("square").launches == 4);
    CHECK(device.times().at("square").host_ms > 0);
  });
}

TEST_CASE("a launch's time by the driver's events is none or one that it may have taken") {
  const std::string text = R"(
    __kernel void spin(__global uint* values, uint rounds) {
      uint x = values[get_global_id(0)];
      for (uint i = 0; i < rounds; ++i) x = x * 747796405u + 2891336453u;
      values[get_global_id(0)] = x;
    })";
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    auto spin = build_text(device, text).kernel<Buffer<u32>, u32>("spin");
    const auto values = device.upload<u32>(std::vector<u32>(256, 1));
    for (int i = 0; i < 20; ++i) {
      device.run(spin, {.x = 256}, values, u32{20'000});  // 5 million steps
      device.finish();
    }
    const double ms = device.times().at("spin").device_ms;
    CAPTURE(ms);
    CHECK((ms == 0 || ms > 20 * 1e-3));
  });
}

TEST_CASE("a two-dimensional launch is padded in both directions") {
  const std::string text = R"(
    __kernel void place(__global uint* seen, uint width, uint height) {
      const uint x = get_global_id(0), y = get_global_id(1);
      if (x < width && y < height) seen[y * width + x] += 1u + get_local_size(0) * 1000u + get_local_size(1) * 100000u;
    })";
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    auto place = build_text(device, text).kernel<Buffer<u32>, u32, u32>("place");
    const auto seen = device.upload<u32>(std::vector<u32>(13 * 7));
    device.run(place, {.x = 13, .y = 7, .local_x = 8, .local_y = 4}, seen, 13u, 7u);
    std::vector<u32> result(seen.count);
    device.read(seen, std::span<u32>(result));
    CHECK(result == std::vector<u32>(13 * 7, 408001u));
    CHECK_NOTHROW(device.run(place, {.x = 0, .y = 7}, seen, 13u, 7u));  // nothing to do
  });
}

TEST_CASE("reads and writes of a part of a buffer touch that part alone") {
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    auto buffer = device.upload<u32>(std::vector<u32>{0, 1, 2, 3, 4, 5});
    device.write<u32>(buffer, std::vector<u32>{20, 30}, 2);
    std::vector<u32> part(3);
    device.read(buffer, std::span<u32>(part), 1);
    CHECK(part == std::vector<u32>{1, 20, 30});
    CHECK(device.upload<u32>({}).count == 0);
    CHECK(device.upload<u32>(part).memory.getInfo<CL_MEM_SIZE>() == 12);  // no byte beyond the host's is read
  });
}

TEST_CASE("a failed call is a DeviceError that names the device and OpenCL's status") {
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    auto kernel = build_text(device, "__kernel void f(__global uint* a) { a[get_global_id(0)] = 1u; }")
                      .kernel<Buffer<u32>>("f");
    const auto buffer = device.make<u32>(64);
    const std::size_t local = info.max_work_group * 2;
    try {
      device.run(kernel, {.x = local, .local_x = local}, buffer);
      FAIL("the launch was taken");
    } catch (const DeviceError& error) {
      CHECK_THAT(error.what(), ContainsSubstring(info.label()));
      CHECK_THAT(error.what(), ContainsSubstring("launch of f"));
      CHECK_THAT(error.what(), ContainsSubstring(cl_status_name(error.status)));
      CHECK((error.status == CL_INVALID_WORK_GROUP_SIZE || error.status == CL_INVALID_WORK_ITEM_SIZE));
    }
    CHECK_THROWS_WITH(device.make<u32>(info.max_allocation / 2),
                      ContainsSubstring("CL_MEM_OBJECT_ALLOCATION_FAILURE"));
  });
}

TEST_CASE("a device with a problem is not opened") {
  DeviceInfo info;
  info.platform_name = "Clover";
  info.problem = "the platform has no device";
  CHECK_THROWS_WITH(Device(info), "0 Clover: the platform has no device");
}

namespace {

/// Processor time of each of this process's threads so far, in clock ticks.
std::map<std::string, double> thread_ticks() {
  std::map<std::string, double> ticks;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream in(task.path() / "stat");
    std::string text((std::istreambuf_iterator<char>(in)), {});
    std::istringstream fields(text.substr(std::min(text.size(), text.rfind(')') + 1)));
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    double user = 0, system = 0;
    fields >> user >> system;
    ticks[task.path().filename()] = user + system;
  }
  return ticks;
}

/// Threads that did at least a tenth of what all have done since `before`.
std::set<std::string> busy_threads(const std::map<std::string, double>& before) {
  std::map<std::string, double> used;
  double total = 0;
  for (const auto& [thread, ticks] : thread_ticks())
    total += used[thread] = ticks - (before.contains(thread) ? before.at(thread) : 0);
  std::set<std::string> busy;
  for (const auto& [thread, ticks] : used)
    if (ticks > 0.1 * total) busy.insert(thread);
  return busy;
}

constexpr const char* spinning = R"(
    __kernel void spin(__global float* out, uint rounds) {
      float x = (float)get_global_id(0);
      for (uint i = 0; i < rounds; ++i) x = sin(x) + 1.0f;
      out[get_global_id(0)] = x;
    })";

}  // namespace

TEST_CASE("a sub-device keeps as many processors busy as it has units, whatever the device has") {
  for (const DeviceInfo& whole : test_devices()) {
    if (whole.max_sub_devices == 0 && whole.compute_units > 1) {
      CHECK_THROWS_WITH(select_devices(test_devices(), {whole.name + "/1"}),
                        ContainsSubstring("cannot be split"));
      continue;
    }
    for (unsigned units = 1; units <= std::min(2u, whole.compute_units); ++units)
      DYNAMIC_SECTION(whole.label() << ", units: " << units) {
        const std::string spec = whole.name + "/" + std::to_string(units);
        Device device(select_devices(test_devices(), {spec}).at(0));
        auto spin = build_text(device, spinning).kernel<Buffer<float>, u32>("spin");
        const auto out = device.make<float>(4096);
        device.run(spin, {.x = 4096}, out, 1u);  // compiles
        device.finish();
        const auto before = thread_ticks();
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t processor = std::clock();
        device.run(spin, {.x = 4096}, out, 4000u);
        device.finish();
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        const double busy = static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC / seconds;
        INFO(seconds << " s");
        CHECK(busy < units + 0.2);  // less where others want the machine too
        CHECK(busy_threads(before).size() == units);
      }
  }
}

TEST_CASE("the same /1 twice is two sub-devices, which run on threads of their own") {
  for (const DeviceInfo& whole : test_devices()) {
    if (whole.max_sub_devices < 2) continue;
    const std::string spec = whole.name + "/1";
    const auto parts = select_devices(test_devices(), {spec, spec});
    REQUIRE(parts.size() == 2);
    std::vector<std::set<std::string>> busy;
    for (const DeviceInfo& part : parts) {
      Device device(part);
      auto spin = build_text(device, spinning).kernel<Buffer<float>, u32>("spin");
      const auto out = device.make<float>(4096);
      device.run(spin, {.x = 4096}, out, 1u);  // compiles
      device.finish();
      const auto before = thread_ticks();
      device.run(spin, {.x = 4096}, out, 4000u);
      device.finish();
      busy.push_back(busy_threads(before));
    }
    CHECK(busy[0].size() == 1);
    CHECK(busy[0] != busy[1]);
  }
}

TEST_CASE("sub-devices are opened and closed while the driver's threads end their work") {
  for (const DeviceInfo& whole : test_devices()) {
    if (whole.max_sub_devices < 2) continue;
    const std::string spec = whole.name + "/1";
    const auto parts = select_devices(test_devices(), {spec, spec});
    std::vector<u32> values(1000);
    std::iota(values.begin(), values.end(), 0u);
    for (int i = 0; i < 300; ++i) {
      Device device(parts[static_cast<std::size_t>(i) % 2]);
      const auto buffer = device.upload<u32>(values);
      std::vector<u32> back(values.size());
      device.read(buffer, std::span<u32>(back));
      CHECK((back == values));
    }
  }
}

// Hidden: run under Oclgrind alone, to see that it notices (tests/CMakeLists.txt).
TEST_CASE("a kernel writes past the end of its buffer", "[.][out-of-bounds]") {
  Device device(test_devices().front());
  auto stray =
      build_text(device, "__kernel void stray(__global float* a) { a[get_global_id(0) + 64] = 1.0f; }")
          .kernel<Buffer<float>>("stray");
  const auto buffer = device.make<float>(64);
  device.run(stray, {.x = 1, .local_x = 1}, buffer);
  device.finish();
}
