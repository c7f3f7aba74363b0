// Many lights: a surface that chooses among them receives what it would of all.
#include <algorithm>
#include <cmath>
#include <vector>

#include "catch.h"
#include "compile/compiled_scene.h"
#include "devices.h"
#include "scenes.h"

using namespace sundog;
using glm::dvec3;

namespace {

/// A white floor under `count` balls of light here and there, of many sizes and powers.
SceneDescription floor_under(int count) {
  SceneDescription scene = scenes::line_of_sight({1, 1, 0}, {0, 0, 0});
  scene.image.width = scene.image.height = 12;
  scenes::place(scene, PlaneShape{}, scenes::add_white(scene));
  u32 state = 1;
  const auto next = [&] { return double(state = state * 1664525u + 1013904223u) / 4294967296.0; };
  for (int i = 0; i < count; ++i) {
    LightDescription light;
    light.type = i % 3 == 0 ? LightType::rectangle : i % 3 == 1 ? LightType::disk : LightType::sphere;
    light.position = {20 * next() - 10, 0.8 + 3 * next(), 20 * next() - 10};
    light.direction = {0, -1, 0};
    light.radius = 0.05 + 0.2 * next();
    light.size = {0.1 + 0.3 * next(), 0.2};
    light.intensity = 5 * next();
    light.hidden = true;
    scene.lights.push_back(light);
  }
  return scene;
}

// The lights that even numbers choose for a point, with the probabilities reported, and those of the leaves.
const char* const choose_kernel = R"(
#include "lib/core/lanes.h"
#include "lib/core/tables.h"
#include "plain/light/choose_light.cl"
__kernel void choose(__global const LightNode* nodes, __global const float4* point, __global const u32* leaves,
                     __global float4* chosen, __global float* of_leaves, u32 count, u32 leaf_count) {
  const u32 i = get_global_id(0);
  const Scene scene = {.light_nodes = nodes};
  if (i < leaf_count) of_leaves[i] = light_probability(&scene, leaves[i], all3(point[0].xyz), ALL_LANES);
  if (i >= count) return;
  float probability;
  const int light =
      choose_light(&scene, all3(point[0].xyz), ((float)i + 0.5f) / (float)count, &probability, ALL_LANES);
  chosen[i] = (float4)((float)light, probability, 0.0f, 0.0f);
}
)";

struct Choices {
  std::vector<u32> lights;              // of each leaf
  std::vector<float> probabilities;     // of each leaf
  std::vector<float> shares, reported;  // of the numbers that chose it; what choose_light() said
};

Choices choices(const DeviceInfo& info, SceneDescription scene, const glm::vec3& p) {
  constexpr u32 count = 1u << 14;
  scene.render.light_samples = 1;
  const CompiledScene flat = compile(scene);
  std::vector<u32> leaves;
  Choices found;
  for (u32 node = 0; node < flat.light_nodes.size(); ++node)
    if (flat.light_nodes[node].next & LIGHT_LEAF) {
      leaves.push_back(node);
      found.lights.push_back(flat.light_nodes[node].next & ~LIGHT_LEAF);
    }
  Device device(info);
  auto kernel =
      build_text(device, choose_kernel,
                 {{"TILE_W", "1"}, {"TILE_H", "1"}, {"LANES", "1"}, {"HAS_LIGHT_TREE", "1"}})
          .kernel<Buffer<LightNode>, Buffer<float4>, Buffer<u32>, Buffer<float4>, Buffer<float>, u32, u32>(
              "choose");
  const float4 at{p.x, p.y, p.z, 0};
  const auto leaf_count = static_cast<u32>(leaves.size());
  const auto nodes = device.upload<LightNode>(flat.light_nodes);
  const auto point = device.upload<float4>(std::span<const float4>(&at, 1));
  const auto of = device.upload<u32>(leaves);
  const auto chosen = device.make<float4>(count);
  const auto probabilities = device.make<float>(leaf_count);
  device.run(kernel, {.x = count}, nodes, point, of, chosen, probabilities, count, leaf_count);
  found.probabilities.resize(leaf_count);
  device.read(probabilities, std::span<float>(found.probabilities));
  std::vector<float4> drawn(count);
  device.read(chosen, std::span<float4>(drawn));
  found.shares.resize(leaf_count);
  found.reported.resize(leaf_count);
  for (const float4& one : drawn) {
    const auto leaf = static_cast<std::size_t>(std::ranges::find(found.lights, static_cast<u32>(one.x)) -
                                               found.lights.begin());
    REQUIRE(leaf < leaves.size());
    found.shares[leaf] += 1.0f / static_cast<float>(count);
    found.reported[leaf] = one.y;
  }
  return found;
}

