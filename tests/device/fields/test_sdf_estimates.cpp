// Distance estimates on devices: never too long, and the same for every number of lanes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "scene/formula/lower.h"
#include "sdf_bound.h"
#include "sdf_testing.h"

using namespace sundog;

namespace {

const char* const values_kernel = R"(
#include "lib/sdf/surface.cl"
__kernel void values(__global const float* q, __global const float* points, __global float* out, u32 field, u32 count) {
  const u32 item = get_global_id(0);
  if (item * LANES >= count) return;
  REAL3 p;
  for (u32 i = 0; i < LANES; ++i) {
    REAL_LANE(p.x, i) = points[3u * (item * LANES + i)];
    REAL_LANE(p.y, i) = points[3u * (item * LANES + i) + 1u];
    REAL_LANE(p.z, i) = points[3u * (item * LANES + i) + 2u];
  }
  const REAL distance = sdf_distance(field, p, ALL_LANES, q), both = sdf_signed(field, p, ALL_LANES, q);
  const SdfSample s = sdf_sample(field, p, q);
  for (u32 i = 0; i < LANES; ++i) {
    __global float* o = out + 9u * (item * LANES + i);
    o[0] = REAL_LANE(distance, i);
    o[1] = REAL_LANE(both, i);
    o[2] = REAL_LANE(s.gradient.x, i);
    o[3] = REAL_LANE(s.gradient.y, i);
    o[4] = REAL_LANE(s.gradient.z, i);
    o[5] = REAL_LANE(s.point, i);
    o[6] = REAL_LANE(s.plane, i);
    o[7] = REAL_LANE(s.axis, i);
    o[8] = REAL_LANE(s.iterations, i);
  }
}
)";

std::vector<float> values_of(Device& device, const CompiledFields& fields,
                             const std::vector<SdfDescription>& descriptions, int lanes, u32 points_a_field) {
  auto kernel = build_fields(device, values_kernel, fields, lanes)
                    .kernel<Buffer<float>, Buffer<float>, Buffer<float>, u32, u32>("values");
  const auto q = device.upload<float>(fields.parameters);
  std::vector<float> all;
  for (u32 f = 0; f < descriptions.size(); ++f) {
    std::mt19937 random(f);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<float> points;
    for (u32 i = 0; i < points_a_field; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const auto low = static_cast<float>(descriptions[f].lower[axis]),
                   high = static_cast<float>(descriptions[f].upper[axis]);
        points.push_back(low + (high - low) * uniform(random));
      }
    const auto in = device.upload<float>(points);
    auto out = device.make<float>(9 * points_a_field);
    device.run(kernel, {.x = points_a_field / static_cast<u32>(lanes), .local_x = 16}, q, in, out, f,
               points_a_field);
    std::vector<float> values(9 * points_a_field);
    device.read(out, std::span<float>(values));
    all.insert(all.end(), values.begin(), values.end());
  }
  device.finish();
  return all;
}

bool is_transcendental(Op op) {
  return op == Op::sine || op == Op::cosine || op == Op::arc_cosine || op == Op::arc_tangent ||
         op == Op::exponential || op == Op::power;
}
bool uses_transcendentals(const FormulaDefinition& definition) {
  const LoweredFormula f = lower(definition, default_values(definition));
  for (const Section* section : {&f.start, &f.map, &f.finish})
    for (NodeId id = 0; id < section->graph.size(); ++id) {
      const Node& node = section->graph[id];
      // of a parameter alone: the same for all lanes, computed once
      if (is_transcendental(node.op)) {
        std::vector<NodeId> below{node.a};
        if (node.b != no_node) below.push_back(node.b);
        while (!below.empty()) {
          const Node& n = section->graph[below.back()];
          below.pop_back();
          if (n.op == Op::input && n.value < formula_input::parameter) return true;
          for (const NodeId operand : {n.a, n.b, n.c})
            if (operand != no_node && n.op != Op::input && n.op != Op::constant) below.push_back(operand);
        }
      }
    }
  return false;
}

}  // namespace

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
      for (std::size_t f = 0; f < chosen.size(); ++f) {
        const std::size_t first = f * 9 * count;
        std::size_t different = 0;
        for (std::size_t i = first; i < first + 9 * count; ++i)
          different += std::memcmp(&wanted[i], &found[i], sizeof(float)) != 0;
        INFO(chosen[f].name << ", " << lanes << " lanes");
        CHECK(different == 0);
      }
    }
  });
}

TEST_CASE("the logarithm of the lanes is within two units in the last place") {
  const char* const text = R"(
    #include "lib/core/lanes.h"
    #include "shared/types.h"
    kernel void run(global const float* in, global float* out, u32 count) {
      const u32 i = get_global_id(0);
      if (i >= count) return;
      const REAL y = real_log((REAL)(in[i]));
      out[i] = REAL_LANE(y, LANES - 1);
    })";
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
