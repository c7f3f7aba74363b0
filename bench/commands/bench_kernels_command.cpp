// `sundog bench kernels`: registers, memory and build times of the kernels that a scene needs, on each
// device.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/environment.h"
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
  PtxasFigures compiler;  // from the build log, if the driver gives it
};

/// Builds of a program. Each is of another text, by a definition that no kernel reads, so that no cache, not
/// even a driver's within the process, has it.
class ProgramBuilds {
 public:
  ProgramBuilds(const DeviceInfo& info, SceneProgram program) : info_(info), program_(std::move(program)) {}

  /// Builds the program from source, then loads it from the cache on the reopened device; on NVIDIA devices
  /// with -cl-nv-verbose. Returns the seconds to build and to store it. Throws DeviceError, BuildError.
  double run() {
    Device device(with_cache(info_, true)), again(with_cache(info_, false));
    const BuildWish wish{device.nvidia() ? "-cl-nv-verbose" : "", true};
    BuildReport report, loaded;
    KernelDefines defines = program_.defines;
    defines["BUILD_NUMBER"] = std::to_string(warm_.size());
    device.build_with(wish);
    const Stopwatch building;
    const Program program = device.build(program_.entry, defines, &report, program_.generated);
    device.save_programs(true);
    const double seconds = building.seconds();
    again.build_with({wish.options});
    again.build(program_.entry, defines, &loaded, program_.generated);
    warm_.push_back(loaded.cached ? loaded.seconds : -1);
    auto compiler = read_ptxas_log(report.log);
    last_.clear();
    for (const std::string& name : program.kernel_names())
      last_.push_back({name, device.limits(program.kernel<>(name)), compiler[name]});
    return seconds;
  }
  std::string check() {
    if (kernels_.empty()) kernels_ = last_;
    const auto same = [](const KernelFigures& a, const KernelFigures& b) {
      return a.kernel == b.kernel && a.limits.private_bytes == b.limits.private_bytes &&
             a.compiler.registers == b.compiler.registers;
    };
    return std::ranges::equal(last_, kernels_, same) ? "" : "its kernels are not those of its first build";
  }
  const std::string& entry() const { return program_.entry; }
  bool is(const SceneProgram& program) const { return program_ == program; }
  const std::vector<KernelFigures>& kernels() const { return kernels_; }
  /// Milliseconds to load it from sundog's cache, in the builds that count; empty without a cache.
  Cell warm(const MeasuredWay& way) const {
    const Spread seconds = spread(way.counted(warm_));
    return way.is_good() && seconds.min > 0 ? Cell(scaled(seconds, 1e3)) : Cell();
  }

 private:
  /// The device with a cache of the bench's own. `logs`: with SUNDOG_BUILD_LOG, which bypasses it.
  static DeviceInfo with_cache(DeviceInfo info, bool logs) {
    HostEnvironment environment = value_of(info.environment);
    const auto folder = kept_for_next().parent_path();
    environment.cache = folder.empty() ? folder : folder / "cache";
    if (!logs) environment.build_log.clear();
    info.environment = std::make_shared<const HostEnvironment>(std::move(environment));
    return info;
  }

  DeviceInfo info_;
  SceneProgram program_;
  std::vector<double> warm_;                   // of each build; below 0: it was not in the cache
  std::vector<KernelFigures> kernels_, last_;  // of the first build, and of the last
};

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

/// `room`: the largest work-group by the room on a processor's stack; 0: no limit.
std::vector<Field> fields_of(const KernelFigures& figures, const std::optional<NvidiaLimits>& nvidia,
                             std::size_t room) {
  const KernelLimits& limits = figures.limits;
  const PtxasFigures& compiler = figures.compiler;
  Cell threads, occupancy;
  if (nvidia && compiler.registers) {
    const double resident = resident_threads(*compiler.registers, *nvidia);
    threads = resident;
    occupancy = 100.0 * resident / nvidia->threads();
  }
  return {{"group given", "", told(room > 0 ? std::min(room, limits.work_group) : limits.work_group)},
          {"group limit", "", told(limits.work_group)},
          {"multiple", "", told(limits.preferred_multiple)},
          {"private", "B", static_cast<double>(limits.private_bytes)},
          {"local", "B", static_cast<double>(limits.local_bytes)},
          {"registers", "", told(compiler.registers)},
          {"stack", "B", told(compiler.stack)},
          {"spill stores", "B", told(compiler.spill_stores)},
          {"spill loads", "B", told(compiler.spill_loads)},
          {"threads", "", threads},
          {"occupancy", "%", occupancy}};
}

struct BuiltScene {
  std::string name;
  std::shared_ptr<const CompiledScene> scene;
};

/// Builds the programs of scenes on one device: those of frames, with and without AOVs, and of `bench rays`
/// if there is anything to trace. Scenes share equal programs.
class KernelBuilds {
 public:
  KernelBuilds(const DeviceInfo& info, std::vector<BuiltScene> scenes)
      : info_(info), scenes_(std::move(scenes)) {}

  void measure(const MeasureOptions& options) {
    subjects_.resize(1);
    subjects_.front().name = "kernels on " + device_title(info_);
    if (!prepared(subjects_, options, [&] { nvidia_ = Device(info_).nvidia(); })) return;
    subjects_.clear();
    for (const BuiltScene& scene : scenes_)
      for (const SceneProgram& program : scene_programs(*scene.scene, info_)) add(scene, program);
    sundog::measure(subjects_, options);
  }

