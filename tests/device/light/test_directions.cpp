// Sines, cosines and arc cosines of the lanes (plain/path/directions.cl) against double precision.
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.h"
#include "devices.h"

using namespace sundog;

namespace {

// Writes the sine and cosine of each number as a share of a circle, and the arc cosine of each in [-1, 1].
const char* const text = R"(
  #include "lib/core/lanes.h"
  #include "plain/path/directions.cl"
  #include "shared/types.h"
  kernel void run(global const float* in, global float4* out, u32 count) {
    const u32 i = get_global_id(0);
    if (i >= count) return;
    REAL sine, cosine;
    sincos_of_turn((REAL)(in[i]), &sine, &cosine, ALL_LANES);
    const REAL angle = real_acos(real_clamp((REAL)(in[i]), (REAL)(-1.0f), (REAL)(1.0f)), ALL_LANES);
    out[i] = (float4)(REAL_LANE(sine, LANES - 1), REAL_LANE(cosine, LANES - 1), REAL_LANE(angle, LANES - 1), 0.0f);
  })";

}  // namespace

TEST_CASE("sines, cosines and arc cosines of the lanes are those of double precision") {
  std::vector<float> inputs{-1, -0.5f, 0, 0.125f, 0.25f, 0.5f, 0.75f, 1, 2};
  for (int k = -4000; k <= 8000; ++k) inputs.push_back(static_cast<float>(k) / 4000);
  for (int k = 1; k < 40; ++k) inputs.push_back(1 - std::ldexp(1.0f, -k));
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto found = run_text<float4>(device, text, inputs);
    double sine = 0, cosine = 0, angle = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double x = double(inputs[i]), turn = 2 * std::numbers::pi * x;
      sine = std::max(sine, std::abs(double(found[i].x) - std::sin(turn)));
      cosine = std::max(cosine, std::abs(double(found[i].y) - std::cos(turn)));
      if (std::abs(x) <= 1) angle = std::max(angle, std::abs(double(found[i].z) - std::acos(x)));
    }
    CHECK(sine <= 1.2e-7);
    CHECK(cosine <= 1.2e-7);
    CHECK(angle <= 3e-7);
  });
}
