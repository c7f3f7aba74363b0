// `sundog bench devices`: which device, or which devices together, draw a scene fastest.
#include <fmt/format.h>

#include <memory>

#include "app/bench/bench_options.h"
#include "app/options/option_helpers.h"
#include "bench/frames/device_ranking.h"

namespace sundog {
namespace {

int bench_devices_command(const BenchOptions& asked) {
  Report report = new_report("devices", "Devices and their combinations", asked);
  BenchOptions options = asked;
  if (options.devices.empty()) options.devices = devices_of_environment();
  if (options.devices.empty()) options.devices = {"all"};
  const std::vector<DeviceInfo> devices = bench_devices(options);
  add_device_facts(report, devices);
  for (const std::string& file : options.scenes) {
    const auto on_step = [&](const std::string& step) { show_step(options, scene_name(file) + ", " + step); };
    add_device_tables(report, scene_name(file),
                      measure_devices(bench_scene(file, options), devices, options.repeat, on_step),
                      options.repeat);
  }
  report.notes.push_back(
      fmt::format("Median of {} frames after one to warm up; the combinations take turns, and building "
                  "kernels does not count. "
                  "A share is a part of the picture's pixels. A pixel differs if it is more than 0.02 "
                  "(linear color) from the "
                  "first device's; more than one pixel in 200 is a problem. Efficiency is the work completed "
                  "divided by the "
                  "devices' capacity.",
                  options.repeat));
  return publish(report, options);
}

}  // namespace

void add_bench_devices(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<BenchOptions>();
  Arguments* app =
      bench.add_subcommand("devices", "Rank devices and their combinations, with the share of each");
  add_bench_options(app, *options);
  add_bench_size(app, *options);
  app->callback(
      [options, &chosen] { chosen = RunLater{[options] { return bench_devices_command(*options); }}; });
}

}  // namespace sundog
