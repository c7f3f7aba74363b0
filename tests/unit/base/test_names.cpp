// The nearest of some names to a misspelt one.
#include <base/names.h>

#include "catch.h"

using sundog::did_you_mean;
using sundog::nearest_name;

TEST_CASE("the nearest name is the one with the fewest letters changed, a third of them at most") {
  const std::vector<std::string> names = {"render", "merge", "check", "bench", "tune"};
  CHECK(nearest_name("rendr", names) == "render");
  CHECK(nearest_name("redner", names) == "render");  // neighbours swapped count once
  CHECK(nearest_name("RENDER", names) == "render");
  CHECK(nearest_name("mergee", names) == "merge");
  CHECK(nearest_name("tnue", names) == "tune");
  CHECK_FALSE(nearest_name("frobnicate", names));
  CHECK_FALSE(nearest_name("q", {"c", "z"}));  // nothing in common
  CHECK_FALSE(nearest_name("", names));
  CHECK_FALSE(nearest_name(std::string(1000, 'r'), names));
}

TEST_CASE("a message asks for the nearest name, or says otherwise") {
  CHECK(did_you_mean("rendr", {"render"}) == "did you mean \"render\"?");
  CHECK(did_you_mean("rendr", {"render"}, "", "'") == "did you mean 'render'?");
  CHECK(did_you_mean("frobnicate", {"render"}, "wanted render") == "wanted render");
}
