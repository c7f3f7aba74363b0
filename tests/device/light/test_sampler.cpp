// Sample values: where camera samples lie in their pixels.
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "devices.h"
#include "scene/load.h"
#include "scenes.h"
#include "shared/sampler.h"

using namespace sundog;

namespace {

struct Pixel {
  u32 x, y, sample, samples;
};

struct Place {
  float a, b, first, second;
};

constexpr u32 dimension = 4;

const char* const text = R"(
#include "lib/core/sampler_lanes.cl"
typedef struct Pixel { u32 x, y, sample, samples; } Pixel;
typedef struct Place { float a, b, first, second; } Place;
__kernel void run(__global const Pixel* in, __global Place* out, u32 count) {
  const u32 i = get_global_id(0);
  if (i >= count) return;
  const LaneSamples at = {(MASK)((int)in[i].x), (MASK)((int)in[i].y), (MASK)((int)in[i].sample)};
  REAL a, b, first, second;
  places_in_pixels(&at, ALL_LANES, in[i].samples, &a, &b);
  pair_lanes(&at, (MASK)(4), false, &first, &second);
  out[i].a = REAL_LANE(a, 0), out[i].b = REAL_LANE(b, 0);
  out[i].first = REAL_LANE(first, 0), out[i].second = REAL_LANE(second, 0);
}
)";

/// Four numbers of each lane.
const char* const lanes_text = R"(
#include "lib/core/sampler_lanes.cl"
typedef struct Pixel { u32 x, y, sample, samples; } Pixel;
__kernel void run(__global const Pixel* in, __global float4* out, u32 count) {
  const u32 first = get_global_id(0) / LANES * LANES, mine = get_global_id(0) - first;
  if (first + LANES > count) return;
  LaneSamples at;
  at.seed = 0u;
  for (u32 lane = 0; lane < LANES; ++lane) {
    MASK_LANE(at.x, lane) = (int)in[first + lane].x;
    MASK_LANE(at.y, lane) = (int)in[first + lane].y;
    MASK_LANE(at.sample, lane) = (int)in[first + lane].sample;
  }
  const FourNumbers u = chosen_lanes(&at, (MASK)(4), true, true);
  out[first + mine] = (float4)(REAL_LANE(u.x, mine), REAL_LANE(u.y, mine), REAL_LANE(u.z, mine), REAL_LANE(u.w, mine));
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

TEST_CASE("a device's samples are the host's to the bit") {
  std::vector<Pixel> in;
  for (u32 i = 0; i < 4096; ++i) in.push_back({i * 7, i / 5, i * i, 4});
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto out = run_text<Place>(device, text, in, {{"SAMPLER", std::to_string(SAMPLER_SOBOL)}});
    const auto unit = [](u32 bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; };
    const auto of = [&](const Pixel& at, u32 d) { return unit(sobol_bits(at.x, at.y, at.sample, d)); };
    for (std::size_t i = 0; i < in.size(); ++i) {
      REQUIRE(out[i].a == of(in[i], DIMENSION_PIXEL));
      REQUIRE(out[i].b == of(in[i], DIMENSION_PIXEL + 1));
      REQUIRE(out[i].first == of(in[i], dimension));
      REQUIRE(out[i].second == of(in[i], dimension + 1));
    }
    const auto four = run_text<float4>(
        device, lanes_text, in,
        {{"SAMPLER", std::to_string(SAMPLER_SOBOL)}, {"TILE_W", "4"}, {"TILE_H", "4"}, {"LANES", "16"}});
    for (std::size_t i = 0; i < in.size(); ++i)
      for (u32 k = 0; k < 4; ++k) {
        const float found[] = {four[i].x, four[i].y, four[i].z, four[i].w};
        REQUIRE(found[k] == of(in[i], dimension + k));
      }
  });
}

