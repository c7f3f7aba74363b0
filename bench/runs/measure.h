// Timing several ways of doing work in turn: what every bench does. Each result is compared before its time
// counts, disturbed runs are left out and taken again, and a way that fails is a row with its error.
#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "bench/runs/load.h"

namespace sundog {

/// A way, and how it is run.
struct Subject : MeasuredWay {
  std::function<void()> prepare;       // before its first run; may be empty
  std::function<double()> run;         // does the work; seconds
  std::function<std::string()> check;  // why the last run's result does not count; "": it does
};

struct MeasureOptions {
  int repeat = 6;        // runs of each that count, at least
  double seconds = 0;    // that the runs of each take together, at least
  double precision = 0;  // half the median's interval over the median, at most; 0: does not matter
  double budget = 0;     // seconds, after which no further round begins; 0: no limit
  const std::atomic<bool>* stop = nullptr;   // set: no further run
  std::map<std::string, MeasuredWay> known;  // runs of an earlier report, by the way's name
  std::function<void(const std::string& step, double done)> on_step;
  std::function<void()> on_runs;  // something was measured
  // Hears of the row before each run and of "" after all; why it is a problem ("": none).
  std::function<std::string(const std::string& row)> enter_row;
  std::shared_ptr<LoadMeter> load;

  bool is_stopped() const { return stop && stop->load(); }
};

/// The cause that slowed a run: "busy" (other programs, or too few cores), "slow clock", or "" for none.
/// Cores and the clock count where other runs of the way had more and took less time.
std::string disturbance(const MeasuredWay& way, const Run& run, double limit);

/// Whether its median is known to `precision`, for which it needs six runs at least.
bool is_precise(const MeasuredWay& way, double precision);

/// Does what comes before all subjects; where a device fails in it, that is their problem. Whether it did
/// not.
bool prepared(std::vector<Subject>& subjects, const MeasureOptions& options,
              const std::function<void()>& work);

/// A result that two runs in a row agree on, so that one spoiled run is no reference. Throws DeviceError if
/// no two of the first few runs agree.
template <class T, class Make, class Same>
T confirmed(const Make& make, const Same& same) {
  T last = make();
  for (int i = 0; i < 4; ++i) {
    T next = make();
    if (same(last, next)) return next;
    last = std::move(next);
  }
  throw DeviceError("its results differ from run to run, so there is nothing to compare with");
}

/// Warms each way up, then times rounds of all of them, in another order each time, until each has
/// the runs that were asked for, or as many again were disturbed: then the least disturbed count too up to
/// `repeat`, and the way is noisy. The wrong result or failure of a run takes the way out with a problem.
/// `known` runs count without being repeated. Other errors than a device's are thrown.
void measure(std::vector<Subject>& subjects, const MeasureOptions& options);

}  // namespace sundog
