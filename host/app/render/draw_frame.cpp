// Loads, compiles, draws, saves and reports one frame, each step in a function.
#include "app/render/draw_frame.h"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "app/job/rank_watch.h"
#include "app/job/remote_devices.h"
#include "app/options/devices.h"
#include "app/options/option_values.h"
#include "app/process/environment.h"
#include "app/process/standard_streams.h"
#include "app/process/trace_halo_map.h"
#include "app/process/warnings.h"
#include "app/render/draft.h"
#include "app/render/output_files.h"
#include "app/render/render_result.h"
#include "app/render/save_image.h"
#include "base/file.h"
#include "base/json_text.h"
#include "device/energy.h"
#include "render/device/tuning.h"
#include "render/device/view_warnings.h"
#include "render/film/group_names.h"
#include "render/film/hash.h"
#include "render/frame/frame.h"
#include "render/frame/local_worker.h"
#include "render/plan/passes.h"
#include "render/plan/tiles.h"
#include "scene/load.h"

namespace sundog {
namespace {

/// Runs `step`, adds its duration to `seconds`, and returns its result.
template <class Step>
auto timed(double& seconds, const Step& step) {
  const Stopwatch clock;
  auto result = step();
  seconds += clock.seconds();
  return result;
}

RenderOptions render_options(const RenderCommand& command, const ImageSettings& image) {
  RenderOptions options;
  options.work_group = command.work_group;
  if (command.draft) options.kernels = KernelChoice::draft;
  options.split = command.split;
  if (command.part) options.part = *command.part;
  options.region = command.region;
  options.tile = command.tile;
  options.aovs = made_aovs(command);
  options.channels = command.part ? 0 : image_channels(format_name(command), image.transparent);
  options.resume = command.resume;
  options.renews_checkpoint = !command.frames.empty();
  if (const char* seconds = std::getenv("SUNDOG_CHECKPOINT_EVERY"); seconds && *seconds)
    options.checkpoint_seconds = parse_real("SUNDOG_CHECKPOINT_EVERY", seconds, 0, 1e9);
  options.faults = program_environment()->faults;
  options.keep_failed = true;
  options.time_limit = command.time_limit;
  options.noise = command.noise;
  return options;
}

/// The checkpoint's file; empty: none. A job always has one, because mpirun kills all ranks when one dies.
std::string checkpoint_file(const RenderCommand& command, const Setup& setup) {
  const std::string name = is_standard_stream(command.out) ? "sundog" : command.out;
  return setup.job && command.resume.empty() ? name + ".checkpoint" : command.resume;
}

/// Traces the scene's halo on the first device that works, unless the previous frame had the same halo.
/// Workers compile the scene too, so each process then traces the same map on its host.
void trace_halo(const RenderCommand& command, std::shared_ptr<const SceneDescription>& scene, Setup& setup) {
  if (scene->environment.type != EnvironmentType::halo || command.isolate || setup.job) return;
  const ContentKey key = KeyMaker().add_halo(scene->environment).key();
  if (!(setup.halo.key == key)) {
    if (setup.devices.empty()) setup.devices = choose_devices(command, setup.job);
    TracedHalo traced = trace_halo_map(scene->environment, setup.devices, command.quiet);
    setup.halo = {key, std::make_shared<const HaloMap>(std::move(traced.map))};
  }
  auto with_map = std::make_shared<SceneDescription>(*scene);
  with_map->environment.halo_map = setup.halo.map;
  scene = std::move(with_map);
}

std::vector<WorkerPlan> plan_workers(const RenderCommand& of_frame, const LoadedScene& scene,
                                     const Setup& setup) {
  RenderCommand command = of_frame;
  command.moment = scene.moment;
  if (setup.job) return plan_job(*setup.job, command, setup.devices, scene.flat, setup.workers);
  if (!command.isolate) return plan_local_workers(scene.flat, setup.devices);
  const std::uint64_t hash = hash_scene(*scene.flat);
  std::vector<WorkerPlan> plans;
  for (const DeviceInfo& device : setup.devices)
    plans.push_back(plan_isolated(command, device, hash, setup.workers));
  return plans;
}

/// Whether to show a draft: the picture is written while it is rendered, on devices of this process.
bool shows_draft(const RenderCommand& command, const LoadedScene& scene, const Setup& setup) {
  return command.write_every > 0 && !command.draft && !command.isolate && !setup.job && !setup.session &&
         scene.times == 1;
}

void add_to(float4& sum, const float4& more) {
  sum.x += more.x, sum.y += more.y, sum.z += more.z, sum.w += more.w;
}

/// Adds the parts of light, or the light of groups. Other AOVs stay as at the first moment.
void add_light(const Film& more, RenderResult& all) {
  const AovLayout& layout = all.film.layout;
  for (std::size_t i = 0; i < all.film.aovs.size(); ++i)
    if (i % layout.vectors() >= layout.first_light()) add_to(all.film.aovs[i], more.aovs[i]);
  for (auto& [name, image] : all.aovs)
    if (is_light(name)) image = all.film.develop_aov(name);
}

/// Adds the samples of the same frame at another moment.
void add_samples(const RenderResult& more, int channels, RenderResult& all) {
  for (std::size_t i = 0; i < all.film.sums.size(); ++i) {
    add_to(all.film.sums[i], more.film.sums[i]);
    all.film.weights[i] += more.film.weights[i];
    all.film.done[i] = all.film.done[i] && more.film.done[i];
  }
  for (std::size_t i = 0; i < all.counts.size(); ++i) all.counts[i] += more.counts[i];
  if (all.film.layout.light) add_light(more.film, all);
  all.image = all.film.develop(channels);
  all.complete = all.complete && more.complete;
  all.time_limited = all.time_limited || more.time_limited;
  if (more.failure) all.failure = more.failure;
}

}  // namespace

std::vector<DeviceInfo> choose_devices(const RenderCommand& command, Mailbox* job) {
  if (job) return job_devices(*job, command);
  const bool verbose = command.verbose && !command.quiet;
  return command.isolate ? pick_devices(enumerate_in_worker(), command.devices, verbose)
                         : pick_devices(command.devices, verbose);
}

std::pair<int, int> picture_size(const RenderCommand& command, const CompiledScene& scene) {
  const int width = static_cast<int>(scene.info.width), height = static_cast<int>(scene.info.height);
  check_region(command.region, width, height);
  if (command.region) return {command.region->width, command.region->height};
  return {width, height};
}

std::vector<std::string> output_files(const RenderCommand& command) {
  std::vector<std::string> files = {command.out, command.stats, command.resume};
  if (command.verbose && !is_standard_stream(command.out)) files.push_back(samples_file(command));
  if (job_rank() >= 0 && command.resume.empty()) files.push_back(command.out + ".checkpoint");
  return files;
}

void stop_loses_nothing(const RenderCommand& command, const Setup& setup) {
  if (!setup.job)
    setup.stop.ends_all(fmt::format("the frame was not yet begun; {} is not written", command.out));
}

LoadOptions load_options(const RenderCommand& command) {
  return {.frame = command.frame,
          .native_code = command.native_code,
          .outside_files = command.outside_files,
          .environment = program_environment()};
}

LoadedScene load_and_compile(const RenderCommand& command, const LoadScene& load, Setup& setup,
                             TimeLedger& times) {
  LoadedScene scene;
  scene.description = timed(times.load, load);
  scene.flat = timed(times.compile_scene, [&] {
    trace_halo(command, scene.description, setup);
    return std::make_shared<const CompiledScene>(command.frame ? setup.compiler.compile(*scene.description)
                                                               : compile(*scene.description));
  });
  const auto [width, height] = picture_size(command, *scene.flat);
  if (!command.part) check_image_size(format_name(command), width, height);
  check_frame_memory(width, height,
                     frame_output(command, scene.description->image, in_passes(scene.flat->sampling)));
  return scene;
}

DrawnFrame draw_frame(const RenderCommand& asked, LoadedScene loaded, const Setup& setup, TimeLedger& times) {
  DrawnFrame drawn;
  drawn.command = asked;
  drawn.scene = std::move(loaded);
  const RenderCommand& command = drawn.command;
  const LoadedScene& scene = drawn.scene;
  drawn.command.aovs = with_group_numbers(asked.aovs, scene.flat->light_groups);
  setup.stop.asks();
  print_warnings(view_warnings(*scene.description, *scene.flat, setup.devices));
  for (const std::string& file : {command.out, command.stats, checkpoint_file(command, setup)})
    if (!file.empty()) remove_left_over(file);
  ProgressBar bar(!command.quiet, setup.run);
  RenderOptions options = render_options(command, scene.description->image);
  drawn.checkpoint = scene.times > 1 ? "" : checkpoint_file(command, setup);
  if (scene.times > 1) options.resume.clear(), options.time_limit /= scene.times;
  RankWatch watch(setup.job, setup.stop.flag(), drawn.checkpoint);
  options.stop = &setup.stop.flag();
  options.checkpoint = drawn.checkpoint;
  options.in_haste = setup.job != nullptr;
  if (setup.job) options.keep_now = &setup.stop.continued();
  options.tuning = [flat = scene.flat](const DeviceInfo& device) { return saved_tuning(device, *flat); };
  if (command.write_every > 0) {
    options.picture_seconds = command.write_every;
    options.on_picture = [&](const Film& film) { write_so_far(command, scene.description->image, film); };
  }
  std::optional<Draft> draft;
  if (shows_draft(command, scene, setup)) draft.emplace(scene.flat, setup.devices.front(), options);
  options.on_progress = [&](const RenderProgress& now) {
    if (draft && now.pixels_done > 0) draft->end();
    bar.update(now);
  };
  EnergyMeter energy(setup.devices);
  const Stopwatch frame;
  const auto make = [&](const LoadedScene& at) {
    return setup.session ? setup.session->render(at.flat, options)
                         : render_frame(*at.flat, plan_workers(command, at, setup), options, false);
  };
  drawn.result = make(scene);
  for (int time = 1; time < scene.times && drawn.result.complete && !drawn.result.failure; ++time)
    add_samples(make(scene.at_time(time)), options.channels, drawn.result);
  times.joules = energy.joules(), times.frame = frame.seconds(), times.joules_by = energy.source();
  times.render = drawn.result.times;
  if (draft) times.draft_pictures = draft->pictures();
  bar.erase();
  drawn.told = setup.job && drawn.result.checkpoint_kept && !drawn.result.failure;
  if (drawn.told) tell_kept(drawn.result, drawn.checkpoint);
  return drawn;
}

void save_frame(DrawnFrame& drawn, const Stopwatch& clock, TimeLedger& times) {
  const RenderCommand& command = drawn.command;
  const SceneDescription& scene = *drawn.scene.description;
  const CompiledScene& flat = *drawn.scene.flat;
  const Stopwatch writing;
  save_result(command, scene, flat, frame_shot(command, scene, drawn.scene.next), drawn.result,
              drawn.checkpoint);
  times.write = writing.seconds();
  drawn.warnings = warnings_of(scene, drawn.result);
  using nlohmann::json;
  json stats;
  if (!command.stats.empty()) stats = stats_json(command, scene, flat, drawn.result, times);
  drawn.image = scene.image;
  drawn.samples = static_cast<u32>(scene.render.samples);
  drawn.scene = {};
  times.total = clock.seconds() - times.waited;
  if (command.stats.empty()) return;
  stats["seconds"] = seconds_json(times);
  write_output(command.stats, json_text(stats, 2) + "\n");
}

int end_frame(const DrawnFrame& drawn, const TimeLedger& times) {
  print_warnings(drawn.warnings);
  tell_result(drawn.command, drawn.image, drawn.samples, drawn.result, times);
  return conclude(drawn.command, drawn.result, drawn.told);
}

int render_one(const RenderCommand& command, LoadedScene scene, const Setup& setup, const Stopwatch& clock,
               TimeLedger& times) {
  DrawnFrame drawn = draw_frame(command, std::move(scene), setup, times);
  save_frame(drawn, clock, times);
  return end_frame(drawn, times);
}

}  // namespace sundog
