// See tune_devices.h.
#include "bench/commands/tune_devices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "app/options/devices.h"
#include "app/process/child_process.h"
#include "app/process/exit_status.h"
#include "app/process/progress.h"
#include "app/process/standard_streams.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/memory_file.h"
#include "bench/commands/bench_progress.h"
#include "bench/rays/self_check.h"
#include "bench/report/report.h"
#include "bench/tune/tuner.h"
#include "render/device/tuning.h"
#include "scene/load.h"

namespace sundog {
namespace {

constexpr const char* step_mark = "> ";    // before a step of the worker's
constexpr const char* end_mark = "> end";  // before what is to be said of the whole

/// When a device is ended: the worker measures a little past its budget, if the machine has become slower.
double patience(double budget) { return budget + std::max(1.0, 0.1 * budget); }

struct NamedScene {
  std::string name;
  CompiledScene scene;
};

/// Scenes of the command line, or two that are built in: solids alone, and with a mesh among them.
std::vector<NamedScene> scenes_to_tune(const TuneOptions& options) {
  std::vector<NamedScene> scenes;
  for (const std::string& file : options.bench.scenes)
    scenes.push_back({scene_name(file), bench_scene(file, options.bench)});
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

/// At once: what follows may be ended.
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

/// The scenes in turn; each may take its share of the remaining budget. Returns what there was no time
/// to begin.
std::vector<std::string> tune_scenes(const DeviceInfo& device, const std::vector<NamedScene>& scenes,
                                     double budget, const Stopwatch& clock, TuneCosts& costs) {
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
      say(fmt::format("{}{}, {}", step_mark, named.name, step));
      progress.update(fmt::format("{}, {}: {}", device.label(), named.name, step),
                      budget > 0 ? clock.seconds() / budget : 1);
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
  arguments.insert(arguments.end(),
                   {"--budget", fmt::format("{}", options.budget), "--worker", device.spec()});
  return arguments;
}

/// The standard input again for each worker, where a scene comes from there.
std::vector<HandedDown> worker_streams(const TuneOptions& options) {
  std::vector<HandedDown> streams{{STDERR_FILENO, STDERR_FILENO}};
  if (std::ranges::any_of(options.bench.scenes, [](const auto& file) { return is_standard_input(file); }))
    streams.push_back({memory_file(standard_input()), STDIN_FILENO});
  return streams;
}

/// How it went, in a line; empty: there is no result.
std::string end_text(const DeviceInfo& device, const Heard& heard, double seconds, double budget) {
  const std::string took =
      fmt::format("{}: took {} of {}", device.label(), duration_text(seconds), duration_text(budget));
  if (heard.has_ended) return took + heard.remark;
  if (!heard.has_outcome) return "";
  return fmt::format("{}; ended during a compilation or a launch ({}; a longer --budget)", took, heard.step);
}

/// The report of a device that had no result in its time.
std::string nothing_text(const DeviceInfo& device, const Heard& heard, double seconds) {
  return fmt::format("{} was ended after {} with no result, during a compilation or a launch ({})",
                     device.label(), duration_text(seconds), heard.step);
}

}  // namespace

int tune_devices(const TuneOptions& options) {
  const std::vector<DeviceInfo> devices = bench_devices(options.bench);
  const std::vector<HandedDown> streams = worker_streams(options);
  std::vector<std::string> without;
  for (const DeviceInfo& device : devices) {
    const Stopwatch clock;
    Heard heard;
    if (streams.size() > 1) ::lseek(streams.back().here, 0, SEEK_SET);
    const ChildResult child = run_self(
        worker_arguments(options, device), {}, patience(options.budget),
        [&](const std::string& line) { heard.take(line); }, streams);
    if (stderr_is_terminal()) fmt::print(stderr, "\r\x1b[K");
    if (child.signal && !child.timed_out)
      throw DeviceError(
          fmt::format("{}: its driver crashed (signal {}, {})", device.label(), child.signal, heard.step));
    if (child.status > 0) return child.status;  // the worker has said why
    const std::string end = end_text(device, heard, clock.seconds(), options.budget);
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

int tune_one_device(const TuneOptions& options) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const Stopwatch clock;
  const DeviceInfo device = select_devices(list_devices(), {options.worker}).front();
  TuneCosts costs;
  const auto left_out = tune_scenes(device, scenes_to_tune(options), options.budget, clock, costs);
  if (!left_out.empty())
    say(fmt::format("{}: not tuned for lack of time: {} (a longer --budget)", device.label(),
                    fmt::join(left_out, ", ")));
  const bool is_over = clock.seconds() > options.budget && costs.compile > 0.5 * options.budget;
  say(end_mark +
      (is_over ? fmt::format("; one compilation alone took {}", duration_text(costs.compile)) : ""));
  return exit_done;
}

}  // namespace sundog
