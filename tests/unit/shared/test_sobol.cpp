// The Sobol sequence of kernels/shared/sampler.h, whose code the kernels share: how evenly its points lie.
#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "catch.h"
#include "shared/sampler.h"

using namespace sundog;

namespace {

double value(u32 x, u32 y, u32 sample, u32 dimension) {
  return sobol_bits(x, y, sample, dimension) / 4294967296.0;
}

/// Whether the samples [first, first + count) of two dimensions fill every rectangle of 2^-a x 2^-b, with
/// 2^(a + b) = count / `room`, with `room` samples each.
bool fills_rectangles(u32 x, u32 y, u32 dimension, u32 first, u32 count, u32 room) {
  for (u32 columns = 1; columns * room <= count; columns *= 2) {
    const u32 rows = count / room / columns;
    std::vector<u32> filled(std::size_t{columns} * rows);
    for (u32 i = first; i < first + count; ++i) {
      const auto column = static_cast<u32>(value(x, y, i, dimension) * columns);
      const auto row = static_cast<u32>(value(x, y, i, dimension + 1) * rows);
      if (++filled[column * rows + row] > room) return false;
    }
  }
  return true;
}

/// The squared L2 star discrepancy of the first `count` samples of two dimensions (Warnock 1972).
double squared_discrepancy(u32 x, u32 y, u32 dimension, u32 count) {
  std::vector<double> a, b;
  for (u32 i = 0; i < count; ++i) {
    a.push_back(value(x, y, i, dimension));
    b.push_back(value(x, y, i, dimension + 1));
  }
  double single = 0, pairs = 0;
  for (u32 i = 0; i < count; ++i) {
    single += (1 - a[i] * a[i]) * (1 - b[i] * b[i]) / 4;
    for (u32 k = 0; k < count; ++k) pairs += (1 - std::max(a[i], a[k])) * (1 - std::max(b[i], b[k]));
  }
  return 1.0 / 9 - 2 * single / count + pairs / count / count;
}

}  // namespace

TEST_CASE("blue noise fills every elementary interval by the samples of each aligned block of pixels") {
  constexpr u32 room = 2;  // 4 samples a pixel
  for (const u32 block : {1u, 2u, 4u, 8u})
    for (const u32 dimension : {0u, 2u, 4u, 4104u})
      for (const u32 corner : {0u, 3u, 700u}) {
        const u32 count = block * block << room;
        for (u32 columns = 1; columns <= count; columns *= 2) {
          const u32 rows = count / columns;
          std::vector<u32> filled(count);
          for (u32 i = 0; i < count; ++i) {
            const u32 pixel = i >> room, x = corner * block + pixel % block,
                      y = (corner + 5) * block + pixel / block, sample = i & 3u;
            const auto at = [&](u32 d, u32 cells) {
              return static_cast<u32>(blue_noise_bits(x, y, sample, room, d) / 4294967296.0 * cells);
            };
            ++filled[at(dimension, columns) * rows + at(dimension + 1, rows)];
          }
          INFO(block << " dimension " << dimension << " corner " << corner << " columns " << columns);
          CHECK(std::ranges::count(filled, 1u) == count);
        }
      }
}

TEST_CASE("the first 2^k samples of a pixel are in every elementary interval, and so is each aligned run") {
  for (const u32 pixel : {0u, 5u, 40000u})
    for (u32 count = 1; count <= 1024; count *= 2) {
      INFO(count << " samples of pixel " << pixel);
      for (const u32 dimension : {0u, 4u, 8u, 40u})
        CHECK(fills_rectangles(pixel, pixel / 3, dimension, 0, count, 1));
      CHECK(fills_rectangles(pixel, pixel / 3, 4, 3 * count, count, 1));
      // The second pair is a (1, 2) sequence at these lengths, but for its last.
      CHECK(fills_rectangles(pixel, pixel / 3, 2, 0, count, count <= 8 ? 1 : count < 256 ? 2 : 4));
    }
}

TEST_CASE("each dimension of the first 2^k samples fills every 2^k-th part once") {
  for (u32 dimension = 0; dimension < 12; ++dimension)
    for (const u32 count : {2u, 16u, 4096u, SOBOL_SAMPLES}) {
      std::set<u32> parts;
      for (u32 i = 0; i < count; ++i) parts.insert(static_cast<u32>(value(11, 3, i, dimension) * count));
      CHECK(parts.size() == count);
    }
}

TEST_CASE("scrambled samples lie a hundred times closer to even than random ones") {
  constexpr u32 count = 1024;
  const double random = (1.0 / 4 - 1.0 / 9) / count;
  for (const u32 dimension : {0u, 2u, 8u}) CHECK(squared_discrepancy(17, 4, dimension, count) < random / 100);
}

TEST_CASE("samples of neighbouring pixels and of other dimensions have nothing to do with each other") {
  constexpr u32 edge = 64;
  const double bound = 4.5 / 12 / edge;  // 4.5 standard deviations of a mean of products
  struct Other {
    u32 x, y, sample, dimension;
  };
  for (const Other& to : {Other{1, 0, 0, 0}, Other{0, 1, 0, 0}, Other{1, 1, 0, 0}, Other{0, 0, 0, 1},
                          Other{0, 0, 0, 2}, Other{0, 0, 0, 4}, Other{0, 0, 0, 8}, Other{1, 0, 1, 1}}) {
    double product = 0, mean = 0;
    for (u32 y = 0; y < edge; ++y)
      for (u32 x = 0; x < edge; ++x) {
        const double here = value(x, y, 0, 0) - 0.5;
        mean += here / (edge * edge);
        product += here * (value(x + to.x, y + to.y, to.sample, to.dimension) - 0.5) / (edge * edge);
      }
    INFO(to.x << " " << to.y << " " << to.sample << " " << to.dimension);
    CHECK(std::abs(product) < bound);
    CHECK(std::abs(mean) < 4.5 / std::sqrt(12.0) / edge);
  }
}

TEST_CASE("dimensions of bounces and of lights do not meet") {
  std::set<u32> seen{DIMENSION_PIXEL, DIMENSION_LENS, DIMENSION_TIME};
  for (const u32 depth : {1u, 2u, 64u})
    for (const u32 light : {0u, 1u, 999u})
      for (u32 i = 0; i < DIMENSIONS_A_BOUNCE; ++i)
        CHECK(
            seen.insert(DIMENSION_BOUNCE + DIMENSIONS_A_BOUNCE * (depth - 1) + DIMENSIONS_OF_LIGHT(light) + i)
                .second);
}