  void add_to(Report& report) const {
    const Field device{"device", "", device_title(info_)};
    if (subjects_.empty()) return;
    if (programs_.empty()) {
      Table table{subjects_.front().name, {}, {}};
      add_row(table, {device}, subjects_.front());
      report.parts.emplace_back(std::move(table));
      return add_measured(report, subjects_.front(), {device});
    }
    for (const BuiltScene& scene : scenes_) add_scene(report, scene, device);
    report.ways.insert(report.ways.end(), subjects_.begin(), subjects_.end());
    if (const auto& limits = nvidia_)
      report.notes.push_back(fmt::format(
          "{}: `threads` is how many threads a multiprocessor can hold if only the kernel's registers limit "
          "them: {} registers, a quarter for each of four schedulers, allocated to warps of {} in steps of "
          "256; at most {} threads at compute capability {}.{}. `occupancy` is the share of that maximum.",
          info_.label(), limits->registers, limits->warp, limits->threads(), limits->major, limits->minor));
  }

 private:
  void add(const BuiltScene& scene, const SceneProgram& program) {
    const auto known = std::ranges::find_if(programs_, [&](const auto& each) { return each->is(program); });
    uses_.emplace_back(&scene, known - programs_.begin());
    if (known != programs_.end()) return;
    const auto& builds = programs_.emplace_back(std::make_shared<ProgramBuilds>(info_, program));
    Subject& subject = subjects_.emplace_back();
    subject.name = fmt::format("{} on {}, {}", scene.name, device_title(info_), program.entry);
    subject.cold = true;
    subject.devices = {info_};
    subject.run = [builds] { return builds->run(); };
    subject.check = [builds] { return builds->check(); };
  }

  void add_scene(Report& report, const BuiltScene& scene, const Field& device) const {
    const char* tracer = traces_compact(*scene.scene, info_) ? "compact" : "wide";
    const std::size_t room = greatest_work_group(make_kernel_config(*scene.scene, info_), info_);
    Table table{fmt::format("{} on {}, {} tracer", scene.name, device.cell.word, tracer), {}, {}};
    for (const auto& [user, index] : uses_) {
      if (user != &scene) continue;
      const ProgramBuilds& builds = *programs_[static_cast<std::size_t>(index)];
      const Subject& way = subjects_[static_cast<std::size_t>(index)];
      const auto add_kernel = [&](const std::string& name, const std::vector<Field>& figures) {
        const Field kernel{"kernel", "", name}, warm{"build warm", "ms", builds.warm(way)};
        std::vector<Field> shown{kernel}, results = measured_fields(way);
        shown.insert(shown.end(), figures.begin(), figures.end());
        shown.insert(shown.end(), {{"build cold", "ms", milliseconds(way)}, warm});
        add_row(table, shown, way);
        results.insert(results.end(), figures.begin(), figures.end());
        results.push_back(warm);
        add_result(report, {{"scene", "", scene.name}, device, {"tracer", "", tracer}, kernel}, results);
      };
      if (builds.kernels().empty()) add_kernel(builds.entry(), {});
      for (const KernelFigures& kernel : builds.kernels())
        add_kernel(kernel.kernel, fields_of(kernel, nvidia_, room));
    }
    report.parts.emplace_back(std::move(table));
  }

  DeviceInfo info_;
  std::vector<BuiltScene> scenes_;
  std::optional<NvidiaLimits> nvidia_;
  std::vector<std::shared_ptr<ProgramBuilds>> programs_;
  std::vector<Subject> subjects_;                                   // of each program
  std::vector<std::pair<const BuiltScene*, std::ptrdiff_t>> uses_;  // scenes, and their programs' numbers
};

int bench_kernels(const BenchOptions& options) {
  bypass_driver_caches();
  set_variable("MESA_SHADER_CACHE_DISABLE", "true");  // Mesa then compiles at launches: none here
  set_variable("POCL_CACHE_DIR", "", true);           // PoCL's cache of earlier processes
  BenchRun run("kernels", "Resources of the compiled kernels", options);
  std::vector<DeviceInfo> devices = run.devices();
  std::ranges::copy(unusable_bench_devices(options), std::back_inserter(devices));
  std::vector<BuiltScene> scenes;
  for (const std::string& file : options.scenes)
    scenes.push_back({scene_name(options, file), run.compiled(file)});
  run.head().notes.emplace_back(
      "`group given` is the largest work-group that sundog uses. `group limit`, `multiple`, `private` (for a "
      "work-item) and `local` (for a group) come from the driver. Registers, stack and spills come from the "
      "build log of NVIDIA's compiler; other drivers do not report them. `build cold` is from the source, "
      "without the caches of sundog and of drivers, until the program is in a cache; `build warm` loads it "
      "from there. Kernels of one program are built together. An empty cell: not known.");
  for (const DeviceInfo& info : devices) run.measure(std::make_shared<KernelBuilds>(info, scenes));
  return run.publish();
}

}  // namespace

void add_bench_kernels(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<BenchOptions>();
  options->repeat = 1;  // a build takes long, and needs no warm-up
  add_bench_command(bench, chosen, "kernels",
                    "Work-group limits, memory and registers of each kernel of a scene", options,
                    bench_kernels);
}

}  // namespace sundog
