// `sundog render`: scene file -> description -> flat tables -> image -> file.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/job/job.h"
#include "app/job/rank_watch.h"
#include "app/job/remote_devices.h"
#include "app/options/commands.h"
#include "app/options/frames.h"
#include "app/options/output_files.h"
#include "app/options/pick_devices.h"
#include "app/process/environment.h"
#include "app/process/exit_status.h"
#include "app/process/interrupt.h"
#include "app/process/progress.h"
#include "app/process/save_image.h"
#include "app/process/standard_streams.h"
#include "app/process/trace_halo_map.h"
#include "app/process/warnings.h"
#include "app/render/denoise.h"
#include "app/render/metadata.h"
#include "app/render/render_result.h"
#include "app/render/stats.h"
#include "base/cache_folder.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "render/device/tuning.h"
#include "render/device/view_warnings.h"
#include "render/film/hash.h"
#include "render/plan/passes.h"
#include "render/session/render_session.h"
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

/// What is written again and again needs a file's name.
void check_write_every(const RenderCommand& command) {
  if (command.write_every > 0 &&
      (command.part || is_standard_stream(command.out) || is_pipe_or_device(command.out)))
    throw UsageError(fmt::format("-o {}: --write-every wants an image file", command.out));
}

/// What is done to a whole picture, and words in its file.
void check_extras(const RenderCommand& command) {
  if (command.part && (command.denoise || command.metadata))
    throw UsageError(
        fmt::format("{}: a part of a frame is neither denoised nor described: leave --denoise, --metadata or "
                    "--tiles out",
                    command.out));
  for (const std::string& name : command.aovs)
    if (command.part && (name.starts_with("crypto_") || name == "samples" || name == "variance"))
      throw UsageError(fmt::format("--aov {}: wants a whole frame: leave --tiles out", name));
  if (command.metadata && !keeps_texts(format_name(command)))
    throw UsageError(fmt::format("{}: --metadata is for .png and .exr files", command.out));
  if (command.metadata) static_cast<void>(time_of_picture());
  if (command.denoise) static_cast<void>(Denoiser());
}

/// The files that one frame may write.
std::vector<std::string> output_files(const RenderCommand& command) {
  std::vector<std::string> files = {command.out, command.stats, command.resume};
  if (command.verbose && !is_standard_stream(command.out)) files.push_back(samples_file(command));
  if (job_rank() >= 0 && command.resume.empty()) files.push_back(command.out + ".checkpoint");
  if (command.frames && !command.resume.empty()) files.push_back(command.resume + ".frames");
  return files;
}

/// What would otherwise be found out after the render.
void check_outputs(const RenderCommand& command) {
  if (command.part && !command.out.ends_with(".part"))
    throw UsageError(
        fmt::format("{}: with --tiles, OUT is a part of the frame and ends in .part", command.out));
  if (job_rank() >= 0 && is_standard_stream(command.out))
    throw UsageError("-o -: under mpirun, whose standard output is for text, a picture wants a file");
  if (is_standard_stream(command.resume)) throw UsageError("--resume -: a checkpoint wants a file");
  check_output_files(output_files(command), {command.scene});
  check_write_every(command);
  check_extras(command);
  if (command.part)
    check_writable(command.out);
  else
    check_picture(command, !command.aovs.empty());
  for (const std::string& file : {command.stats, command.resume})
    if (!file.empty() && !is_standard_stream(file)) check_writable(file);
}

/// Frames are files of their own.
void check_frames(const RenderCommand& command) {
  for (const std::string& file : {command.out, command.stats})
    if (command.frames && is_standard_stream(file))
      throw UsageError("--frames writes numbered files: wanted a name for them, found -");
}

/// An error at a place that an option changed is the command line's.
SceneDescription load(const RenderCommand& command, const std::vector<std::string>& outputs) {
  try {
    return load_beside(outputs, [&] {
      return load_scene(command.scene, command.overrides,
                        with_streams({command.frame, command.native_code, command.outside_files}));
    });
  } catch (const SceneError& error) {
    if (error.file == scene_file_name(command.scene))
      for (const std::string& setting : command.overrides)
        if (concerns(setting, error.place)) throw UsageError(error.what());
    throw;
  }
}

RenderOptions render_options(const RenderCommand& command, const ImageSettings& image) {
  RenderOptions options;
  options.work_group = command.work_group;
  options.split = command.split;
  if (command.part) options.part = *command.part;
  options.tile = command.tile;
  options.aovs = made_aovs(command);
  options.channels = command.part ? 0 : image_channels(format_name(command), image.transparent);
  options.resume = command.resume;
  if (const char* seconds = std::getenv("SUNDOG_CHECKPOINT_EVERY"))
    options.checkpoint_seconds = std::max(0.0, std::strtod(seconds, nullptr));
  options.faults = program_environment()->faults;
  options.keep_failed = true;
  options.time_limit = command.time_limit;
  options.noise = command.noise;
  return options;
}

