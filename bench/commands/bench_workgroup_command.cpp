// `sundog bench workgroup`: times each kernel on each device with every sensible work-group size.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/names.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/frame_runner.h"
#include "bench/frames/work_groups.h"
#include "bench/rays/ray_sets.h"
#include "bench/rays/ray_tracer.h"
#include "bench/report/machine.h"
#include "render/device/tuning.h"
#include "render/film/hash.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

/// The integrators' kernels, each of which means a frame by the scene's own integrator, and the tracer's.
std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const Integrator& integrator : integrators) names.emplace_back(integrator.kernel);
  names.insert(names.end(), {"trace_rays", "occluded_rays"});
  return names;
}

bool is_frame(const std::string& kernel) {
  return std::ranges::find(integrators, kernel, &Integrator::kernel) != integrators.end();
}
const char* integrator_kernel(const CompiledScene& scene) {
  return find_integrator(scene.integrator)->kernel;
}

struct WorkgroupOptions : BenchOptions {
  std::vector<std::string> kernels;
  std::string sizes;
  unsigned rays = 512;
  double budget = 0;  // seconds; 0: no limit
};

using Times = std::map<std::string, KernelTimes>;

/// The work-group of the kernel's last launch.
std::pair<std::size_t, std::size_t> local_of(const Times& kernels, const std::string& name) {
  const auto found = kernels.find(name);
  if (found == kernels.end()) return {};
  return {found->second.local_x, found->second.local_y};
}

/// TimedKernel::beyond_events for all launches since the device's times were reset.
std::optional<double> beyond_events(const Times& kernels) {
  double seconds = 0;
  for (const auto& [name, times] : kernels) {
    if (times.device_ms <= 0) return {};
    seconds += 1e-3 * (times.host_ms - times.device_ms);
  }
  return seconds;
}

/// Prepares timing of whole frames, as `sundog render` makes them.
void time_frames(TimedKernel& kernel, const DeviceInfo& device, const CompiledScene& scene) {
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
  kernel.local = [frames, tracer = integrator_kernel(scene)] {
    return local_of(frames->kernel_times(), tracer);
  };
  kernel.result = [frames] { return hash_of(frames->image().data); };
}

/// Prepares timing of the tracer alone, on the camera's rays.
void time_rays(TimedKernel& kernel, const DeviceInfo& info, const CompiledScene& scene, bool any,
               unsigned size) {
  const Stopwatch clock;
  const auto setup = std::make_shared<OpenedTracer>(info, scene);
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
  kernel.local = [setup, name = kernel.name] { return local_of(setup->device.times(), name); };
  kernel.result = [setup, any] {
    return any ? hash_of(setup->tracer.occluded()) : hash_of(setup->tracer.hits());
  };
}

/// Parses "4,8x8,driver".
std::vector<WorkGroup> parse_sizes(const std::string& text) {
  std::vector<WorkGroup> sizes;
  for (const std::string& name : split_names(text)) sizes.push_back(parse_work_group(name, "--sizes"));
  std::erase_if(sizes, [](const WorkGroup& group) { return group.kind == WorkGroup::Kind::automatic; });
  return sizes;
}

/// The kernels to time; both names of the frame count as one.
std::vector<std::string> timed_kernels(const std::vector<std::string>& wanted) {
  if (wanted.empty()) return {frame_kernel, "trace_rays", "occluded_rays"};
  const std::vector<std::string> known = kernel_names();
  std::vector<std::string> kernels;
  for (const std::string& name : wanted) {
    if (std::ranges::count(known, name) == 0)
      throw UsageError(fmt::format(
          "--kernel {}: {}", name,
          did_you_mean(name, known, fmt::format("wanted one of {}", fmt::join(known, ", ")), "")));
    const auto is_same = [&](const std::string& other) {
      return other == name || (is_frame(other) && is_frame(name));
    };
    if (std::ranges::none_of(kernels, is_same)) kernels.push_back(name);
  }
  return kernels;
}

int bench_workgroup(const WorkgroupOptions& options) {
  const std::vector<std::string> kernels = timed_kernels(options.kernels);
  TimedKernel head;
  head.sizes = parse_sizes(options.sizes);
  BenchRun run("workgroup", "Times by work-group size", options);
  run.head().notes = {
      fmt::format(
          "Medians of runs after one to warm up, all sizes in shuffled turn. render_* is a whole frame with "
          "its transfers, the others are {}x{} camera rays through the tracer alone. Each result was "
          "compared "
          "with the default's to the bit before its time counted.",
          options.rays, options.rays),
      "The size with the smallest median was run again in turn with the default. It is called best only if "
      "the interval of the median of its ratios to the default, run by run, lies below 1.",
      "`compiled at first launch`: how much longer the first launch took from the host's clock than the "
      "kernel ran by the device's events, less the same of a later launch. An empty cell: the driver gives "
      "no times."};
  std::vector<DeviceInfo> devices = run.devices();
  std::ranges::copy(unusable_bench_devices(options), std::back_inserter(devices));
  const double parts = static_cast<double>(options.scenes.size() * devices.size() * kernels.size());
  for (const std::string& file : options.scenes) {
    const auto scene = run.compiled(file);
    for (const DeviceInfo& device : devices)
      for (const std::string& name : kernels) {
        head.scene = scene_name(options, file);
        head.device = device_title(device);
        head.devices = {device};
        head.name = is_frame(name) ? integrator_kernel(*scene) : name;
        const auto open = [=, rays = options.rays] {
          TimedKernel kernel = head;
          if (is_frame(name))
            time_frames(kernel, device, *scene);
          else
            time_rays(kernel, device, *scene, name == "occluded_rays", rays);
          return kernel;
        };
        run.measure(std::make_shared<WorkGroupTimes>(head, open), options.budget / parts);
      }
  }
  return run.publish();
}

}  // namespace

void add_bench_workgroup(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<WorkgroupOptions>();
  Arguments* app = add_bench_command(bench, chosen, "workgroup", "Times of each kernel by work-group size",
                                     options, bench_workgroup);
  add_bench_size(app, *options);
  values(app, "--kernel", "NAME", options->kernels,
         fmt::format("one of {}; render_* are the frame (default: all)", fmt::join(kernel_names(), ", ")));
  value(app, "--sizes", "N,WxH...", options->sizes,
        "work-groups to compare with the default (default: all that make sense)");
  value(app, "--budget", "SECONDS", options->budget,
        "about how long it may take: then further runs, and sizes, are left out (default: no limit)")
      ->range(0, 1e6);
  value(app, "--rays", "N", options->rays, "camera rays a side for the tracer's kernels (default 512)")
      ->range(16, 16384);
}

}  // namespace sundog
