// Checks the command's outputs, joins an MPI job if there is one, and renders a frame (render_frame.cpp) or
// an animation (render_frames.cpp).
#include "app/render/render_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <optional>

#include "app/job/job.h"
#include "app/process/environment.h"
#include "app/process/exit_status.h"
#include "app/process/interrupt.h"
#include "app/process/standard_streams.h"
#include "app/process/warnings.h"
#include "app/render/denoise.h"
#include "app/render/draw_frame.h"
#include "app/render/metadata.h"
#include "app/render/output_files.h"
#include "app/render/render_frames.h"
#include "base/cache_folder.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"

namespace sundog {
namespace {

/// Throws UsageError if --write-every, which replaces its file, has a stream or a part as output.
void check_write_every(const RenderCommand& command) {
  if (command.write_every > 0 &&
      (command.part || is_standard_stream(command.out) || is_pipe_or_device(command.out)))
    throw UsageError(fmt::format("-o {}: --write-every wants an image file", command.out));
}

/// Checks options that need a whole picture (--denoise, --far, AOVs) or a format with texts (--metadata).
void check_extras(const RenderCommand& command) {
  if (command.part && (command.denoise || command.metadata))
    throw UsageError(fmt::format(
        "{}: a part of a frame is neither denoised nor described: leave --denoise, --metadata or --tiles out",
        command.out));
  if (!command.far.empty() && (command.part || std::ranges::count(command.aovs, "depth") == 0))
    throw UsageError(fmt::format("--far {}: {}", command.far,
                                 command.part ? "a part keeps its infinite depths: give --far to merge"
                                              : "is for the AOV depth: give --aov depth as well"));
  for (const std::string& name : command.aovs)
    if (command.part && (name == "samples" || name == "variance"))
      throw UsageError(fmt::format("--aov {}: wants a whole frame: leave --tiles out", name));
  if (command.metadata && !keeps_texts(format_name(command)))
    throw UsageError(fmt::format("{}: --metadata is for .png and .exr files", command.out));
  if (command.metadata) static_cast<void>(time_of_picture());
  if (command.denoise) static_cast<void>(Denoiser());
}

/// Throws for outputs that could not be written, before the render rather than after it.
void check_outputs(const RenderCommand& command) {
  if (command.part && lower_extension(command.out) != ".part")
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

/// Throws UsageError for frames that would go to a stream instead of numbered files.
void check_frames(const RenderCommand& command) {
  for (const std::string& file : {command.out, command.stats})
    if (!command.frames.empty() && is_standard_stream(file))
      throw UsageError("--frames writes numbered files: wanted a name for them, found -");
}

/// Renders in this process, or as rank 0 of a job. Returns the exit status.
int render_here(const RenderCommand& command, const StopOnSignal& stop, Mailbox* job) {
  const Stopwatch clock;
  Setup setup{stop, job, {}, nullptr};
  check_frames(command);
  check_outputs(command.frames.empty() ? command : frame_command(command, command.frames.front()));
  if (is_standard_stream(command.out) || is_standard_stream(command.stats)) claim_standard_output();
  TimeLedger times;
  std::optional<LoadedScene> scene;
  if (command.frames.empty()) {
    stop_loses_nothing(command, setup);
    const auto load = [&] {
      return std::make_shared<const SceneDescription>(
          load_for_command(command.scene, command.overrides, load_options(command), output_files(command)));
    };
    scene = load_and_compile(command, load, setup, times);
    print_warnings(scene->description->warnings);
  }
  if (const std::string why = cache_refusal(program_environment()->cache); !why.empty())
    print_warnings({{why}});
  if (setup.devices.empty()) setup.devices = choose_devices(command, job);
  if (scene) return render_one(command, *std::move(scene), setup, clock, times);
  if (!job && !command.isolate) setup.session = std::make_unique<RenderSession>(setup.devices);
  return render_frames(command, setup);
}

}  // namespace

int render_scene(const RenderCommand& command) {
  // An interrupt reaches every process of a job; only rank 0 acts on it.
  std::optional<StopOnSignal> stop;
  if (job_rank() > 0)
    hold_back({SIGINT, SIGTERM, SIGHUP, SIGXCPU});
  else
    stop.emplace();
  if (job_rank() < 0) return render_here(command, *stop, nullptr);
  std::unique_ptr<Mailbox> job;
  const auto join = [&] {
    job = join_job();
    return exit_done;
  };
  if (const int status = exit_status_of(join, job_rank() == 0)) return status;
  if (job->rank() > 0) work_for_job(std::move(job));
  const int status = exit_status_of([&] { return render_here(command, *stop, job.get()); });
  std::fflush(nullptr);
  job->leave(status);
  return status;
}

}  // namespace sundog