/// What the frames of one run share.
struct Setup {
  const StopOnSignal& stop;
  Mailbox* job = nullptr;  // the other processes that mpirun has started
  std::vector<DeviceInfo> devices;
  std::unique_ptr<RenderSession> session;  // of frames on this process's devices, which stay open
};

/// In a job there always is one: mpirun kills all ranks when one dies.
std::string checkpoint_file(const RenderCommand& command, const Setup& setup) {
  const std::string name = is_standard_stream(command.out) ? "sundog" : command.out;
  return setup.job && command.resume.empty() ? name + ".checkpoint" : command.resume;
}

/// Until the frame begins there is nothing to save. (In a job the other ranks want to be told.)
void stop_loses_nothing(const RenderCommand& command, const Setup& setup) {
  if (!setup.job)
    setup.stop.ends_all(fmt::format("the frame was not yet begun; {} is not written", command.out));
}

/// A scene as it is read, flattened and recognised.
struct LoadedScene {
  SceneDescription description;
  std::shared_ptr<const CompiledScene> flat;
};

std::vector<DeviceInfo> choose_devices(const RenderCommand& command, Mailbox* job) {
  if (job) return job_devices(*job, command);
  return pick_devices(command.isolate ? enumerate_in_worker() : list_devices(), command.devices,
                      command.verbose && !command.quiet);
}

/// A halo is traced by the first of the devices. With workers, which compile the scene too, each process
/// traces on the host: the map is the same.
CompiledScene compile_traced(const RenderCommand& command, SceneDescription& scene, Setup& setup) {
  if (scene.environment.type == EnvironmentType::halo && !command.isolate && !setup.job) {
    if (setup.devices.empty()) setup.devices = choose_devices(command, setup.job);
    TracedHalo traced = trace_halo_map(scene.environment, setup.devices, command.quiet);
    scene.environment.halo_map = std::make_shared<const HaloMap>(std::move(traced.map));
  }
  return compile(scene);
}

LoadedScene load_and_compile(const RenderCommand& command, const std::vector<std::string>& outputs,
                             Setup& setup, TimeLedger& times) {
  LoadedScene scene;
  scene.description = timed(times.load, [&] { return load(command, outputs); });
  scene.flat = timed(times.compile_scene, [&] {
    return std::make_shared<const CompiledScene>(compile_traced(command, scene.description, setup));
  });
  const int width = static_cast<int>(scene.flat->info.width),
            height = static_cast<int>(scene.flat->info.height);
  if (!command.part) check_image_size(format_name(command), width, height);
  check_frame_memory(width, height,
                     frame_output(command, scene.description.image, in_passes(scene.flat->sampling)));
  return scene;
}

std::vector<ServerPlan> plan_servers(const RenderCommand& command, const LoadedScene& scene,
                                     const Setup& setup) {
  if (setup.job) return plan_job(*setup.job, command, setup.devices, scene.flat);
  const std::uint64_t hash = command.isolate ? hash_scene(*scene.flat) : 0;
  std::vector<ServerPlan> plans;
  for (const DeviceInfo& device : setup.devices)
    plans.push_back(command.isolate ? plan_isolated(command, device, hash) : plan_local(scene.flat, device));
  return plans;
}

