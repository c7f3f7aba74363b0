// Times several ways of doing work in turn, for all benches. A time counts only if the result is right;
// disturbed runs are left out and repeated; a way that fails becomes a row with its error.
#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "bench/runs/load.h"
#include "device/devices.h"

namespace sundog {

/// A way, and the functions that run it.
struct Subject : MeasuredWay {
  std::function<void()> prepare;       // before its first run; may be empty
  std::function<double()> run;         // does the work and returns its seconds
  std::function<std::string()> check;  // why the last run's result does not count; "": it does
  std::vector<DeviceInfo> devices;     // that it runs on, whose joules its runs have
};

struct MeasureOptions {
  int repeat = 6;                            // least number of each way's runs that count
  double seconds = 0;                        // least total of the seconds of each way's runs
  double precision = 0;                      // greatest half_width() of each way; 0: any
  double budget = 0;                         // seconds, after which no further round begins; 0: no limit
  const std::atomic<bool>* stop = nullptr;   // set: no further run
  std::map<std::string, MeasuredWay> known;  // runs of an earlier report, by the way's name
  std::function<void(const std::string& step, double done)> on_step;
  std::function<void()> on_runs;  // called after each run
  // Called with the row before each run and with "" at the end. Returns why the row has a problem ("": it has
  // none).
  std::function<std::string(const std::string& row)> enter_row;
  std::shared_ptr<LoadMeter> load;

  bool is_stopped() const { return stop && stop->load(); }
};

/// The cause that slowed a run: "busy" (other programs, or too few cores), "slow clock", or "" for none. Few
/// cores or a slow clock count only if another run of the way had more and took less time.
std::string disturbance(const MeasuredWay& way, const Run& run, double limit);

/// Whether the way's median is known to `precision`; it needs at least six runs.
bool is_precise(const MeasuredWay& way, double precision);

/// Does the work that all subjects need first. Returns false if a device fails in it, which becomes every
/// subject's problem.
bool prepared(std::vector<Subject>& subjects, const MeasureOptions& options,
              const std::function<void()>& work);

/// A result that two successive runs agree on, so that a spoiled run does not become the reference. Throws
/// DeviceError if no two of the first few runs agree.
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

/// Warms up each way, then times rounds of all ways, each in another order, until each way has the requested
/// runs or as many again were disturbed; then the least disturbed count too, up to `repeat`, and the way is
/// noisy. A wrong result or a failed run takes its way out with a problem. `known` runs count and are not
/// repeated. Throws errors other than a device's.
void measure(std::vector<Subject>& subjects, const MeasureOptions& options);

}  // namespace sundog
