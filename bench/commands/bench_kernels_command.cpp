// `sundog bench kernels`: what each device's compiler made of the kernels that a scene needs.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

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
      0;                  // that sundog gives it: the kernel's limit, and room on a processor's stack
  PtxasFigures compiler;  // by the build log, where the driver tells
  std::optional<unsigned> resident_threads;  // on a multiprocessor, by its registers alone; NVIDIA's devices
};

/// Builds the kernels from their source: those of frames, with and without AOVs, and those of `bench rays`
/// where something is traced. On NVIDIA's devices with -cl-nv-verbose. Throws DeviceError, BuildError.
std::vector<KernelFigures> kernel_figures(Device& device, const CompiledScene& scene) {
  const auto nvidia = device.nvidia();
  device.build_with({nvidia ? "-cl-nv-verbose" : "", true});
  const KernelConfig config = make_kernel_config(scene, device.info());
  const std::size_t room = greatest_work_group(config, device.info());
  std::vector<KernelFigures> result;
  for (const auto& [entry, defines, generated] : scene_programs(scene, device.info())) {
    BuildReport report;
    const Program program = device.build(entry, defines, &report, generated);
    auto compiler = read_ptxas_log(report.log);
    for (const std::string& name : program.kernel_names()) {
      KernelFigures& figures = result.emplace_back();
      figures.kernel = name;
      figures.limits = device.limits(program.kernel<>(name));
      figures.greatest_group =
          room > 0 ? std::min(room, figures.limits.work_group) : figures.limits.work_group;
      figures.compiler = compiler[name];
      if (nvidia && figures.compiler.registers)
        figures.resident_threads = resident_threads(*figures.compiler.registers, *nvidia);
    }
  }
  return result;
}

/// Nothing where it is not known: 0 would be a figure.
template <class T>
Cell told(const std::optional<T>& value) {
  return value ? Cell(static_cast<double>(*value)) : Cell();
}
/// Nothing for 0, which stands for an unknown value.
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
          occupancy};
}

const std::vector<Column> columns{{"kernel", ""},       {"group given", ""}, {"group limit", ""},
                                  {"multiple", ""},     {"private", "B"},    {"local", "B"},
                                  {"registers", ""},    {"stack", "B"},      {"spill stores", "B"},
                                  {"spill loads", "B"}, {"threads", ""},     {"occupancy", "%"}};

void add_device(Report& report, const std::string& name, const CompiledScene& scene, const DeviceInfo& info) {
  Device device(info);
  const char* tracer = traces_compact(scene, info) ? "compact" : "wide";
  Table table{fmt::format("{} on {}, {} tracer", name, device_title(info), tracer), columns, {}};
  for (const KernelFigures& figures : kernel_figures(device, scene)) {
    table.rows.push_back(row(figures, device.nvidia()));
    std::vector<Cell> all{name, device_title(info), tracer};
    all.insert(all.end(), table.rows.back().begin(), table.rows.back().end());
    report.measurements.rows.push_back(std::move(all));
  }
  report.parts.emplace_back(std::move(table));
  if (const auto limits = device.nvidia())
    report.notes.push_back(fmt::format(
        "{}: `threads` is how many threads a multiprocessor can hold if only the kernel's registers limit "
        "them: {} registers, a quarter for each of four schedulers, allocated to warps of {} in steps of "
        "256; at most {} threads at compute capability {}.{}. `occupancy` is the share of that maximum.",
        info.label(), limits->registers, limits->warp, limits->threads(), limits->major, limits->minor));
}

int bench_kernels(const BenchOptions& options) {
  bypass_driver_caches();
  BenchRun run("kernels", "Resources of the compiled kernels", options);
  Report& report = run.head();
  report.measurements.columns = {{"scene", ""}, {"device", ""}, {"tracer", ""}};
  report.measurements.columns.insert(report.measurements.columns.end(), columns.begin(), columns.end());
  const std::vector<DeviceInfo> devices = run.devices();
  for (const std::string& file : options.scenes) {
    const auto scene = run.compiled(file);
    for (const DeviceInfo& info : devices) {
      show_step(options, fmt::format("{} on {}", scene_name(file), info.label()));
      if (!run.is_stopped()) add_device(report, scene_name(file), *scene, info);
    }
  }
  report.notes.push_back(
      "`group given` is the largest work-group that sundog uses. `group limit`, `multiple`, `private` (for a "
      "work-item) and `local` (for a group) come from the driver. Registers, stack and spills come from the "
      "build log of NVIDIA's compiler; other drivers do not report them. An empty cell: not known.");
  return run.publish();
}

}  // namespace

void add_bench_kernels(Arguments& bench, Command& chosen) {
  add_bench_command(bench, chosen, "kernels",
                    "Work-group limits, memory and registers of each kernel of a scene",
                    std::make_shared<BenchOptions>(), bench_kernels);
}

}  // namespace sundog