int render_one(const RenderCommand& command, const LoadedScene& scene, const Setup& setup,
               const Stopwatch& clock, TimeLedger& times) {
  setup.stop.asks();
  print_warnings(view_warnings(scene.description, *scene.flat, setup.devices));
  for (const std::string& file : {command.out, command.stats, checkpoint_file(command, setup)})
    if (!file.empty()) remove_left_over(file);
  ProgressBar bar(!command.quiet);
  RenderOptions options = render_options(command, scene.description.image);
  const std::string checkpoint = checkpoint_file(command, setup);
  RankWatch watch(setup.job, setup.stop.flag(), checkpoint);
  options.stop = &setup.stop.flag();
  options.checkpoint = checkpoint;
  options.in_haste = setup.job != nullptr;
  if (setup.job) options.keep_now = &setup.stop.continued();
  options.tuning = [flat = scene.flat](const DeviceInfo& device) { return saved_tuning(device, *flat); };
  if (command.write_every > 0) {
    options.picture_seconds = command.write_every;
    options.on_picture = [&](const Film& film) { write_so_far(command, scene.description.image, film); };
  }
  options.on_progress = [&](const RenderProgress& now) { bar.update(now); };
  RenderResult result = setup.session ? setup.session->render(scene.flat, options)
                                      : render(scene.flat, plan_servers(command, scene, setup), options);
  bar.erase();
  const bool told = setup.job && result.checkpoint_kept && !result.failure;
  if (told) tell_kept(result, checkpoint);

  times.render = result.times;
  const Stopwatch writing;
  save_result(command, scene.description, *scene.flat, result, checkpoint);
  times.write = writing.seconds();
  warn_of_losses(scene.description, result);
  times.total = clock.seconds();
  if (!command.stats.empty()) {
    using nlohmann::json;
    const json stats = stats_json(command, scene.description, *scene.flat, result, times);
    write_output(command.stats, stats.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
  }
  tell_result(command, scene.description, result, times);
  return conclude(command, result, told);
}

/// The command of one frame: its files are numbered.
RenderCommand frame_command(const RenderCommand& command, int frame) {
  RenderCommand one = command;
  one.frame = frame;
  one.out = frame_file(command.out, frame);
  if (!command.stats.empty()) one.stats = frame_file(command.stats, frame);
  return one;
}

/// Checks the files of all frames before the first is rendered.
std::vector<std::string> output_files_of_all(const RenderCommand& command) {
  std::vector<std::string> files;
  for (int frame = command.frames->first; frame <= command.frames->last; ++frame)
    for (std::string& file : output_files(frame_command(command, frame))) files.push_back(std::move(file));
  return files;
}

int render_frames(const RenderCommand& command, Setup& setup) {
  FrameLog log(command.resume.empty() ? "" : command.resume + ".frames");
  print_warnings(log.warnings());
  if (!command.resume.empty()) remove_left_over(command.resume + ".frames");
  for (int frame = command.frames->first; frame <= command.frames->last; ++frame) {
    const Stopwatch clock;
    TimeLedger times;
    const RenderCommand one = frame_command(command, frame);
    stop_loses_nothing(one, setup);
    const bool first = frame == command.frames->first;
    const LoadedScene scene =
        load_and_compile(one, first ? output_files_of_all(command) : output_files(one), setup, times);
    if (first) print_warnings(scene.description.warnings);
    const std::uint64_t hash = hash_scene(*scene.flat);
    if (log.done({frame, static_cast<int>(scene.flat->info.width), static_cast<int>(scene.flat->info.height),
                  one.out, one.scene, checkpoint_file(one, setup)},
                 hash))
      continue;
    if (const int status = render_one(one, scene, setup, clock, times)) return status;
    log.add(frame, hash);
  }
  log.remove();
  return exit_done;
}

/// Of this process, or of rank 0 of a job.
int render_here(const RenderCommand& command, const StopOnSignal& stop, Mailbox* job) {
  const Stopwatch clock;
  Setup setup{stop, job, {}, nullptr};
  check_frames(command);
  check_outputs(command.frames ? frame_command(command, command.frames->first) : command);
  if (is_standard_stream(command.out) || is_standard_stream(command.stats)) claim_standard_output();
  TimeLedger times;
  std::optional<LoadedScene> scene;
  if (!command.frames) {
    stop_loses_nothing(command, setup);
    scene = load_and_compile(command, output_files(command), setup, times);
    print_warnings(scene->description.warnings);
  }
  if (const std::string why = cache_refusal(program_environment()->cache); !why.empty())
    print_warnings({{why}});
  if (setup.devices.empty()) setup.devices = choose_devices(command, job);
  if (scene) return render_one(command, *scene, setup, clock, times);
  if (!job && !command.isolate) setup.session = std::make_unique<RenderSession>(setup.devices);
  return render_frames(command, setup);
}

}  // namespace

int render_command(const RenderCommand& command) {
  // An interrupt reaches every process of a job; rank 0 decides.
  std::optional<StopOnSignal> stop;
  if (job_rank() > 0)
    hold_back({SIGINT, SIGTERM, SIGHUP});
  else
    stop.emplace();
  if (job_rank() < 0) return render_here(command, *stop, nullptr);
  std::unique_ptr<Mailbox> job;
  const auto join = [&] {
    job = join_job();
    return exit_done;
  };
  if (const int status = exit_status_of(join, job_rank() == 0)) return status;
  if (job->rank() > 0) serve_job(std::move(job));
  const int status = exit_status_of([&] { return render_here(command, *stop, job.get()); });
  std::fflush(nullptr);
  job->leave(status);
  return status;
}

}  // namespace sundog
