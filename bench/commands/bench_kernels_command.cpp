// `sundog bench kernels`: registers, memory and build times of the kernels that a scene needs, on each
// device.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/process/exit_status.h"
#include "base/clock.h"
#include "base/environment.h"
#include "base/error.h"
#include "bench/commands/bench_run.h"
#include "bench/report/machine.h"
#include "compile/compiled_scene.h"
#include "device/device.h"
#include "render/device/kernel_config.h"
#include "render/device/scene_programs.h"

namespace sundog {
namespace {

struct KernelFigures {
  std::string kernel;
  KernelLimits limits;
  std::size_t greatest_group =
      0;                  // that sundog uses: by the kernel's limit, and by the room on a processor's stack
  PtxasFigures compiler;  // from the build log, if the driver gives it
  std::optional<unsigned> resident_threads;  // per multiprocessor, by registers alone; NVIDIA only
  double cold_seconds = 0;             // to build its program from source and to store it in sundog's cache
  std::optional<double> warm_seconds;  // to load it from there; nothing without a cache
};

/// The device without SUNDOG_BUILD_LOG, which keeps it from reading sundog's cache.
DeviceInfo with_cache(DeviceInfo info) {
  HostEnvironment environment = value_of(info.environment);
  environment.build_log.clear();
  info.environment = std::make_shared<const HostEnvironment>(std::move(environment));
  return info;
}

/// Builds a program from source, then loads it from the cache on the reopened device; on NVIDIA devices with
/// -cl-nv-verbose. Throws DeviceError, BuildError.
std::vector<KernelFigures> kernel_figures(const DeviceInfo& info, const SceneProgram& source) {
  Device device(info), again(with_cache(info));
  const auto nvidia = device.nvidia();
  const BuildWish wish{nvidia ? "-cl-nv-verbose" : "", true};
  BuildReport report, loaded;
  device.build_with(wish);
  const Stopwatch building;
  const Program program = device.build(source.entry, source.defines, &report, source.generated);
  device.save_programs(true);
  const double cold_seconds = building.seconds();
  again.build_with({wish.options});
  again.build(source.entry, source.defines, &loaded, source.generated);
  auto compiler = read_ptxas_log(report.log);
  std::vector<KernelFigures> result;
  for (const std::string& name : program.kernel_names()) {
    KernelFigures& figures = result.emplace_back();
    figures.kernel = name;
    figures.limits = device.limits(program.kernel<>(name));
    figures.compiler = compiler[name];
    if (nvidia && figures.compiler.registers)
      figures.resident_threads = resident_threads(*figures.compiler.registers, *nvidia);
    figures.cold_seconds = cold_seconds;
    if (loaded.cached) figures.warm_seconds = loaded.seconds;
  }
  return result;
}

/// Figures of each device's programs, because a second build would find the program in the driver's cache.
using KnownFigures = std::map<std::pair<std::string, SceneProgram>, std::vector<KernelFigures>>;

/// An empty cell if the value is unknown, as 0 would be a figure.
template <class T>
Cell told(const std::optional<T>& value) {
  return value ? Cell(static_cast<double>(*value)) : Cell();
}
/// An empty cell for 0, which means unknown.
template <class T>
Cell told(T value) {
  return value > 0 ? Cell(static_cast<double>(value)) : Cell();
}

std::vector<Cell> row(const KernelFigures& figures, const std::optional<NvidiaLimits>& nvidia) {
  const KernelLimits& limits = figures.limits;
  Cell occupancy;
  if (nvidia && figures.resident_threads)
    occupancy = 100.0 * static_cast<double>(*figures.resident_threads) / nvidia->threads();
  return {figures.kernel,
          told(figures.greatest_group),
          told(limits.work_group),
          told(limits.preferred_multiple),
          static_cast<double>(limits.private_bytes),
          static_cast<double>(limits.local_bytes),
          told(figures.compiler.registers),
          told(figures.compiler.stack),
          told(figures.compiler.spill_stores),
          told(figures.compiler.spill_loads),
          told(figures.resident_threads),
          occupancy,
          told(figures.cold_seconds),
          told(figures.warm_seconds),
          Cell()};
}

const std::vector<Column> columns{
    {"kernel", ""},  {"group given", ""}, {"group limit", ""}, {"multiple", ""},      {"private", "B"},
    {"local", "B"},  {"registers", ""},   {"stack", "B"},      {"spill stores", "B"}, {"spill loads", "B"},
    {"threads", ""}, {"occupancy", "%"},  {"build cold", "s"}, {"build warm", "s"},   {"problem", ""}};

/// The row of a program, or of a device, that failed.
std::vector<Cell> problem_row(const std::string& program, const std::string& why) {
  std::vector<Cell> cells(columns.size());
  cells.front() = program;
  cells.back() = why;
  return cells;
}

/// Runs `work` in a row of the bench. Returns the error; "" if there was none.
std::string failure(const std::string& row, const std::function<void()>& work) {
  std::string why = enter_row(row);
  try {
    if (why.empty()) work();
  } catch (const DeviceError& error) {
    why = error.what();
  } catch (const BuildError& error) {
    why = error.what();
  }
  enter_row("");
  return why;
}

/// Adds the kernels of frames, with and without AOVs, and of `bench rays` if the scene has anything to trace.
void add_device(Report& report, const std::string& name, const CompiledScene& scene, const DeviceInfo& info,
                KnownFigures& known) {
  const std::string place = fmt::format("{} on {}", name, device_title(info));
  const char* tracer = traces_compact(scene, info) ? "compact" : "wide";
  Table table{fmt::format("{}, {} tracer", place, tracer), columns, {}};
  std::optional<NvidiaLimits> nvidia;
  const std::string closed = failure(place, [&] { nvidia = Device(info).nvidia(); });
  bool has_problem = !closed.empty();
  if (has_problem) table.rows.push_back(problem_row("", closed));
  const std::size_t room = greatest_work_group(make_kernel_config(scene, info), info);
  for (const SceneProgram& program :
       closed.empty() ? scene_programs(scene, info) : std::vector<SceneProgram>()) {
    std::vector<KernelFigures>& all_figures = known[{info.label(), program}];
    const std::string why = failure(fmt::format("{}, {}", place, program.entry), [&] {
      if (all_figures.empty()) all_figures = kernel_figures(info, program);
    });
    has_problem |= !why.empty();
    if (!why.empty()) table.rows.push_back(problem_row(program.entry, why));
    for (KernelFigures figures : all_figures) {
      figures.greatest_group =
          room > 0 ? std::min(room, figures.limits.work_group) : figures.limits.work_group;
      table.rows.push_back(row(figures, nvidia));
    }
  }
  for (const std::vector<Cell>& cells : table.rows) {
    std::vector<Cell> all{name, device_title(info), tracer};
    all.insert(all.end(), cells.begin(), cells.end());
    report.measurements.rows.push_back(std::move(all));
  }
  if (!has_problem) {
    table.columns.pop_back();
    for (std::vector<Cell>& cells : table.rows) cells.pop_back();
  }
  report.parts.emplace_back(std::move(table));
  if (const auto& limits = nvidia)
    report.notes.push_back(fmt::format(
        "{}: `threads` is how many threads a multiprocessor can hold if only the kernel's registers limit "
        "them: {} registers, a quarter for each of four schedulers, allocated to warps of {} in steps of "
        "256; at most {} threads at compute capability {}.{}. `occupancy` is the share of that maximum.",
        info.label(), limits->registers, limits->warp, limits->threads(), limits->major, limits->minor));
}

int bench_kernels(const BenchOptions& options) {
  bypass_driver_caches();
  set_variable("MESA_SHADER_CACHE_DISABLE", "true");  // Mesa then compiles at launches: none here
  set_variable("POCL_CACHE_DIR", "", true);           // PoCL's cache of earlier processes
  KnownFigures known;
  BenchRun run("kernels", "Resources of the compiled kernels", options);
  Report& report = run.head();
  report.measurements.columns = {{"scene", ""}, {"device", ""}, {"tracer", ""}};
  report.measurements.columns.insert(report.measurements.columns.end(), columns.begin(), columns.end());
  std::vector<DeviceInfo> devices = run.devices();
  std::ranges::copy(unusable_bench_devices(options), std::back_inserter(devices));
  for (const std::string& file : options.scenes) {
    const auto scene = run.compiled(file);
    for (const DeviceInfo& info : devices) {
      show_step(options, fmt::format("{} on {}", scene_name(options, file), info.label()));
      if (!run.is_stopped()) add_device(report, scene_name(options, file), *scene, info, known);
    }
  }
  report.notes.push_back(
      "`group given` is the largest work-group that sundog uses. `group limit`, `multiple`, `private` (for a "
      "work-item) and `local` (for a group) come from the driver. Registers, stack and spills come from the "
      "build log of NVIDIA's compiler; other drivers do not report them. `build cold` is from the source, "
      "without the caches of sundog and of drivers, until the program is in sundog's cache; `build warm` "
      "loads it from there. Kernels of one program are built together. An empty cell: not known.");
  const int status = run.publish();
  const bool any = std::ranges::any_of(known, [](const auto& program) { return !program.second.empty(); });
  return any || report.measurements.rows.empty() ? status : exit_device;
}

}  // namespace

void add_bench_kernels(Arguments& bench, Command& chosen) {
  add_bench_command(bench, chosen, "kernels",
                    "Work-group limits, memory and registers of each kernel of a scene",
                    std::make_shared<BenchOptions>(), bench_kernels);
}

}  // namespace sundog
