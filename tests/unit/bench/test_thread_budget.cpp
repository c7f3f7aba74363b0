// How long `bench threads` takes, and what it leaves out where that is too long.
#include "bench/frames/thread_budget.h"
#include "catch.h"

using namespace sundog;

namespace {

ThreadScaling plan_of(double device, double plain) {
  ThreadScaling plan;
  plan.sizes = {100, 200, 300};
  plan.counts = {1, 2, 4};
  plan.repeat = 5;
  plan.cores = 2;
  plan.cost = {device, plain};
  return plan;
}

}  // namespace

TEST_CASE("a plan's time counts every frame by its pixels and threads, and plain C++ once a size") {
  ThreadScaling plan = plan_of(1e-4, 1e-3);
  CHECK(frame_seconds(plan, 100, 1) == Approx(1));
  CHECK(frame_seconds(plan, 100, 4) == Approx(0.5));  // on two cores
  // 14 times the pixels of the least size; 7 frames of each count; a device is opened 9 times.
  CHECK(expected_seconds(plan) == Approx(14 * 7 * (1 + 0.5 + 0.5) + 14 * 10 + 9 * 0.3));
  plan.plain = false;
  CHECK(expected_seconds(plan) == Approx(14 * 7 * 2 + 9 * 0.3));
}

TEST_CASE("a plan that fits stays as it is") {
  ThreadScaling plan = plan_of(1e-4, 1e-3);
  CHECK(fit_into(plan, 1000).empty());
  CHECK(plan.repeat == 5);
  CHECK(plan.sizes.size() == 3);
  CHECK(plain_seconds(plan, 300) == Approx(90));
  ThreadScaling unknown = plan_of(0, 0);  // nothing is left out on no grounds
  CHECK(fit_into(unknown, 5).empty());
}

TEST_CASE("to fit, plain C++ goes first, then frames, then the largest images") {
  ThreadScaling plan = plan_of(1e-4, 1e-3);
  CHECK(fit_into(plan, 300) == std::vector<std::string>{"plain C++ above 299 pixels a side"});
  CHECK(plain_seconds(plan, 300) == 0);
  CHECK(plain_seconds(plan, 200) == Approx(40));
  CHECK(plan.repeat == 5);

  plan = plan_of(1e-4, 1e-3);
  CHECK(fit_into(plan, 200).size() == 2);
  CHECK(plan.repeat == 3);
  CHECK(plan.sizes.size() == 3);
  CHECK(expected_seconds(plan) <= 200);

  plan = plan_of(1e-4, 1e-3);
  const auto left_out = fit_into(plan, 12);
  CHECK(left_out ==
        std::vector<std::string>{"images of 200, 300 pixels a side", "plain C++", "2 of 5 frames"});
  CHECK(plan.sizes == std::vector<int>{100});
  CHECK(expected_seconds(plan) <= 12);

  plan = plan_of(1, 1);  // one small size at least, whatever it takes
  fit_into(plan, 1);
  CHECK(plan.sizes == std::vector<int>{100});
}
