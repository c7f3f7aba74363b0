// `sundog bench threads`: times against image size and number of threads.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <thread>

#include "app/bench_options.h"
#include "app/option_helpers.h"
#include "base/error.h"
#include "bench/machine.h"
#include "bench/thread_scaling.h"

namespace sundog {
namespace {

struct ThreadsOptions : BenchOptions {
  std::string sizes = "128,256,352,448,512,640", counts = "1,2,4,8,16";
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
    for (const DeviceInfo& row : enumerate_devices())
      if (row.usable() && row.max_sub_devices > 0) devices.push_back(row);
    if (devices.empty())
      throw DeviceError("no device here splits into sub-devices (PoCL's do: Debian's pocl-opencl-icd)");
    devices = {*std::ranges::max_element(devices, {}, &DeviceInfo::estimate)};
  }
  if (devices.size() > 1)
    throw UsageError(fmt::format("bench threads takes one device, --device means {}: {} and {}",
                                 devices.size(), devices[0].label(), devices[1].label()));
  if (devices[0].max_sub_devices == 0)
    throw DeviceError(
        fmt::format("{} cannot be split into sub-devices: choose another --device", devices[0].label()));
  return devices[0];
}

int bench_threads(const ThreadsOptions& options) {
  Report report = new_report("threads", "Times by image size and number of threads", options);
  ThreadScaling plan;
  plan.sizes = parse_list("--sizes", options.sizes, 1, 65536);
  const std::vector<int> counts = parse_list("--counts", options.counts, 1, 4096);
  plan.counts.assign(counts.begin(), counts.end());
  plan.repeat = options.repeat;
  plan.plain = !options.no_plain;
  allow_threads(counts.back());
  plan.device = device_to_split(options);
  add_device_facts(report, {plan.device});
  if (plan.plain) report.facts.emplace_back("plain C++", compiler_text() + ", one thread");
  for (const std::string& file : options.scenes) {
    plan.scene = scene_name(file);
    plan.compile_for = [&](int size) {
      return bench_scene(file, options,
                         {fmt::format("/image/width={}", size), fmt::format("/image/height={}", size)});
    };
    const auto times = measure_threads(plan, [&](const std::string& step) { show_step(options, step); });
    add_thread_tables(report, plan, times);
    for (const ThreadTime& time : times)
      if (!time.problem.empty())
        report.notes.push_back(
            fmt::format("{}, {} pixels, {}: {}", plan.scene, time.size,
                        time.threads ? fmt::format("{} threads", time.threads) : "plain C++", time.problem));
  }
  report.notes.push_back(
      fmt::format("Median of {} frames, after one to warm up, the counts in turn; from the first launch "
                  "until the film is on the "
                  "host, without building kernels. Threads are compute units of a sub-device; their images "
                  "are the same to the "
                  "bit.",
                  options.repeat));
  if (plan.plain)
    report.notes.push_back(
        "Plain C++ is the same integrator written as an ordinary program: recursion, scalar floats, the same "
        "BVH, none "
        "of the kernels' code; its image is the device's but for rounding. Speed-ups are over one thread of "
        "the device.");
  return publish(report, options);
}

}  // namespace

void add_bench_threads(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<ThreadsOptions>();
  Arguments* app =
      bench.add_subcommand("threads", "Times by image size and number of threads, speed-up, efficiency");
  add_bench_options(app, *options);
  value(app, "--sizes", "N,N...", options->sizes, "pixels a side (default 128,256,352,448,512,640)");
  value(app, "--counts", "N,N...", options->counts, "threads (default 1,2,4,8,16)");
  app->add_flag("--no-plain", options->no_plain, "without the column of plain single-threaded C++");
  app->callback([options, &chosen] { chosen = RunLater{[options] { return bench_threads(*options); }}; });
}

}  // namespace sundog
