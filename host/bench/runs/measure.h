// Timing several ways of doing work in turn: what every bench does. Each result is compared before its time
// counts, disturbed runs are left out and taken again, and a way that fails is a row with its error.
#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/runs/load.h"

namespace sundog {

/// A way, and how it is run.
struct Subject : MeasuredWay {
  std::function<void()> prepare;       // before its first run; may be empty
  std::function<double()> run;         // does the work; seconds
  std::function<std::string()> check;  // why the last run's result does not count; "": it does
  bool once = false;                   // its first run counts, and there is no other
};

struct MeasureOptions {
  int repeat = 6;                            // runs of each that count
  double budget = 0;                         // seconds, after which no further round begins; 0: no limit
  const std::atomic<bool>* stop = nullptr;   // set: no further run
  std::map<std::string, MeasuredWay> known;  // runs of an earlier report, by the way's name
  std::function<void(const std::string& step, double done)> on_step;
  std::function<void()> on_runs;  // something was measured
  std::shared_ptr<LoadMeter> load;

  bool is_stopped() const { return stop && stop->load(); }
};

/// Whether other programs, or a lack of cores, slowed a run of the way. Cores count where others of its runs
/// had more and took less time.
bool is_disturbed(const MeasuredWay& way, const Run& run, double limit);

/// Does what comes before all subjects; where a device fails in it, that is their problem. Whether it did
/// not.
bool prepared(std::vector<Subject>& subjects, const std::function<void()>& work);

/// Warms each way up, then times rounds of all of them, in another order each time, until each has `repeat`
/// runs that count, or twice as many rounds have passed: then the least disturbed runs count too, and the way
/// is noisy. The wrong result or failure of a run takes the way out with a problem. `known` runs count
/// without being repeated. Other errors than a device's are thrown.
void measure(std::vector<Subject>& subjects, const MeasureOptions& options);

}  // namespace sundog
