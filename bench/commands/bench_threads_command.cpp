// `sundog bench threads`: times against image size and number of threads.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <thread>

#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/process/progress.h"
#include "base/error.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/thread_budget.h"
#include "bench/report/machine.h"

namespace sundog {
namespace {

struct ThreadsOptions : BenchOptions {
  std::string sizes, counts;  // empty: the usual ones
  double budget = -1;         // seconds; 0: no limit; below: not given
  bool no_plain = false;
};

/// PoCL has as many compute units as the machine has cores, unless told otherwise before the first OpenCL
/// call.
void allow_threads(int most) {
  if (most > static_cast<int>(std::thread::hardware_concurrency()))
    setenv("POCL_MAX_PTHREAD_COUNT", std::to_string(most).c_str(), 0);
}

/// The device that was asked for, or the fastest of those that split.
DeviceInfo device_to_split(const BenchOptions& options) {
  const bool asked = !options.devices.empty() || !devices_of_environment().empty();
  std::vector<DeviceInfo> devices;
  if (asked) {
    devices = bench_devices(options);
  } else {
    for (const DeviceInfo& row : list_devices())
      if (row.usable() && row.max_sub_devices > 0) devices.push_back(row);
    if (devices.empty())
      throw DeviceError(
          "no device here can be split into sub-devices (PoCL's can: Debian's pocl-opencl-icd)");
    devices = {*std::ranges::max_element(devices, {}, &DeviceInfo::estimate)};
  }
  if (devices.size() > 1)
    throw UsageError(fmt::format("bench threads takes one device, but --device matches {}: {} and {}",
                                 devices.size(), devices[0].label(), devices[1].label()));
  if (devices[0].max_sub_devices == 0)
    throw DeviceError(
        fmt::format("{} cannot be split into sub-devices: choose another --device", devices[0].label()));
  return devices[0];
}

/// Powers of two up to the machine's cores, one and two at least.
std::vector<unsigned> usual_counts() {
  std::vector<unsigned> counts{1, 2};
  while (2 * counts.back() <= std::thread::hardware_concurrency()) counts.push_back(2 * counts.back());
  return counts;
}

std::vector<unsigned> counts_of(const ThreadsOptions& options) {
  if (options.counts.empty()) return usual_counts();
  const std::vector<int> counts = parse_list("--counts", options.counts, 1, 4096);
  return {counts.begin(), counts.end()};
}

/// One plan for each scene, cut down to the budget. What was left out goes to the report's notes.
std::vector<ThreadScaling> make_plans(const ThreadsOptions& options, const ThreadScaling& usual,
                                      BenchRun& run) {
  std::vector<ThreadScaling> plans;
  for (const std::string& file : options.scenes) {
    ThreadScaling plan = usual;
    plan.scene = scene_name(file);
    plan.compile_for = [&run, &options, file](int size) {
      auto scene = bench_scene(file, options,
                               {fmt::format("/image/width={}", size), fmt::format("/image/height={}", size)});
      run.add_scene(scene_name(file), file, scene);
      return scene;
    };
    show_step(options, plan.scene + ", a small frame for the estimate");
    plan.cost = pixel_cost(plan);
    // Sizes that the user names are all measured.
    const double budget = options.budget >= 0 ? options.budget : options.sizes.empty() ? 100.0 : 0.0;
    if (budget > 0) {
      const auto left_out = fit_into(plan, budget / static_cast<double>(options.scenes.size()));
      if (!left_out.empty())
        run.head().notes.push_back(
            fmt::format("{}: left out to take about {} in all: {} (--budget SECONDS, or --sizes).",
                        plan.scene, duration_text(budget), fmt::join(left_out, ", ")));
    }
    plans.push_back(std::move(plan));
  }
  return plans;
}

/// Before the first measurement: how long it will take, and what was left out for that.
void announce(const ThreadsOptions& options, const std::vector<ThreadScaling>& plans, const Report& report) {
  double seconds = 0, plain = 0;
  for (const ThreadScaling& plan : plans) {
    seconds += expected_seconds(plan);
    for (const int size : plan.sizes) plain += plain_seconds(plan, size);
  }
  if (options.quiet) return;
  if (stderr_is_terminal()) fmt::print(stderr, "\r\033[K");
  fmt::print(stderr, "sundog: this will take about {}{}\n", duration_text(seconds),
             plain >= 1 ? fmt::format(", {} of it in plain C++ (--no-plain)", duration_text(plain)) : "");
  for (const std::string& note : report.notes)
    if (note.find(": left out to take") != std::string::npos) fmt::print(stderr, "sundog: {}\n", note);
}

int bench_threads(const ThreadsOptions& options) {
  BenchRun run("threads", "Times by image size and number of threads", options);
  Report& head = run.head();
  ThreadScaling plan;
  if (!options.sizes.empty()) plan.sizes = parse_list("--sizes", options.sizes, 1, 65536);
  plan.counts = counts_of(options);
  plan.repeat = options.repeat;
  plan.plain = !options.no_plain;
  plan.cores = std::max(1u, std::thread::hardware_concurrency());
  allow_threads(static_cast<int>(plan.counts.back()));
  plan.device = device_to_split(options);
  run.add_devices({plan.device});
  if (plan.plain) head.facts.emplace_back("plain C++", compiler_text() + ", one thread");
  const std::vector<ThreadScaling> plans = make_plans(options, plan, run);
  announce(options, plans, head);
  head.notes.push_back(
      fmt::format("Median of {} frames after two to warm up, sizes and counts in turn, from the first launch "
                  "until the film is on the host, without building kernels. Threads are compute units of a "
                  "sub-device. All images of a size are the same to the bit.",
                  plans.empty() ? options.repeat : plans.front().repeat));
  if (plan.plain)
    head.notes.push_back(
        "Plain C++ is the same integrator written as an ordinary program: recursion, scalar floats, the same "
        "BVH, none of the kernels' code. It draws one frame of each size, which is the device's image but "
        "for rounding. Speed-ups are over one thread of the device.");
  for (const ThreadScaling& each : plans) run.measure(std::make_shared<ThreadTimes>(each), 0, each.repeat);
  return run.publish();
}

}  // namespace

void add_bench_threads(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<ThreadsOptions>();
  Arguments* app = add_bench_command(bench, chosen, "threads",
                                     "Times by image size and number of threads, speed-up, efficiency",
                                     options, bench_threads);
  value(app, "--sizes", "N,N...", options->sizes, "pixels a side (default 128,256,352,448,512,640)");
  value(app, "--counts", "N,N...", options->counts,
        "threads (default: powers of two up to the machine's cores)");
  value(app, "--budget", "SECONDS", options->budget,
        "about how long it may take: larger sizes of plain C++, frames, then larger images are left out "
        "(default 100, or no limit with --sizes)")
      ->range(0, 1e6);
  app->add_flag("--no-plain", options->no_plain, "without the column of plain single-threaded C++");
}

}  // namespace sundog
