// One run of a bench. It saves measurements as they are made and reports them at the end, even after an
// interruption.
#pragma once
#include <algorithm>
#include <map>
#include <memory>

#include "app/process/interrupt.h"
#include "app/process/standard_streams.h"
#include "base/arguments.h"
#include "bench/commands/bench_options.h"
#include "bench/commands/bench_progress.h"
#include "bench/commands/crash_guard.h"
#include "bench/runs/measure.h"

namespace sundog {

class BenchRun {
 public:
  /// `name` is the benchmark's. Throws IoError if an output file cannot be written, UsageError if the report
  /// to continue is from another bench or revision.
  BenchRun(const std::string& name, const std::string& title, const BenchOptions& options);

  /// The report without measurements: its facts, and the notes that follow the measurements' notes.
  Report& head() { return head_; }
  void add_devices(const std::vector<DeviceInfo>& devices);
  /// Adds and returns the devices that the options select.
  std::vector<DeviceInfo> devices();
  /// `more`: the bench's own overrides of the scene. Throws UsageError if the report to continue measured a
  /// different scene with this name and these overrides.
  void add_scene(const std::string& file, const CompiledScene& scene,
                 const std::vector<std::string>& more = {});
  std::shared_ptr<const CompiledScene> compiled(const std::string& file,
                                                const std::vector<std::string>& more = {});

  /// Measures `part`, which has measure(MeasureOptions) and add_to(Report&); does nothing after an
  /// interruption. `budget` in seconds; 0: no limit. `repeat` below 0: the options' value.
  template <class Part>
  void measure(const std::shared_ptr<Part>& part, double budget = 0, int repeat = -1) {
    if (is_stopped()) return;
    parts_.push_back([part](Report& report) { part->add_to(report); });
    part->measure(measuring(budget, repeat));
  }
  bool is_stopped() const { return stop_.flag(); }
  /// Writes the files and prints the report. Returns the exit status. If all ways have a problem, throws the
  /// first one's; with `all_right`, throws DeviceError for any wrong result.
  int publish(bool all_right = false);

 private:
  MeasureOptions measuring(double budget, int repeat);
  void take_known(const std::string& file);
  Report so_far() const;
  void keep();

  BenchOptions options_;
  StopOnSignal stop_;
  Report head_;
  Table known_devices_, known_scenes_;        // of the report to continue
  std::map<std::string, MeasuredWay> known_;  // its runs by way
  std::vector<std::function<void(Report&)>> parts_;
  std::shared_ptr<LoadMeter> load_;
  std::unique_ptr<BenchProgress> progress_;
  Stopwatch since_kept_;
  double keeping_ = 0;  // seconds that the last keep() took
};

/// Declares `sundog bench NAME` with the options of all benches; the command calls `run` with them.
template <class Options>
Arguments* add_bench_command(Arguments& bench, Command& chosen, const std::string& name,
                             const std::string& description, const std::shared_ptr<Options>& options,
                             int (*run)(const Options&), bool scene_needed = true) {
  Arguments* app = bench.add_subcommand(name, description);
  add_bench_options(app, *options, scene_needed);
  app->callback([options, run, &chosen] {
    const bool reads_input =
        std::ranges::any_of(options->scenes, [](const auto& file) { return is_standard_stream(file); });
    chosen = {.run = [=] { return guarded([&] { return run(*options); }, reads_input); },
              .stops_on_signal = true};
  });
  return app;
}

}  // namespace sundog
