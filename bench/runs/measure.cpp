// Runs each way once, then all in shuffled rounds until number, time and precision suffice; if too few runs
// were quiet, the least disturbed ones count too.
#include "bench/runs/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <thread>
#include <utility>

#include "base/error.h"
#include "device/energy.h"

namespace sundog {
namespace {

constexpr const char* busy = "busy";
constexpr const char* slow_clock = "slow clock";
constexpr double slower = 0.95;  // a run's clock over another's, for it to count as slow
constexpr std::size_t most_runs = 1000;
// A run that had fewer cores and took longer than another of its way by these factors was disturbed.
constexpr double fewer_cores = 0.85, longer = 1.1;

bool is_noise(const std::string& left_out) { return left_out == busy || left_out == slow_clock; }

std::size_t counted(const MeasuredWay& way) {
  return static_cast<std::size_t>(
      std::ranges::count_if(way.runs, [](const Run& run) { return run.left_out.empty(); }));
}

/// Throws DeviceError if the row has a problem.
void enter(const MeasureOptions& options, const std::string& row) {
  const std::string why = options.enter_row ? options.enter_row(row) : "";
  if (!why.empty()) throw DeviceError(why);
}

class Measurement {
 public:
  Measurement(std::vector<Subject>& subjects, const MeasureOptions& options)
      : subjects_(subjects), options_(options) {
    for (Subject& subject : subjects_) {
      meters_.push_back(std::make_unique<EnergyMeter>(subject.devices));
      if (const auto found = options_.known.find(subject.name); found != options_.known.end())
        subject.runs = found->second.runs, subject.known = subject.runs.size();
    }
  }

  void warm_up() {
    for (Subject& subject : subjects_) {
      if (options_.is_stopped()) return;
      if (subject.once && counted(subject) > 0) continue;
      if (is_over() && &subject != &subjects_.front()) {
        subject.problem = "left out for lack of time (--budget)";
        continue;
      }
      tell(subject, "the first run");
      run(subject, subject.once || subject.cold, true);
      ++done_;
    }
    judge();
  }

