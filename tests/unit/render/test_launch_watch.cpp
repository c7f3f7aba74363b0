// How long a launch may take before its driver counts as hanging.
#include "catch.h"
#include "render/device/launch_watch.h"

using namespace sundog;

TEST_CASE("a launch's limit leaves time to compile, and to compile again") {
  CHECK(launch_limit(0.1, false, 0) == 30);
  CHECK(launch_limit(1, false, 0) == 100);
  CHECK(launch_limit(0.1, true, 0) == 300);
  CHECK(launch_limit(0.1, false, 67) == 201);
  CHECK(launch_limit(0.1, true, 67) == 300);
}

TEST_CASE("a launch is overdue after its limit, and not once it has ended") {
  LaunchWatch watch;
  watch.begin(0, false);
  while (watch.overdue() == 0) {
  }
  watch.end();
  CHECK(watch.overdue() == 0);
  CHECK(watch.longest() > 0);
  watch.begin(100, false);
  CHECK(watch.overdue() == 0);
  watch.end();
}
