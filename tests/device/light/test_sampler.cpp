// Sample values: where camera samples lie in their pixels.
#include <array>
#include <set>

#include "catch.h"
#include "devices.h"

using namespace sundog;

namespace {

struct Pixel {
  u32 x, y, sample, samples;
};

struct Place {
  float a, b, first, second;
};

const char* const text = R"(
#include "lib/core/sampler.cl"
typedef struct Pixel { u32 x, y, sample, samples; } Pixel;
typedef struct Place { float a, b, first, second; } Place;
__kernel void run(__global const Pixel* in, __global Place* out, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const uint2 pixel = (uint2)(in[i].x, in[i].y);
  const float2 at = pixel_sample(pixel, in[i].sample, in[i].samples);
  const float2 two = sample_2d(pixel, in[i].sample, 4u);
  out[i].a = at.x, out[i].b = at.y, out[i].first = two.x, out[i].second = two.y;
}
)";

}  // namespace

TEST_CASE("camera samples: one is the pixel's centre, 64 fill each 64th of both axes once") {
  constexpr u32 count = 64;
  std::vector<Pixel> in{{3, 5, 0, 1}};
  for (u32 sample = 0; sample < count; ++sample) in.push_back({17, 9, sample, count});
  for (const DeviceInfo& info : test_devices()) DYNAMIC_SECTION(info.label()) {
      Device device(info);
      const auto out = run_text<Place>(device, text, in);
      CHECK((out[0].a == 0.5f && out[0].b == 0.5f));
      std::set<int> columns, rows;
      double first = 0, second = 0, product = 0;
      for (std::size_t i = 1; i < out.size(); ++i) {
        for (const float x : {out[i].a, out[i].b, out[i].first, out[i].second}) REQUIRE((x >= 0 && x < 1));
        columns.insert(static_cast<int>(out[i].a * count));
        rows.insert(static_cast<int>(out[i].b * count));
        first += out[i].first / count;
        second += out[i].second / count;
        product += (out[i].first - 0.5) * (out[i].second - 0.5) / count;
      }
      CHECK(columns.size() == count);
      CHECK(rows.size() == count);
      // Four standard deviations.
      CHECK(first == Approx(0.5).margin(0.15));
      CHECK(second == Approx(0.5).margin(0.15));
      CHECK(product == Approx(0).margin(0.045));
    }
}
