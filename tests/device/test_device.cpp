// Devices at work: launches, memory, failures, times.
#include "base/error.h"
#include "catch.h"
#include "devices.h"

using namespace sundog;

TEST_CASE("a launch covers exactly the items it was asked for, whatever the local size") {
  const std::string text = R"(
    #include "shared/types.h"
    kernel void square(global const float* in, global float* out, u32 count) {
      const u32 i = get_global_id(0);
      if (i < count) out[i] = in[i] * in[i];
    })";
  for (const DeviceInfo& info : test_devices()) DYNAMIC_SECTION(info.label()) {
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
