// Faster, slower or not told apart: how often runs of one and the same thing get a winner, by made-up runs
// and by those of 400 calls of a bench.
#include "bench/runs/ratio.h"

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "catch.h"

using namespace sundog;

namespace {

constexpr int trials = 200, many = 2000;

/// Trials in which a winner is named.
template <class MakeRatio>
int winners(int count, MakeRatio make) {
  int found = 0;
  for (int trial = 0; trial < count; ++trial) found += make(trial).verdict() != std::string("not told apart");
  return found;
}

/// A call of the program: its own median, and runs about it with a long tail.
std::vector<double> made_call(std::mt19937& random, double seconds, double call) {
  std::normal_distribution<double> of_call(0, call), of_run(0, 0.03);
  const double level = seconds * std::exp(of_call(random));
  std::vector<double> runs;
  for (int i = 0; i < 8; ++i) runs.push_back(level * std::exp(std::abs(of_run(random))));
  return runs;
}

Calls made_calls(std::mt19937& random, double seconds, int count) {
  const double call = count < 6 ? 0.04 : 0.1;  // how far medians of calls are spread
  Calls calls;
  for (int i = 0; i < count; ++i) calls.push_back(made_call(random, seconds, call));
  return calls;
}

/// `bench rays` of one kind, nanoseconds; a line a call.
Calls recorded_calls() {
  std::ifstream in(SUNDOG_SOURCE_DIR "/tests/unit/bench/recorded_calls.txt");
  Calls calls;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::vector<double>& runs = calls.emplace_back();
    for (double run = 0; words >> run;) runs.push_back(run);
  }
  return calls;
}

std::vector<Run> as_runs(const std::vector<double>& seconds) {
  std::vector<Run> runs(seconds.size());
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].seconds = seconds[i];
  return runs;
}

}  // namespace

TEST_CASE("ways that took turns are compared pair by pair, without the pairs that were disturbed") {
  std::vector<Run> a = as_runs({1, 2, 4, 1, 2, 4, 9}), b = as_runs({2, 4, 8, 2, 4, 8, 9});
  a[6].left_out = "busy";
  Ratio ratio = paired_ratio(a, b);
  CHECK((ratio.value == 2 && ratio.low == 2 && ratio.high == 2));
  CHECK(ratio.verdict() == std::string("slower"));
  CHECK(paired_ratio(b, a).verdict() == std::string("faster"));
  b[0].left_out = "busy";  // five pairs are too few
  CHECK(paired_ratio(a, b).verdict() == std::string("not told apart"));
  CHECK_FALSE(paired_ratio(a, {}).is_known());
}

TEST_CASE("a machine that slows down and speeds up names a winner of paired runs in 5 % of trials at most") {
  std::mt19937 random(1);
  std::normal_distribution<double> step(0, 0.05);
  for (const int count : {6, 9, 15, 30}) {
    CAPTURE(count);
    CHECK(winners(many, [&](int) {
            double level = 0;
            std::vector<double> a, b;
            for (int i = 0; i < count; ++i) {
              a.push_back(std::exp(level += step(random)));
              b.push_back(std::exp(level += step(random)));
              if (i % 2) std::swap(a.back(), b.back());  // the order is shuffled
            }
            return paired_ratio(as_runs(a), as_runs(b));
          }) <= many / 20);
  }
}

TEST_CASE("calls of the same thing name a winner in 5 % of trials at most, and a difference is found") {
  std::mt19937 random(2);
  for (const int count : {1, 2, 5, 6, 8, 12, 20}) {
    CAPTURE(count);
    const auto ratio = [&](double other) {
      const Calls base = made_calls(random, 1, count);
      return ratio_of_calls(base, made_calls(random, other, count));
    };
    CHECK(winners(trials, [&](int) { return ratio(1); }) <= trials / 20);
    CHECK(winners(trials, [&](int) { return ratio(2); }) >= trials * 9 / 10);
  }
}

TEST_CASE("calls of few runs name a winner in 5 % of trials at most") {
  std::mt19937 random(3);
  for (const std::size_t runs : {1, 2, 3, 4, 5, 6}) {
    CAPTURE(runs);
    const auto call = [&] {
      std::vector<double> made = made_call(random, 1, 0.04);
      made.resize(runs);
      return made;
    };
    CHECK(winners(many, [&](int) { return ratio_of_calls({call()}, {call()}); }) <= many / 20);
  }
}

TEST_CASE("recorded calls, measured in turn, name a winner in 5 % of trials at most") {
  const Calls calls = recorded_calls();
  REQUIRE(calls.size() == 2 * trials);
  CHECK(winners(trials, [&](int trial) {
          const auto i = static_cast<std::size_t>(2 * trial);
          return ratio_of_calls({calls[i]}, {calls[i + 1]});
        }) <= trials / 20);
  for (const int count : {6, 8, 12}) {
    CAPTURE(count);
    CHECK(winners(trials, [&](int trial) {
            Calls a, b;
            for (int i = 0; i < 2 * count; ++i)
              (i % 2 ? a : b).push_back(calls[static_cast<std::size_t>(2 * trial + i) % calls.size()]);
            return ratio_of_calls(a, b);
          }) <= trials / 20);
  }
}
