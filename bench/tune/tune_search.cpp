// Tries every second value of each axis, then neighbours of the best until none is 2 % faster; the winner
// must beat the default again in pairs.
#include "bench/tune/tune_search.h"

#include <cmath>
#include <map>

namespace sundog {
namespace {

constexpr double worthwhile = 0.98;  // of the time, for a change to count

struct Search {
  const TuneProblem& problem;
  TuneResult result;
  std::map<TunePoint, std::optional<double>> known;

  /// Takes the point if it is faster. Leaves out a point that is not affordable; a cheaper one may still be.
  void offer(const TunePoint& point) {
    if (known.count(point)) return;
    if (!problem.affordable(point)) {
      known[point] = {};
      ++result.left_out;
      return;
    }
    const std::optional<double> seconds = known[point] = problem.measure(point);
    ++result.tried;
    if (!seconds)
      ++result.rejected;
    else if (*seconds < worthwhile * result.best_seconds) {
      result.best = point;
      result.best_seconds = *seconds;
    }
  }

  /// Offers every second value of an axis on both sides of the best point, and both ends; with `fine`, its
  /// neighbours.
  void sweep(std::size_t axis, bool fine) {
    const TunePoint from = result.best;
    const std::size_t here = from[axis], count = problem.axes[axis];
    for (std::size_t value = 0; value < count; ++value) {
      const std::size_t away = value > here ? value - here : here - value;
      const bool wanted = fine ? away == 1 : away % 2 == 0 || value == 0 || value + 1 == count;
      TunePoint point = from;
      point[axis] = value;
      if (wanted) offer(point);
    }
  }
};

}  // namespace

bool TunePairs::confirm() const {
  return best < worthwhile * usual && wins >= 0.5 * pairs + std::sqrt(pairs);
}

TuneResult search_tuning(const TuneProblem& problem) {
  Search search{problem, {}, {}};
  TuneResult& result = search.result;
  result.best = problem.start;
  const std::optional<double> usual = search.known[problem.start] = problem.measure(problem.start);
  result.tried = 1;
  if (!usual) {  // the default does not work, so nothing can be compared with it
    result.rejected = 1;
    return result;
  }
  result.default_seconds = result.best_seconds = *usual;
  for (std::size_t axis = 0; axis < problem.axes.size(); ++axis) search.sweep(axis, false);
  for (bool better = true; better;) {
    const TunePoint before = result.best;
    for (std::size_t axis = 0; axis < problem.axes.size(); ++axis) search.sweep(axis, true);
    better = result.best != before;
  }
  if (result.best == problem.start) return result;
  const TunePairs again = problem.measure_again(problem.start, result.best);
  result.default_seconds = again.usual;
  result.best_seconds = again.best;
  if (again.confirm()) return result;
  result.best = problem.start;
  result.best_seconds = again.usual;
  return result;
}

}  // namespace sundog
