// Distance estimates on devices: never too long, and the same for every number of lanes.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "sdf_bound.h"
#include "sdf_testing.h"
#include "sdf_values.h"

using namespace sundog;

TEST_CASE(
    "no distance estimate is longer than the way to the surface, but for the exceptions that the list "
    "states") {
  const auto descriptions = listed_fields();
  const CompiledFields fields = compile_fields(descriptions);
  on_every_device([&](const DeviceInfo& info) {
    if (!is_quick(info)) return;
    Device device(info);
    BoundTester tester(device, fields);
    for (u32 f = 0; f < descriptions.size(); ++f) {
      const double exceptions = descriptions[f].root.formula.steps[0].definition.exceptions;
      INFO(descriptions[f].name);
      check_bound(tester.ratios(f, 102400), exceptions);
    }
    device.finish();
  });
}

TEST_CASE("an estimate has the same bits for 1, 4, 8 and 16 lanes where it uses no transcendental function") {
  std::vector<SdfDescription> exact, rounded;
  for (const FormulaDefinition& d : formula_list())
    (uses_transcendentals(d) ? rounded : exact).push_back(default_field(d));
  CHECK(exact.size() >= 20);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    auto chosen = exact;
    if (!is_quick(info)) chosen = {listed_field("torus")};
    const CompiledFields fields = compile_fields(chosen);
    const u32 count = is_quick(info) ? 4096 : 64;
    const auto wanted = values_of(device, fields, chosen, 1, count);
    for (const int lanes : {4, 8, 16}) {
      if (!is_quick(info) && lanes != 4) continue;
      const auto found = values_of(device, fields, chosen, lanes, count);
      REQUIRE(found.size() == wanted.size());
      if (lanes == 16) check_interpreted(device, fields, chosen, lanes, count, found);
      for (std::size_t f = 0; f < chosen.size(); ++f) {
        const std::size_t first = f * numbers_a_point * count;
        std::size_t different = 0;
        for (std::size_t i = first; i < first + numbers_a_point * count; ++i)
          different += std::memcmp(&wanted[i], &found[i], sizeof(float)) != 0;
        INFO(chosen[f].name << ", " << lanes << " lanes");
        CHECK(different == 0);
      }
    }
  });
}

namespace {

/// A kernel that gives a function of lib/core/lanes.h for each number.
std::string kernel_of(const std::string& function) {
  return R"(
    #include "lib/core/lanes.h"
    #include "shared/types.h"
    kernel void run(global const float* in, global float* out, u32 count) {
      const u32 i = get_global_id(0);
      if (i >= count) return;
      const REAL y = )" +
         function + R"(((REAL)(in[i]));
      out[i] = REAL_LANE(y, LANES - 1);
    })";
}

}  // namespace

TEST_CASE("the rounded inverse of the lanes is the nearest number, or the next where all bits are set") {
  const std::string text = kernel_of("rounded_inverse");
  const float all_bits = std::nextafter(2.0f, 1.0f);
  std::vector<float> inputs;
  for (int e = -122; e <= 124; ++e) {
    for (int k = 0; k < 61; ++k)
      inputs.push_back(
          std::ldexp(1 + static_cast<float>((61 * (e + 122) + k) * 137'491L % 8'388'607) * 0x1p-23f, e));
    inputs.push_back(-std::ldexp(all_bits, e));
  }
  const DeviceInfo info = test_devices().front();
  Device device(info);
  for (const char* lanes : {"1", "4", "8", "16"}) {
    const auto found = run_text<float>(device, text, inputs, {{"LANES", lanes}});
    std::size_t off = 0, far = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const float wanted = 1 / inputs[i];
      if (found[i] == wanted) continue;
      far += found[i] != std::nextafter(wanted, 0.0f);
      off += std::abs(std::ldexp(inputs[i], -std::ilogb(inputs[i]))) != all_bits;
    }
    CHECK(off == 0);
    CHECK(far == 0);
  }
}

TEST_CASE("the logarithm of the lanes is within two units in the last place") {
  const std::string text = kernel_of("real_log");
  std::vector<float> inputs;
  for (int e = -126; e <= 126; ++e)
    for (int k = 0; k < 64; ++k) inputs.push_back(std::ldexp(1.0f + static_cast<float>(k) / 64, e));
  for (int k = -2000; k <= 2000; ++k) inputs.push_back(1.0f + static_cast<float>(k) * 1e-4f);
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    for (const char* lanes : {"1", is_quick(info) ? "16" : "4"}) {
      const auto found = run_text<float>(device, text, inputs, {{"LANES", lanes}});
      double worst = 0;
      for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double wanted = std::log(static_cast<double>(inputs[i]));
        const double unit = std::max(
            std::abs(std::nextafter(static_cast<float>(wanted), 1e30f) - static_cast<float>(wanted)), 5e-8f);
        worst = std::max(worst, std::abs(static_cast<double>(found[i]) - wanted) / unit);
      }
      CHECK(worst <= 2);
    }
  });
}
