// Parts of light are fitted to the sum of their pixel.
#include "render/film/light_parts.h"

#include <cmath>
#include <random>

#include "catch.h"

using namespace sundog;

TEST_CASE("parts of light get the sum that a pixel has, to the bit, and those without light stay without") {
  std::mt19937 numbers(1);
  std::uniform_real_distribution<float> any(0, 1);
  double most = 0;
  bool equal = true, empty = true;
  for (int i = 0; i < 200000; ++i) {
    PartValues before{};
    const auto used = 1 + numbers() % LIGHT_PART_COUNT;
    for (auto k = used; k > 0; --k)
      before[numbers() % LIGHT_PART_COUNT] = std::exp(-8 * any(numbers)) * any(numbers);
    const float whole = sum_of(before) * (1 + 1e-6f * (any(numbers) - 0.5f));
    PartValues parts = before;
    fit_sum(parts, whole);
    equal = equal && sum_of(parts) == whole;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      empty = empty && (before[k] != 0 || parts[k] == 0);
      most = std::max(most, std::abs(double(parts[k] - before[k])) / double(whole));
    }
  }
  CHECK(equal);
  CHECK(empty);
  CHECK(most < 1e-6);
}
