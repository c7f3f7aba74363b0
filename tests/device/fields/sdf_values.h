// The values of fields at points by chance, on a device: by their own code and by the interpreter of
// programs.
#pragma once
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "formula/lower.h"
#include "sdf_testing.h"

using namespace sundog;

constexpr u32 numbers_a_point = 10;

inline const char* const values_kernel = R"(
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
  const REAL distance = sdf_distance(field, p, ALL_LANES, q), both = sdf_signed(field, p, ALL_LANES, q),
             near = sdf_uneven(field, q) ? sdf_near(field, p, ALL_LANES, q) : distance;
  const SdfSample s = sdf_sample(field, p, q);
  for (u32 i = 0; i < LANES; ++i) {
    __global float* o = out + 10u * (item * LANES + i);
    o[0] = REAL_LANE(distance, i);
    o[1] = REAL_LANE(both, i);
    o[2] = REAL_LANE(s.gradient.x, i);
    o[3] = REAL_LANE(s.gradient.y, i);
    o[4] = REAL_LANE(s.gradient.z, i);
    o[5] = REAL_LANE(s.point, i);
    o[6] = REAL_LANE(s.plane, i);
    o[7] = REAL_LANE(s.axis, i);
    o[8] = REAL_LANE(s.iterations, i);
    o[9] = REAL_LANE(near, i);
  }
}
)";

inline std::vector<float> values_of(Device& device, const CompiledFields& fields,
                                    const std::vector<SdfDescription>& descriptions, int lanes,
                                    u32 points_a_field) {
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
    auto out = device.make<float>(numbers_a_point * points_a_field);
    device.run(kernel, {.x = points_a_field / static_cast<u32>(lanes), .local_x = 16}, q, in, out, f,
               points_a_field);
    std::vector<float> values(numbers_a_point * points_a_field);
    device.read(out, std::span<float>(values));
    all.insert(all.end(), values.begin(), values.end());
  }
  device.finish();
  return all;
}

inline bool is_transcendental(Op op) {
  return op == Op::sine || op == Op::cosine || op == Op::arc_cosine || op == Op::arc_tangent ||
         op == Op::exponential || op == Op::power;
}
inline bool uses_transcendentals(const FormulaDefinition& definition) {
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

/// The interpreter gives the bits that the fields' own code gave.
inline void check_interpreted(Device& device, const CompiledFields& fields,
                              const std::vector<SdfDescription>& descriptions, int lanes, u32 points_a_field,
                              const std::vector<float>& wanted) {
  REQUIRE(have_programs(fields.parameters));
  CompiledFields programs = fields;
  programs.source = interpreting_source;
  const auto found = values_of(device, programs, descriptions, lanes, points_a_field);
  REQUIRE(found.size() == wanted.size());
  const std::size_t numbers = std::size_t{numbers_a_point} * points_a_field;
  for (std::size_t f = 0; f < descriptions.size(); ++f) {
    std::size_t different = 0;
    for (std::size_t i = f * numbers; i < (f + 1) * numbers; ++i)
      different += std::memcmp(&wanted[i], &found[i], sizeof(float)) != 0;
    INFO(descriptions[f].name << ", interpreted in " << lanes << " lanes");
    CHECK(different == 0);
  }
}
