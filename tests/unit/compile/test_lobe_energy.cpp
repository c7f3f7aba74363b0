// The tables of rough surfaces that are made when sundog is built.
#include "compile/surfaces/lobe_energy.h"

#include <algorithm>

#include "catch.h"

using namespace sundog;

TEST_CASE("the built tables of rough surfaces are those that are computed, to the bit") {
  const std::vector<float> computed = make_lobe_energy({.gains = true, .glass = true});
  CHECK(std::ranges::equal(built_lobe_energy(), computed));
}
