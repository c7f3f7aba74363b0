// `sundog bench roofline`: what a device can do at most, and where the tracer's kernels lie below that.
#include <memory>

#include "app/options/option_helpers.h"
#include "bench/commands/bench_run.h"
#include "bench/roofline/roofline.h"

namespace sundog {
namespace {

struct RooflineOptions : BenchOptions {
  int rays = 256, megabytes = 256;
};

int bench_roofline(const RooflineOptions& options) {
  BenchRun run("roofline", "What devices can do at most", options);
  run.head().notes.emplace_back(
      "Reads sum up, copies add a number; both directions count. `read cache` reads 128 KiB again and again. "
      "Operations are multiply-adds, two each, in one chain where each waits for the one before it, and in "
      "eight that do not wait for each other. Each result is compared before its time counts. A launch is "
      "one work-item's, awaited; `queued` is the part until the device's clock says that it started.");
  run.head().notes.emplace_back(
      "The work of a ray is what it needs alone in the scene's tree, near children first, counted by the "
      "host: an fma is two operations; comparisons, whole numbers, and the equations of solids are not "
      "counted. `asked for` are the bytes it reads and writes, from a cache or memory; `at least` is its "
      "share where each node, block and instance comes from memory once. A packet reads a node once for "
      "sixteen rays, so its traffic may lie above the roof.");
  std::vector<NamedScene> scenes;
  for (const std::string& file : options.scenes)
    if (const auto scene = run.compiled(file); scene->info.instance_count > 0)
      scenes.push_back({scene_name(file), scene});
    else
      run.head().notes.push_back(file + ": left out: it has nothing that is traced, only marched fields");
  const std::vector<DeviceInfo> devices = run.devices();
  for (const DeviceInfo& device : devices)
    run.measure(std::make_shared<Roofline>(device, static_cast<unsigned>(options.megabytes), scenes,
                                           static_cast<unsigned>(options.rays)));
  return run.publish(true);
}

}  // namespace

void add_bench_roofline(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<RooflineOptions>();
  Arguments* app =
      add_bench_command(bench, chosen, "roofline", "Bandwidth, operations a second and launches of a device",
                        options, bench_roofline, false);
  value(app, "--megabytes", "N", options->megabytes, "of the buffers that no cache should hold (default 256)")
      ->range(1, 16384);
  value(app, "--rays", "N", options->rays, "camera rays a side (default 256)")->range(1, 16384);
}

}  // namespace sundog
