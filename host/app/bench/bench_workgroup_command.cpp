// `sundog bench workgroup`: each kernel and device with every sensible local size.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>

#include "app/bench/bench_options.h"
#include "app/bench/bench_progress.h"
#include "app/options/option_helpers.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/names.h"
#include "bench/frames/frame_runner.h"
#include "bench/frames/work_groups.h"
#include "bench/rays/ray_sets.h"
#include "bench/rays/ray_tracer.h"
#include "render/film/hash.h"

namespace sundog {
namespace {

constexpr std::array kernel_names{"render_whitted", "trace_rays", "occluded_rays"};

struct WorkgroupOptions : BenchOptions {
  std::vector<std::string> kernels;
  unsigned rays = 512;
};

template <class T>
std::uint64_t hash_of(const std::vector<T>& values) {
  return hash_bytes(values.data(), values.size() * sizeof(T));
}

/// Of the launches since the device's times were forgotten (TimedKernel::beyond_events).
std::optional<double> beyond_events(const std::map<std::string, KernelTimes>& kernels) {
  double seconds = 0;
  for (const auto& [name, times] : kernels) {
    if (times.device_ms <= 0) return {};
    seconds += 1e-3 * (times.host_ms - times.device_ms);
  }
  return seconds;
}

/// Whole frames, as `sundog render` would make them.
TimedKernel time_frames(const DeviceInfo& device, const CompiledScene& scene) {
  TimedKernel kernel;
  kernel.two_dimensions = true;
  const auto frames = std::make_shared<FrameRunner>(device, scene);
  kernel.limit = frames->greatest_group();
  kernel.build_seconds = frames->times().build_kernels;
  kernel.cached = frames->times().cached;
  kernel.run = [frames](const WorkGroup& group) {
    frames->use(group);
    return frames->run();
  };
  kernel.beyond_events = [frames] { return beyond_events(frames->kernel_times()); };
  kernel.result = [frames] { return hash_of(frames->image().data); };
  return kernel;
}

/// The camera's rays through the tracer alone.
TimedKernel time_rays(const DeviceInfo& info, const CompiledScene& scene, bool any, unsigned size) {
  struct Setup {
    Device device;
    RayTracer tracer;
    Setup(const DeviceInfo& info_, const CompiledScene& scene_) : device(info_), tracer(device, scene_) {}
  };
  TimedKernel kernel;
  const Stopwatch clock;
  const auto setup = std::make_shared<Setup>(info, scene);
  kernel.build_seconds = clock.seconds();
  kernel.limit = setup->tracer.greatest_group(any);
  setup->tracer.upload(primary_rays(scene_viewpoint(scene), size).rays);
  kernel.run = [setup, any](const WorkGroup& group) {
    setup->device.forget_times();
    const Stopwatch running;
    setup->tracer.run({any, true}, group);
    return running.seconds();
  };
  kernel.beyond_events = [setup] { return beyond_events(setup->device.times()); };
  kernel.result = [setup, any] {
    return any ? hash_of(setup->tracer.occluded()) : hash_of(setup->tracer.hits());
  };
  return kernel;
}

TimedKernel prepare(const std::string& name, const DeviceInfo& device, const CompiledScene& scene,
                    unsigned rays) {
  TimedKernel kernel = name == "render_whitted" ? time_frames(device, scene)
                                                : time_rays(device, scene, name == "occluded_rays", rays);
  kernel.name = name;
  kernel.device = fmt::format("{}:{}{}", device.platform, device.device,
                              device.sub_units ? fmt::format("/{}", device.sub_units) : "");
  return kernel;
}

void add_kernel(Report& report, const WorkgroupOptions& options, const std::string& file,
                const std::string& name, const DeviceInfo& device, const CompiledScene& scene) {
  const std::string step = fmt::format("{}, {} on {}", scene_name(file), name, device.label());
  show_step(options, step);
  TimedKernel kernel = prepare(name, device, scene, options.rays);
  kernel.scene = scene_name(file);
  BenchProgress progress(!options.quiet, 0);
  const auto on_run = [&](std::size_t done, std::size_t of) {
    progress.update(step, static_cast<double>(done) / static_cast<double>(of));
  };
  add_work_group_tables(report, kernel, measure_work_groups(kernel, options.repeat, on_run));
  const char* origin = !kernel.cached   ? "built or loaded from the cache"
                       : *kernel.cached ? "loaded from the cache"
                                        : "built";
  report.notes.push_back(fmt::format("{}, {} on {}: the program was {} in {} ms, before any run.",
                                     kernel.scene, name, kernel.device, origin,
                                     number_text(1e3 * kernel.build_seconds)));
}

int bench_workgroup(const WorkgroupOptions& options) {
  Report report = new_report("workgroup", "Times by work-group size", options);
  const std::vector<DeviceInfo> devices = bench_devices(options);
  add_device_facts(report, devices);
  for (const std::string& file : options.scenes) {
    const CompiledScene scene = bench_scene(file, options);
    for (const DeviceInfo& device : devices)
      for (const std::string& name : options.kernels) add_kernel(report, options, file, name, device, scene);
  }
  report.notes.push_back(
      fmt::format("Median of {} runs after one to warm up, all sizes in shuffled turn. render_whitted is a "
                  "whole frame with "
                  "its transfers, the others are {}x{} camera rays through the tracer alone. Each result was "
                  "compared with "
                  "the default's to the bit before its time counted.",
                  options.repeat, options.rays, options.rays));
  report.notes.push_back(
      "The size with the smallest median was run again in turn with the default. It is called best only if "
      "each "
      "of these runs was faster than each of the default's.");
  report.notes.push_back(
      "`compiled at first launch`: how much longer the first launch took from the host's clock than the "
      "kernel "
      "ran by the device's events, less the same of a later launch. An empty cell: the driver gives no "
      "times.");
  return publish(report, options);
}

}  // namespace

void add_bench_workgroup(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<WorkgroupOptions>();
  Arguments* app = bench.add_subcommand("workgroup", "Times of each kernel by work-group size");
  add_bench_options(app, *options);
  values(app, "--kernel", "NAME", options->kernels,
         fmt::format("one of {} (default: all)", fmt::join(kernel_names, ", ")));
  app->add_option("--rays", options->rays, "camera rays a side for the tracer's kernels (default 512)")
      ->type_name("N")
      ->range(16, 16384);
  app->callback([options, &chosen] {
    for (const std::string& name : options->kernels)
      if (std::ranges::count(kernel_names, name) == 0)
        throw UsageError(
            fmt::format("--kernel {}: {}", name,
                        did_you_mean(name, {kernel_names.begin(), kernel_names.end()},
                                     fmt::format("wanted one of {}", fmt::join(kernel_names, ", ")), "")));
    if (options->kernels.empty()) options->kernels.assign(kernel_names.begin(), kernel_names.end());
    chosen = RunLater{[options] { return bench_workgroup(*options); }};
  });
}

}  // namespace sundog
