// The tuner's search on made-up timings.
#include <cmath>
#include <set>

#include "bench/tune/tune_search.h"
#include "catch.h"

using namespace sundog;

namespace {

/// A bowl over 9 x 5 x 4 points with its bottom at `bottom`; points with a last index of 3 give wrong
/// results.
struct Bowl {
  TunePoint bottom{6, 1, 2};
  std::set<TunePoint> measured;
  std::size_t budget = 1000;

  double seconds(const TunePoint& at) const {
    double sum = 1;
    for (std::size_t i = 0; i < at.size(); ++i)
      sum += 0.1 * std::abs(static_cast<double>(at[i]) - static_cast<double>(bottom[i]));
    return sum;
  }
  TuneProblem problem() {
    TuneProblem result;
    result.axes = {9, 5, 4};
    result.start = {0, 0, 0};
    result.measure = [this](const TunePoint& at) -> std::optional<double> {
      CHECK(measured.insert(at).second);
      if (at[2] == 3) return {};
      return seconds(at);
    };
    result.measure_again = [this](const TunePoint& usual, const TunePoint& best) {
      return TunePairs{seconds(usual), seconds(best), 20, 20};
    };
    result.affordable = [this](const TunePoint&) { return measured.size() < budget; };
    return result;
  }
};

}  // namespace

TEST_CASE("the search finds the bottom of a bowl with a part of the measurements") {
  Bowl bowl;
  const TuneResult result = search_tuning(bowl.problem());
  CHECK(result.best == bowl.bottom);
  CHECK(result.best_seconds == Approx(1));
  CHECK(result.default_seconds == Approx(1.9));
  CHECK(result.tried == bowl.measured.size());
  CHECK(result.tried < 9 * 5 * 4 / 4);
  CHECK(result.rejected > 0);
}

TEST_CASE("the search stays at a default that is best") {
  Bowl bowl;
  bowl.bottom = {0, 0, 0};
  const TuneResult result = search_tuning(bowl.problem());
  CHECK(result.best == TunePoint{0, 0, 0});
  CHECK(result.best_seconds == result.default_seconds);
}

TEST_CASE("the search never takes a point whose result is wrong, however fast") {
  Bowl bowl;
  bowl.bottom = {0, 0, 3};
  const TuneResult result = search_tuning(bowl.problem());
  CHECK(result.best == TunePoint{0, 0, 2});
}

TEST_CASE("the search ends with its time, and keeps what it found so far") {
  for (const std::size_t budget : {1u, 2u, 5u, 9u}) {
    Bowl bowl;
    bowl.budget = budget;
    const TuneResult result = search_tuning(bowl.problem());
    CHECK(result.tried <= budget);
    CHECK(result.left_out > 0);
    CHECK(result.best_seconds <= result.default_seconds);
  }
}

TEST_CASE("points that cost too much are left out, and cheaper ones still measured") {
  Bowl bowl;
  TuneProblem problem = bowl.problem();
  problem.affordable = [](const TunePoint& at) { return at[1] == 0; };  // as if each step of it were compiled
  const TuneResult result = search_tuning(problem);
  CHECK(result.best == TunePoint{6, 0, 2});
  CHECK(result.left_out > 0);
  for (const TunePoint& at : bowl.measured) CHECK(at[1] == 0);
}

TEST_CASE("a winner that is no faster when it is measured again gives way to the default") {
  Bowl bowl;
  TuneProblem problem = bowl.problem();
  problem.measure_again = [](const TunePoint&, const TunePoint&) { return TunePairs{1.0, 0.995, 20, 20}; };
  const TuneResult result = search_tuning(problem);
  CHECK(result.best == TunePoint{0, 0, 0});
  CHECK(result.best_seconds == 1.0);
}

TEST_CASE("a default that does not work is no ground to search from") {
  Bowl bowl;
  TuneProblem problem = bowl.problem();
  problem.start = {0, 0, 3};
  const TuneResult result = search_tuning(problem);
  CHECK(result.tried == 1);
  CHECK(result.rejected == 1);
  CHECK(result.best == problem.start);
}

TEST_CASE("a tuning is kept only where pairs in turn confirm it") {
  CHECK(TunePairs{1, 0.9, 20, 20}.confirm());
  CHECK(TunePairs{1, 0.9, 15, 20}.confirm());
  CHECK_FALSE(TunePairs{1, 0.9, 14, 20}.confirm());
  CHECK_FALSE(TunePairs{1, 0.99, 20, 20}.confirm());
  Bowl bowl;
  TuneProblem problem = bowl.problem();
  problem.measure_again = [](const TunePoint&, const TunePoint&) { return TunePairs{1, 0.9, 12, 20}; };
  const TuneResult result = search_tuning(problem);
  CHECK(result.best == problem.start);
  CHECK(result.best_seconds == result.default_seconds);
}
