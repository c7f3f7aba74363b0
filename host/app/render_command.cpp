// `sundog render`: scene file -> description -> flat tables -> image -> file.
#include <fmt/format.h>

#include <filesystem>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/stats.h"
#include "app/warnings.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/image_io.h"
#include "scene/json/override.h"
#include "scene/load.h"

namespace sundog {
namespace {

/// Runs `step` and adds the seconds it takes.
template <class Step>
auto timed(double& seconds, const Step& step) {
  const Stopwatch clock;
  auto result = step();
  seconds += clock.seconds();
  return result;
}

/// What would otherwise be found out after the render.
bool drops_alpha(const std::filesystem::path& path) {
  return path.extension() != ".exr" && path.extension() != ".EXR";
}

void check_outputs(const RenderCommand& command) {
  check_image_path(command.out, !command.aovs.empty());
  if (command.full_floats && drops_alpha(command.out))
    throw UsageError(fmt::format("{}: --float is for .exr files", command.out));
  check_writable(command.out);
  for (const std::string& file : {command.stats, command.resume})
    if (!file.empty()) check_writable(file);
}

/// An error at a place that an option changed is the command line's.
SceneDescription load(const RenderCommand& command) {
  try {
    return load_scene(command.scene, command.overrides);
  } catch (const SceneError& error) {
    if (error.file == command.scene)
      for (const std::string& setting : command.overrides)
        if (concerns(setting, error.place)) throw UsageError(error.what());
    throw;
  }
}

RenderOptions render_options(const RenderCommand& command) {
  RenderOptions options;
  options.work_group = command.work_group;
  options.split = command.split;
  options.tile = command.tile;
  options.aovs = command.aovs;
  options.resume = command.resume;
  return options;
}

/// Coverage is kept where programs expect it; a PNG with it would show the background as holes.
Image without_alpha(const Image& image) {
  Image opaque(image.width, image.height, 3);
  for (std::size_t i = 0; i < opaque.data.size(); ++i) opaque.data[i] = image.data[i / 3 * 4 + i % 3];
  return opaque;
}

double write(const RenderCommand& command, const RenderResult& result) {
  const Stopwatch clock;
  const Image& image = result.image;
  write_image(drops_alpha(command.out) ? without_alpha(image) : image, command.out, result.aovs,
              command.full_floats ? ExrColor::full : ExrColor::half);
  return clock.seconds();
}

void warn(const RenderResult& result) {
  print_warnings(losses(result.counts));
  for (const DeviceReport& report : result.devices) print_warnings(failures_text(report));
}

void summarise(const RenderCommand& command, const RenderResult& result, const TimeLedger& times) {
  if (command.quiet) return;
  const double rays = static_cast<double>(ray_count(result.counts));
  const double seconds = times.render.render + times.render.readback;
  fmt::print("{}: {}x{}, {:.4g} Mrays in {:.2f} s ({:.3g} Mrays/s), {:.2f} s in all\n", command.out,
             result.image.width, result.image.height, rays / 1e6, seconds,
             seconds > 0 ? rays / 1e6 / seconds : 0, times.total);
  if (command.verbose) fmt::print("{}", details_text(result, times));
}

int report_interrupt(const RenderCommand& command, const RenderProgress& progress) {
  const double percent = progress.pixels_total == 0 ? 0
                                                    : 100 * static_cast<double>(progress.pixels_done) /
                                                          static_cast<double>(progress.pixels_total);
  fmt::print(stderr, "sundog: interrupted: {:.3g} % of the pixels are in {}{}\n", percent, command.out,
             command.resume.empty() ? "" : "; the same command goes on from there");
  return exit_interrupted;
}

}  // namespace

int render_command(const RenderCommand& command) {
  const Stopwatch clock;
  check_outputs(command);
  const StopOnSignal stop;
  TimeLedger times;
  const SceneDescription scene = timed(times.load, [&] { return load(command); });
  print_warnings(scene.warnings);
  const auto flat =
      timed(times.compile_scene, [&] { return std::make_shared<const CompiledScene>(compile(scene)); });
  const std::vector<DeviceInfo> devices = select_devices(enumerate_devices(), command.devices);

  ProgressBar bar(!command.quiet);
  RenderProgress progress;
  RenderOptions options = render_options(command);
  options.stop = &stop.flag();
  options.on_progress = [&](const RenderProgress& now) { bar.update(progress = now); };
  const RenderResult result = render(flat, devices, options);
  bar.erase();

  times.render = result.times;
  times.write = write(command, result);
  if (result.complete && !command.resume.empty())
    std::filesystem::remove(command.resume);  // not before the image is safe
  times.total = clock.seconds();
  if (!command.stats.empty()) {
    using nlohmann::json;
    const json stats = stats_json(command, scene, *flat, result, times);
    write_file(command.stats, stats.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
  }
  warn(result);
  summarise(command, result, times);
  return result.complete ? exit_done : report_interrupt(command, progress);
}

}  // namespace sundog