TEST_CASE("a device's blue noise is the host's to the bit") {
  std::vector<Pixel> in;
  for (u32 i = 0; i < 1024; ++i) in.push_back({i * 7, i / 5, i & 15u, 16});
  const std::map<std::string, std::string> defines{{"SAMPLER", std::to_string(SAMPLER_BLUE_NOISE)},
                                                   {"SAMPLE_ROOM", "4"}};
  on_every_device([&](const DeviceInfo& info) {
    Device device(info);
    const auto out = run_text<Place>(device, text, in, defines);
    const auto of = [&](const Pixel& at, u32 d) {
      return static_cast<float>(blue_noise_bits(at.x, at.y, at.sample, 4, d) >> 8) * 0x1p-24f;
    };
    std::map<std::string, std::string> lanes = defines;
    lanes.insert({{"TILE_W", "2"}, {"TILE_H", "2"}, {"LANES", "4"}});
    const auto four = run_text<float4>(device, lanes_text, in, lanes);
    for (std::size_t i = 0; i < in.size(); ++i) {
      REQUIRE(out[i].a == of(in[i], DIMENSION_PIXEL));
      REQUIRE(out[i].second == of(in[i], dimension + 1));
      const float found[] = {four[i].x, four[i].y, four[i].z, four[i].w};
      for (u32 k = 0; k < 4; ++k) REQUIRE(found[k] == of(in[i], dimension + k));
    }
  });
}

TEST_CASE("blue noise errs less than Sobol's sequence of each pixel once it is blurred") {
  SceneDescription scene = load_scene(SUNDOG_SOURCE_DIR "/scenes/soft_light.json");
  scene.image.width = scene.image.height = 64;
  scene.camera.position.z = 4;                  // the back wall and the floor alone
  for (LightDescription& light : scene.lights)  // a rectangle that is seen whole would have no error
    if (light.type == LightType::rectangle) light.type = LightType::disk, light.radius = light.size[0] / 2;
  const DeviceInfo& info = test_devices().front();
  const auto picture = [&](u32 sampler, int samples) {
    scene.render.sampler = sampler;
    scene.render.samples = samples;
    if (sampler == SAMPLER_SOBOL) return scenes::render_on(info, scene).image;
    return render(compile(scene), {info}).image;  // its own kernels take less to build than general ones
  };
  const Image right = picture(SAMPLER_SOBOL, 256);
  const auto error = [&](const Image& image) {  // of means of 4x4 pixels
    double sum = 0;
    for (int y = 0; y < 64; y += 4)
      for (int x = 0; x < 64; x += 4) {
        double mean = 0;
        for (int i = 0; i < 16; ++i)
          mean += double(image.pixel(x + i % 4, y + i / 4)[0]) - double(right.pixel(x + i % 4, y + i / 4)[0]);
        sum += mean * mean;
      }
    return std::sqrt(sum);
  };
  for (const int samples : {1, 4})
    CHECK(error(picture(SAMPLER_BLUE_NOISE, samples)) < 0.85 * error(picture(SAMPLER_SOBOL, samples)));
  scene.render.sampler = SAMPLER_SOBOL;
  CHECK(compile(scene).features.sample_room == 0);
  scene.render.sampler = SAMPLER_BLUE_NOISE;
  scene.render.samples = 5;
  CHECK(compile(scene).features.sample_room == 3);
}

TEST_CASE("stratified and regular samples have a cell of a grid each") {
  for (const u32 count : {1u, 4u, 6u, 7u, 64u}) {
    std::vector<Pixel> in;
    for (u32 sample = 0; sample < count; ++sample) in.push_back({17, 9, sample, count});
    u32 columns = static_cast<u32>(std::sqrt(count));
    while (count % columns) --columns;
    const u32 rows = count / columns;
    on_every_device([&](const DeviceInfo& info) {
      Device device(info);
      for (const u32 sampler : {SAMPLER_STRATIFIED, SAMPLER_REGULAR}) {
        const auto out = run_text<Place>(device, text, in, {{"SAMPLER", std::to_string(sampler)}});
        std::set<u32> cells;
        for (const Place& at : out) {
          REQUIRE((at.a >= 0 && at.a < 1 && at.b >= 0 && at.b < 1));
          cells.insert(static_cast<u32>(at.a * float(columns)) * rows + static_cast<u32>(at.b * float(rows)));
          if (sampler == SAMPLER_REGULAR)
            CHECK(at.a * float(columns) - std::floor(at.a * float(columns)) == Approx(0.5).epsilon(1e-5));
        }
        CHECK(cells.size() == count);
      }
    });
  }
}
