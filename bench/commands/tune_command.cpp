// `sundog tune`: finds and keeps the fastest settings of a device; --show, --forget, --export and --import
// handle the kept results. A child process tunes each device and is killed when its budget is over, because
// drivers cannot be asked to stop compiling.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/options/command.h"
#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/process/child_process.h"
#include "app/process/environment.h"
#include "app/process/exit_status.h"
#include "app/process/progress.h"
#include "app/process/standard_streams.h"
#include "base/cache_folder.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/memory_file.h"
#include "bench/commands/bench_options.h"
#include "bench/commands/bench_progress.h"
#include "bench/rays/self_check.h"
#include "bench/report/report.h"
#include "bench/tune/tuner.h"
#include "render/device/tuning.h"
#include "scene/json/parse.h"
#include "scene/load.h"

namespace sundog {
namespace {

struct TuneOptions {
  BenchOptions bench;  // scenes, devices, overrides
  double budget = 60;  // seconds for a device
  bool show = false, forget = false;
  std::string export_to, import_from;
  std::string worker;                // "P:D" or "P:D/N": this is the child that tunes this device
  std::vector<std::string> crashed;  // steps at which earlier children crashed
};

constexpr const char* step_mark = "> ";    // before a step of the child
constexpr const char* end_mark = "> end";  // before a final remark

const std::string crash_text = "the driver crashed";

/// Seconds after which a child is killed: it may exceed its budget a little if the machine has become slower.
double patience(double budget) { return budget + std::max(1.0, 0.1 * budget); }

struct NamedScene {
  std::string name;
  CompiledScene scene;
};

/// The scenes of the command line, or two built-in ones: with a mesh, and with solids only.
std::vector<NamedScene> scenes_to_tune(const TuneOptions& options) {
  std::vector<NamedScene> scenes;
  for (const std::string& file : options.bench.scenes)
    scenes.push_back({scene_name(options.bench, file), bench_scene(file, options.bench)});
  if (!scenes.empty()) return scenes;
  SceneDescription built_in = self_check_scene();
  built_in.image.width = 320;
  built_in.image.height = 240;
  scenes.push_back({"built-in meshes", compile(built_in)});
  std::erase_if(built_in.objects,
                [](const Object& object) { return std::holds_alternative<MeshShape>(object.shape); });
  built_in.meshes.clear();
  scenes.push_back({"built-in solids", compile(built_in)});
  return scenes;
}

/// Prints and flushes a line, as the process may be killed next.
void say(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

std::string outcome_text(const DeviceInfo& device, const TuneOutcome& outcome) {
  const TuningEntry& entry = outcome.entry;
  const bool faster = entry.tuned_ms < entry.default_ms;
  std::string text = fmt::format(
      "{}, {} ({}), {}: {}\n  {} ms with the defaults, {} ms tuned: {}; {} tried, {} rejected{}{}",
      device.label(), entry.scene_class, entry.scene, entry.kernel, tuning_text(entry.tuning),
      number_text(entry.default_ms), number_text(entry.tuned_ms),
      faster ? fmt::format("{:.1f} % less time", 100 * (1 - entry.tuned_ms / entry.default_ms))
             : "nothing is worth keeping",
      outcome.tried, outcome.rejected.size(),
      outcome.left_out > 0 ? fmt::format(", at least {} left out for lack of time", outcome.left_out) : "",
      outcome.frames.empty() ? "" : fmt::format("; frames of {}", outcome.frames));
  for (const std::string& rejected : outcome.rejected) text += "\n  rejected: " + rejected;
  return text;
}

/// Tunes the scenes in turn; each may take its share of the remaining budget. Returns the names of those for
/// which no time was left.
std::vector<std::string> tune_scenes(const DeviceInfo& device, const std::vector<NamedScene>& scenes,
                                     const TuneOptions& options, const Stopwatch& clock, TuneCosts& costs) {
  const double budget = options.budget;
  std::vector<std::string> left_out;
  BenchProgress progress(true, budget);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const NamedScene& named = scenes[i];
    const double left = budget - clock.seconds();
    if (i > 0 && left < costs.compile) {
      left_out.push_back(named.name);
      continue;
    }
    const auto on_step = [&](const std::string& step) {
      const std::string whole = named.name + ", " + step;
      if (std::ranges::count(options.crashed, whole) > 0) return crash_text;
      say(step_mark + whole);
      progress.update(fmt::format("{}, {}: {}", device.label(), named.name, step),
                      budget > 0 ? clock.seconds() / budget : 1);
      return std::string();
    };
    const auto on_outcome = [&](const TuneOutcome& outcome) {
      keep_tuning(device, outcome.entry);
      progress.erase();
      say(outcome_text(device, outcome));
    };
    if (!tune_device(device, named.scene, named.name, left / static_cast<double>(scenes.size() - i), costs,
                     {on_step, on_outcome}))
      left_out.push_back(fmt::format("{} of {}", surfaces_kernel, named.name));
  }
  return left_out;
}

/// A worker's output so far.
struct Heard {
  std::string step = "starting", remark;
  bool has_outcome = false, has_ended = false;