struct Mean {
  double value, error, deviation;
};
Mean mean_of(const Image& image) {
  double sum = 0, squares = 0;
  const double count = double(image.data.size()) / 4;
  for (std::size_t i = 0; i < image.data.size(); i += 4) {
    sum += double(image.data[i]);
    squares += double(image.data[i]) * double(image.data[i]);
  }
  const double variance = std::max(squares / count - sum / count * sum / count, 0.0);
  return {sum / count, std::sqrt(variance / count), std::sqrt(variance)};
}

}  // namespace

TEST_CASE("chosen lights bring as much light as all of them do") {
  on_picture_devices([&](const DeviceInfo& device) {
    SceneDescription scene = floor_under(40);
    const RenderResult all = scenes::render_on(device, scene);
    for (const int samples : {1, 8}) {
      scene.render.light_samples = samples;
      const RenderResult chosen = scenes::render_on(device, scene);
      const Mean mean = mean_of(chosen.image), whole = mean_of(all.image);
      INFO(samples << ": " << mean.value << " +- " << mean.error << " for " << whole.value);
      CHECK(std::abs(mean.value - whole.value) < 3 * (mean.error + whole.error));
      // Near lights are chosen more often: by chance alone it would be 3 times the mean.
      CHECK(mean.deviation < 1.5 / std::sqrt(samples) * whole.value);
      CHECK(chosen.counts[COUNT_SHADOW] <= 144u * static_cast<unsigned>(samples));
    }
  });
}

TEST_CASE("a thousand lights need no more rays than are asked for") {
  SceneDescription scene = floor_under(1000);
  scene.render.light_samples = 4;
  LightDescription point;
  point.position = {0, 2, 0};
  scene.lights.push_back(point);  // sends one of its own
  on_picture_devices([&](const DeviceInfo& device) {
    const RenderResult result = scenes::render_on(device, scene);
    CHECK(result.counts[COUNT_SHADOW] <= 144u * 5u);
    CHECK(mean_of(result.image).value > 1);
  });
}

TEST_CASE("each light of a tree is chosen as often as its probability says, and these sum to one") {
  on_every_device([&](const DeviceInfo& device) {
    for (const glm::vec3 p : {glm::vec3(0, 0, 0), glm::vec3(8, 1, -7), glm::vec3(-300, 20, 90)}) {
      const Choices found = choices(device, floor_under(23), p);
      REQUIRE(found.lights.size() == 23);
      double sum = 0;
      for (std::size_t i = 0; i < found.lights.size(); ++i) {
        INFO("light " << found.lights[i]);
        sum += static_cast<double>(found.probabilities[i]);
        CHECK(found.shares[i] == Approx(found.probabilities[i]).margin(0.001));
        if (found.shares[i] > 0) CHECK(found.reported[i] == Approx(found.probabilities[i]).epsilon(1e-5));
      }
      CHECK(sum == Approx(1).epsilon(1e-5));
    }
  });
}

TEST_CASE("of two lamps alike, one twice as far away, the near one is chosen four times of five") {
  SceneDescription scene = scenes::line_of_sight({1, 1, 0}, {0, 0, 0});
  for (const double height : {20.0, 40.0}) {
    LightDescription light;
    light.type = LightType::disk;
    light.position = {0, height, 0};
    light.direction = {0, -1, 0};
    light.radius = 0.1;
    scene.lights.push_back(light);
  }
  on_every_device([&](const DeviceInfo& device) {
    const Choices found = choices(device, scene, {0, 0, 0});
    REQUIRE(found.lights.size() == 2);
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(found.probabilities[i] == Approx(found.lights[i] == 0 ? 0.8 : 0.2).epsilon(1e-4));
  });
}

TEST_CASE("a lone lamp has no tree, and the way to it no choices for kernels that know of trees") {
  SceneDescription scene = scenes::shipped_small("cornell_path");
  const CompiledScene flat = compile(scene);
  REQUIRE_FALSE(flat.features.light_tree);
  REQUIRE_FALSE(flat.lights.empty());
  CHECK(std::ranges::equal(flat.light_leaves, std::vector<u32>(flat.lights.size(), 0u)));
}