  void rounds() {
    std::vector<std::size_t> order(subjects_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (bool any = true, first = true; any && (first || !is_over()); first = false) {
      std::ranges::shuffle(order, random_);
      any = false;
      for (const std::size_t i : order) {
        Subject& subject = subjects_[i];
        if (is_finished(subject)) continue;
        if (options_.is_stopped()) return;
        any = true;
        tell(subject, fmt::format("run {}{}", subject.runs.size() + 1, width_text(subject)));
        run(subject, true, false);
        ++done_;
      }
      judge();
    }
  }

  /// If too few runs were quiet, the least disturbed count too.
  void settle() {
    const auto repeat = static_cast<std::size_t>(options_.repeat);
    for (Subject& subject : subjects_) {
      std::vector<Run*> left_out;
      for (Run& run : subject.runs)
        if (is_noise(run.left_out)) left_out.push_back(&run);
      std::ranges::stable_sort(left_out, {}, [](const Run* run) { return run->others; });
      std::size_t wanted = (subject.once ? 1 : repeat) - std::min(repeat, counted(subject));
      for (Run* run : left_out) {
        if (wanted == 0) break;
        --wanted;
        run->disturbed = std::exchange(run->left_out, "");
        subject.noisy = true;
      }
    }
    if (options_.on_runs) options_.on_runs();
  }

 private:
  /// Whether the way has the requested runs, or as many again were disturbed.
  bool is_finished(const Subject& subject) const {
    const std::size_t repeat = static_cast<std::size_t>(options_.repeat), count = counted(subject);
    if (subject.once || !subject.problem.empty() || options_.repeat == 0) return true;
    if (subject.runs.size() >= 2 * std::max(repeat, count) || count >= std::max(repeat, most_runs))
      return true;
    if (count < repeat) return false;
    const Spread times = subject.seconds();
    if (std::accumulate(times.runs.begin(), times.runs.end(), 0.0) < options_.seconds) return false;
    return options_.precision <= 0 || is_precise(subject, options_.precision);
  }

  bool is_over() const { return options_.budget > 0 && clock_.seconds() > options_.budget; }

  /// The precision of the way's median so far, if one was requested.
  std::string width_text(const Subject& subject) const {
    if (options_.precision <= 0 || counted(subject) < fewest_for_interval) return "";
    return fmt::format(", known to {:.1f} %", 100 * half_width(subject.seconds()));
  }

  void tell(const Subject& subject, const std::string& what) const {
    const double all = static_cast<double>(subjects_.size()) * (1 + options_.repeat);
    if (options_.on_step)
      options_.on_step(subject.name + ", " + what, std::min(0.99, static_cast<double>(done_) / all));
  }

  void run(Subject& subject, bool counts, bool first) {
    try {
      enter(options_, subject.name);
      if (first && subject.prepare) subject.prepare();
      options_.load->begin(meters_[static_cast<std::size_t>(&subject - subjects_.data())].get());
      const double seconds = subject.run();
      Run run = options_.load->end();
      run.seconds = seconds;
      if (options_.is_stopped()) return;
      const std::string wrong = subject.check ? subject.check() : "";
      if (!wrong.empty()) fail(subject, wrong);
      if (!wrong.empty()) run.left_out = "wrong result";
      if (counts) subject.runs.push_back(run);
    } catch (const DeviceError& error) {
      fail(subject, error.what());
    } catch (const BuildError& error) {
      fail(subject, error.what());
    }
    if (options_.on_runs) options_.on_runs();
  }

  static void fail(Subject& subject, const std::string& why) {
    subject.failure = std::current_exception();
    subject.problem = subject.runs.empty() ? why : fmt::format("run {}: {}", subject.runs.size() + 1, why);
  }

  void judge() {
    for (Subject& subject : subjects_) {
      for (Run& run : subject.runs) {
        if (!run.left_out.empty() && !is_noise(run.left_out)) continue;
        run.left_out = disturbance(subject, run, options_.load->limit());
        run.disturbed.clear();  // by settle(), in the report that is continued
      }
    }
  }

  std::vector<Subject>& subjects_;
  const MeasureOptions& options_;
  std::vector<std::unique_ptr<EnergyMeter>> meters_;  // of each subject's devices
  std::size_t done_ = 0;
  std::mt19937 random_;
  Stopwatch clock_;
};

}  // namespace

std::string disturbance(const MeasuredWay& way, const Run& run, double limit) {
  const auto any = [&](const auto& is_better) { return std::ranges::any_of(way.runs, is_better); };
  if (run.others > limit || any([&](const Run& other) {
        return run.cores < fewer_cores * other.cores && run.seconds > longer * other.seconds;
      }))
    return busy;
  const bool slow = any([&](const Run& other) {
    return run.clock > 0 && run.clock < slower * other.clock && slower * run.seconds > other.seconds;
  });
  return slow ? slow_clock : "";
}

bool is_precise(const MeasuredWay& way, double precision) {
  const Spread times = way.seconds();
  return times.runs.size() >= fewest_for_interval && half_width(times) <= precision;
}

bool prepared(std::vector<Subject>& subjects, const MeasureOptions& options,
              const std::function<void()>& work) {
  const auto fail_all = [&](const char* why) {
    for (Subject& subject : subjects) {
      subject.problem = why;
      subject.failure = std::current_exception();
    }
  };
  try {
    enter(options, subjects.front().name + ", before its runs");
    work();
    return true;
  } catch (const DeviceError& error) {
    fail_all(error.what());
  } catch (const BuildError& error) {
    fail_all(error.what());
  }
  return false;
}

void measure(std::vector<Subject>& subjects, const MeasureOptions& options) {
  MeasureOptions own = options;
  if (!own.load) own.load = std::make_shared<LoadMeter>(std::thread::hardware_concurrency());
  Measurement measurement(subjects, own);
  measurement.warm_up();
  measurement.rounds();
  measurement.settle();
  enter(own, "");
}

}  // namespace sundog