  void take(const std::string& line) {
    if (line.starts_with(end_mark)) {
      has_ended = true;
      remark = line.substr(std::string(end_mark).size());
    } else if (line.starts_with(step_mark)) {
      step = line.substr(std::string(step_mark).size());
    } else {
      has_outcome = true;
      say(line);
    }
  }
};

std::vector<std::string> worker_arguments(const TuneOptions& options, const DeviceInfo& device) {
  std::vector<std::string> arguments{"tune"};
  for (const std::string& scene : options.bench.scenes) arguments.push_back(scene);
  for (const std::string& setting : options.bench.overrides)
    arguments.insert(arguments.end(), {"--set", setting});
  if (options.bench.outside_files) arguments.push_back("--allow-outside-files");
  for (const std::string& step : options.crashed) arguments.insert(arguments.end(), {"--crashed", step});
  arguments.insert(arguments.end(),
                   {"--budget", fmt::format("{}", options.budget), "--worker", device.spec()});
  return arguments;
}

/// The streams of a worker: stderr, and a copy of standard input if a scene comes from there.
std::vector<HandedDown> worker_streams(const TuneOptions& options) {
  std::vector<HandedDown> streams{{STDERR_FILENO, STDERR_FILENO}};
  if (std::ranges::any_of(options.bench.scenes, [](const auto& file) { return is_standard_input(file); }))
    streams.push_back({memory_file(standard_input()), STDIN_FILENO});
  return streams;
}

/// A line on the tuning of a device; empty if there is no result.
std::string end_text(const DeviceInfo& device, const Heard& heard, int signal, double seconds,
                     double budget) {
  const std::string took =
      fmt::format("{}: took {} of {}", device.label(), duration_text(seconds), duration_text(budget));
  if (heard.has_ended) return took + heard.remark;
  if (!heard.has_outcome) return "";
  if (signal) return fmt::format("{}; the driver crashed (signal {}, {})", took, signal, heard.step);
  return fmt::format("{}; ended during a compilation or a launch ({}; a longer --budget)", took, heard.step);
}

/// A line on a device without a result in its time.
std::string nothing_text(const DeviceInfo& device, const Heard& heard, double seconds) {
  return fmt::format("{} was ended after {} with no result, during a compilation or a launch ({})",
                     device.label(), duration_text(seconds), heard.step);
}

/// Tunes a device by a worker; after a crash, starts another worker that skips the settings that crashed.
ChildResult tune_by_workers(TuneOptions options, const DeviceInfo& device, Heard& heard) {
  const std::vector<HandedDown> streams = worker_streams(options);
  const double budget = options.budget;
  const Stopwatch clock;
  for (;;) {
    if (streams.size() > 1) ::lseek(streams.back().here, 0, SEEK_SET);
    const ChildResult child = run_self(
        worker_arguments(options, device), {}, patience(options.budget),
        [&](const std::string& line) { heard.take(line); }, streams);
    options.budget = budget - clock.seconds();
    const bool crashed_at_it = std::ranges::count(options.crashed, heard.step) > 0;
    if (!child.signal || child.timed_out || crashed_at_it || options.budget <= 0) return child;
    options.crashed.push_back(heard.step);
  }
}

/// Tunes the devices in turn and prints their results, until one fails. Returns the exit status. Throws
/// DeviceError if a driver crashed without a result, or if the budget was too short for any result.
int tune_devices(const TuneOptions& options) {
  const std::vector<DeviceInfo> devices = bench_devices(options.bench);
  std::vector<std::string> without;
  for (const DeviceInfo& device : devices) {
    const Stopwatch clock;
    Heard heard;
    const ChildResult child = tune_by_workers(options, device, heard);
    if (stderr_is_terminal()) fmt::print(stderr, "\r\x1b[K");
    const int signal = child.timed_out ? 0 : child.signal;
    if (signal && !heard.has_outcome)
      throw DeviceError(
          fmt::format("{}: its driver crashed (signal {}, {})", device.label(), signal, heard.step));
    if (child.status > 0) return child.status;  // the worker has said why
    const std::string end = end_text(device, heard, signal, clock.seconds(), options.budget);
    if (end.empty())
      without.push_back(nothing_text(device, heard, clock.seconds()));
    else
      say(end);
  }
  if (without.size() == devices.size())
    throw DeviceError(fmt::format("{}: give a longer --budget than {}", fmt::join(without, "; "),
                                  duration_text(options.budget)));
  for (const std::string& what : without) say(what);
  return exit_done;
}

/// The worker: tunes its device, keeps the results and prints them to stdout, with lines about its steps in
/// between.
int tune_one_device(const TuneOptions& options) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const Stopwatch clock;
  const DeviceInfo device = select_devices(list_devices(), {options.worker}).front();
  TuneCosts costs;
  const auto left_out = tune_scenes(device, scenes_to_tune(options), options, clock, costs);
  if (!left_out.empty())
    say(fmt::format("{}: not tuned for lack of time: {} (a longer --budget)", device.label(),
                    fmt::join(left_out, ", ")));
  const bool is_over = clock.seconds() > options.budget && costs.compile > 0.5 * options.budget;
  say(end_mark +
      (is_over ? fmt::format("; one compilation alone took {}", duration_text(costs.compile)) : ""));
  return exit_done;
}

using nlohmann::json;
namespace fs = std::filesystem;

std::vector<fs::path> kept_files() {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(tuning_folder(*program_environment()), none))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<TuningFile> kept() {
  std::vector<TuningFile> all;
  for (const fs::path& file : kept_files()) {
    try {
      all.push_back(read_tuning_file(file));
    } catch (const SceneError& error) {
      fmt::print(stderr, "sundog: warning: {}\n", error.what());
    }
  }
  return all;
}

std::string label(const TuningFile& file) {
  const std::string units = file.units > 0 ? fmt::format("/{}", file.units) : "";
  return fmt::format("{} / {}{}", file.platform, file.device, units);
}

int show() {
  const std::vector<TuningFile> files = kept();
  if (files.empty())
    fmt::print("There are no results in {}.\n", tuning_folder(*program_environment()).string());
  const std::string kernels = kernels_hash(*program_environment());
  for (const TuningFile& file : files) {
    fmt::print("{}, driver {}{}\n", label(file), file.driver,
               file.kernels == kernels ? "" : ": for other kernels, not used");
    for (const TuningEntry& entry : file.entries)
      fmt::print("  {:<14} {}: {}: {} ms, {} ms with the defaults ({})\n", entry.scene_class, entry.kernel,
                 tuning_text(entry.tuning), number_text(entry.tuned_ms), number_text(entry.default_ms),
                 entry.scene);
  }
  return exit_done;
}

int forget(const TuneOptions& options) {
  std::vector<fs::path> files = kept_files();
  if (!options.bench.devices.empty()) {
    files.clear();
    for (const DeviceInfo& device : bench_devices(options.bench)) files.push_back(tuning_path(device));
  }
  std::size_t removed = 0;
  std::error_code kept;
  for (const fs::path& file : files) removed += fs::remove(file, kept);
  fmt::print("{} file{} removed from {}\n", removed, removed == 1 ? "" : "s",
             tuning_folder(*program_environment()).string());
  return exit_done;
}

int export_all(const std::string& path) {
  json list = json::array();
  std::size_t entries = 0;
  for (const TuningFile& file : kept()) {
    list.push_back(to_json(file));
    entries += file.entries.size();
  }
  if (is_standard_stream(path)) claim_standard_output();
  write_output(path, json_text(list, 2) + "\n");
  fmt::print("{}: {} result{} of {} device{}\n", path, entries, entries == 1 ? "" : "s", list.size(),
             list.size() == 1 ? "" : "s");
  return exit_done;
}

/// Imports results for devices of this machine with the same driver and kernels; skips the others, with the
/// reason.
int import_all(const std::string& path) {
  const JsonContext context{.file = path};
  const json list = read_json_file(path);
  std::vector<TuningFile> files;
  for (const JsonValue& value : JsonValue(list, context).items("what `sundog tune --export` writes"))
    files.push_back(read_tuning(value));
  const std::string kernels = kernels_hash(*program_environment());
  const std::vector<DeviceInfo> devices = list_devices();
  for (const TuningFile& file : files) {
    const auto here = std::ranges::find_if(devices, [&](const DeviceInfo& device) {
      return device.platform_name == file.platform && device.name == file.device &&
             device.driver == file.driver;
    });
    const std::string why = file.kernels != kernels ? "it was measured with other kernels"
                            : here == devices.end() ? "there is no such device on this machine"
                                                    : "";
    if (why.empty()) {
      DeviceInfo device = *here;
      device.sub_units = file.units;
      for (const TuningEntry& entry : file.entries) keep_tuning(device, entry);
    }
    fmt::print("{}: {}\n", label(file), why.empty() ? "imported" : "skipped: " + why);
  }
  return exit_done;
}

int run_tune(const TuneOptions& options) {
  if (!(options.budget >= 0 && options.budget <= 1e6))
    throw UsageError(fmt::format("--budget {}: wanted seconds, from 0 to 1000000", options.budget));
  if (options.forget && options.show) throw UsageError("--forget, --show: one of them");
  if (!options.import_from.empty()) import_all(options.import_from);
  if (!options.export_to.empty()) return export_all(options.export_to);
  if (options.forget) return forget(options);
  if (options.show) return show();
  if (!options.import_from.empty()) return exit_done;
  if (const std::string why = cache_refusal(program_environment()->cache); !why.empty()) throw IoError(why);
  return options.worker.empty() ? tune_devices(options) : tune_one_device(options);
}

}  // namespace

void add_tune(Arguments& root, Command& chosen) {
  const auto options = std::make_shared<TuneOptions>();
  Arguments* app =
      root.add_subcommand("tune", "Find the fastest settings of a device and keep them; `render` uses them");
  value(app, "SCENE", "FILE", options->bench.scenes,
        std::string(scene_help) + " (default: two built-in scenes)");
  values(app, "--device", "SPEC", options->bench.devices, device_help);
  values(app, "--set", "POINTER=VALUE", options->bench.overrides, "change the scenes, as in /camera/fov=30");
  outside_files(app, options->bench.outside_files);
  value(app, "--budget", "SECONDS", options->budget, "seconds for a device, with compilation (default 60)");
  app->add_option("--worker", options->worker)->hidden();
  app->add_option("--crashed", options->crashed)->hidden();
  app->add_flag("--show", options->show, "print the results that are kept");
  app->add_flag("--forget", options->forget, "remove the results of --device, or all");
  value(app, "--export", "FILE", options->export_to, "write all results to this file");
  value(app, "--import", "FILE", options->import_from,
        "read results that --export wrote, for devices of this machine");
  app->callback([options, &chosen] { chosen = Command{[options] { return run_tune(*options); }}; });
}

}  // namespace sundog
