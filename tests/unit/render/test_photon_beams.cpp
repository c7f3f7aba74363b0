// Groups of photons' beams: each beam stands once, within the cone of its group.
#include "render/device/photon_beams.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "catch.h"

using namespace sundog;

namespace {

glm::dvec3 vector_of(const float4& row) { return {row.x, row.y, row.z}; }

/// A fan of beams, some endless, some reflected to anywhere.
std::vector<float4> fan_of_beams(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-1, 1);
  std::vector<float4> rows;
  for (int i = 0; i < count; ++i) {
    const bool strays = i % 20 == 0;
    const glm::vec3 way =
        glm::normalize(glm::vec3(1, any(random), 0.1f * any(random)) * (strays ? any(random) : 1.0f) +
                       glm::vec3(0, 0, 1e-3f));
    rows.push_back({0.1f * any(random), any(random), any(random), i % 7 == 0 ? INFINITY : 2 + any(random)});
    rows.push_back({way.x, way.y, way.z, 0});
    rows.push_back({1, 1, 1, float(i + 1)});
  }
  return rows;
}

}  // namespace

TEST_CASE("beams of photons stand once in groups, within their cones") {
  constexpr double radius = 0.01;
  for (const int count : {1, 5, 64, 333, 2048}) {
    const std::vector<float4> rows = group_beams(fan_of_beams(count), 4096, 0, radius);
    REQUIRE(rows.size() % (BEAM_GROUP_ROWS * PHOTON_MAP_SAMPLES) == 0);
    std::vector<float> seen;
    for (std::size_t group = 0; group < rows.size(); group += BEAM_GROUP_ROWS) {
      const glm::dvec3 point = vector_of(rows[group]), axis = vector_of(rows[group + 1]);
      const double at_point = rows[group].w, growth = rows[group + 1].w;
      for (std::size_t i = group + 2; i < group + BEAM_GROUP_ROWS; i += 3) {
        if (rows[i + 2].w == 0) continue;
        seen.push_back(rows[i + 2].w);
        for (const double t : {0.0, 0.3, 1.0, 7.0, 1e4}) {
          const glm::dvec3 to =
              vector_of(rows[i]) + std::min(t, double(rows[i].w)) * vector_of(rows[i + 1]) - point;
          const double along = glm::dot(to, axis);
          CHECK(glm::length(to - along * axis) + radius <=
                1e-6 * glm::length(to) + at_point + growth * along);
        }
      }
    }
    std::ranges::sort(seen);
    std::vector<float> all(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = float(i + 1);
    CHECK(seen == all);
  }
}

TEST_CASE("no beams make no groups, and of many so many are drawn as are wanted") {
  CHECK(group_beams({}, 256, 0, 0.01).empty());
  const std::vector<float4> rows = group_beams(fan_of_beams(2048), 256, 3, 0.01);
  double light = 0;
  for (std::size_t group = 0; group < rows.size(); group += BEAM_GROUP_ROWS)
    for (std::size_t i = group + 2; i < group + BEAM_GROUP_ROWS; i += 3)
      light += rows[i + 2].w * rows[i + 2].x;
  CHECK(rows.size() <= 2 * 256 / BEAM_GROUP * BEAM_GROUP_ROWS);
  CHECK(light == Approx(2048.0 * 2049 / 2).epsilon(0.01));
}
