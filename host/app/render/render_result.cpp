// Denoises, tone-maps and saves the picture, then reports figures and the exit status.
#include "app/render/render_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>

#include "app/job/job.h"
#include "app/options/option_values.h"
#include "app/process/exit_status.h"
#include "app/process/standard_streams.h"
#include "app/process/warnings.h"
#include "app/render/denoise.h"
#include "app/render/metadata.h"
#include "app/render/output_files.h"
#include "app/render/save_image.h"
#include "base/error.h"
#include "base/image_io.h"
#include "base/named_values.h"
#include "compile/placing/next_shot.h"
#include "render/film/cryptomatte.h"
#include "render/film/group_names.h"
#include "render/film/hash.h"
#include "render/film/motion.h"
#include "render/film/sampling_report.h"
#include "scene/dark_world.h"
#include "scene/shot.h"

namespace sundog {
namespace {

/// The settings besides the scene's file that all parts of a frame must share.
std::map<std::string, std::string> settings_of(const RenderCommand& command, const CompiledScene& scene) {
  std::map<std::string, std::string> settings;
  for (const std::string& setting : command.overrides) {
    const std::size_t equals = setting.find('=');
    std::string& value = settings["--set " + setting.substr(0, equals)];
    const bool appends = !value.empty() && setting[equals - 1] == '-';
    value = fmt::format("{}{}{}", appends ? value : "", appends ? ", " : "", setting.substr(equals + 1));
  }
  for (const char* told_otherwise : {"/image/width", "/image/height", "/render/samples", "/render/max_depth"})
    settings.erase(std::string("--set ") + told_otherwise);
  settings["samples"] = fmt::format("{}", scene.info.samples);
  settings["max_depth"] = fmt::format("{}", scene.info.max_depth);
  if (command.frame) settings["frame"] = fmt::format("{}", *command.frame);
  return settings;
}

/// Prints how samples were distributed; with --verbose, also writes a picture of it.
void tell_samples(const RenderCommand& command, const RenderResult& result, u32 each) {
  if (result.film.taken.empty()) return;
  const SamplingFigures figures =
      sampling_figures(result.film.taken, result.film.done, result.film.surfaces_seen, each);
  fmt::print("  {:.3g} samples a pixel in {} passes, at most {}", figures.mean, result.film.stage,
             figures.most);
  if (result.complete && figures.saved > 0)
    fmt::print("; {:.1f} % of the pixels interpolated; {:.1f} % fewer camera rays than {} a pixel",
               100 * figures.share_interpolated, 100 * figures.saved, each);
  fmt::print("\n");
  if (!command.verbose || is_standard_stream(command.out)) return;
  write_image(sampling_picture(result.film.taken, result.film.width, result.film.height),
              samples_file(command));
  fmt::print("  where they went: {}\n", samples_file(command));
}

double percent_done(const RenderResult& result) {
  const auto& done = result.film.done;
  const double pixels = static_cast<double>(std::max<std::size_t>(1, done.size()));
  return 100 * static_cast<double>(std::ranges::count(done, 1)) / pixels;
}

/// Whether no pixel is finished: the picture would be black, and might overwrite a good one.
bool is_empty(const RenderResult& result) {
  return !result.complete && std::ranges::count(result.film.done, 1) == 0;
}

std::string part_text(const RenderCommand& command, const RenderResult& result) {
  if (command.part || is_empty(result))
    return fmt::format("{}{} is not written{}", is_empty(result) ? "no pixel was made; " : "", command.out,
                       command.resume.empty() ? "" : "; the same command continues from its checkpoint");
  return fmt::format("{:.3g} % of the pixels are in {}{}", percent_done(result), command.out,
                     command.resume.empty() ? "" : "; the same command continues from there");
}

/// Seconds from the frame's beginning to its end.
double seconds_of(const RenderTimes& times) {
  return times.build_kernels + times.upload + times.render + times.readback;
}

/// Takes the frame's picture, denoised if requested and the frame was not interrupted.
Image take_image(const RenderCommand& command, RenderResult& result) {
  Image image = std::move(result.image);
  if (command.denoise && (result.complete || result.time_limited))
    Denoiser().denoise(image, result.aovs.at(feature_albedo), result.aovs.at(feature_normal));
  return image;
}

std::optional<Region> region_of(const RenderCommand& command, const ImageSettings& image) {
  if (!command.region) return std::nullopt;
  return Region{command.region->x, command.region->y, image.width, image.height};
}

/// Takes the requested AOVs, without those that only the denoiser needed. A part has no developed AOVs.
AovImages take_aovs(const RenderCommand& command, const Shot& shot, const std::optional<Region>& region,
                    RenderResult& result) {
  std::erase_if(result.aovs,
                [&](const auto& aov) { return std::ranges::count(command.aovs, aov.first) == 0; });
  end_depth(command, result.aovs);
  find_motion(result.aovs, shot, region);
  return without_group_numbers(std::move(result.aovs));
}

}  // namespace

std::string samples_file(const RenderCommand& command) {
  std::filesystem::path path = command.out;
  return path.replace_extension(".samples.png").string();
}

FrameOutput frame_output(const RenderCommand& command, const ImageSettings& image, bool passes) {
  return {format_name(command),
          made_aovs(command),
          !command.resume.empty() || job_rank() >= 0,
          command.tile,
          passes,
          command.denoise,
          image_channels(format_name(command), image.transparent),
          command.bits};
}

Shot frame_shot(const RenderCommand& command, const SceneDescription& scene,
                const std::optional<NextShot>& next) {
  Shot shot = shot_of(scene, command.frame);
  if (std::ranges::count(command.aovs, motion_aov) > 0) shot.next = next ? *next : next_shot(scene, nullptr);
  return shot;
}

void save_result(const RenderCommand& command, const SceneDescription& scene, const CompiledScene& flat,
                 const Shot& shot, RenderResult& result, const std::string& checkpoint) {
  Image image = take_image(command, result);
  FileOptions file = file_options(command);
  file.region = region_of(command, scene.image);
  AovImages aovs = take_aovs(command, shot, file.region, result);
  const MatteNames names{names_of(scene.objects), names_of(scene.materials)};
  file.texts = name_cryptomattes(aovs, names);
  file.shot = shot;
  if (command.metadata)
    for (auto& text : metadata(command, scene, result)) file.texts.push_back(std::move(text));
  // A region's film is a crop, which cannot serve as a checkpoint of the frame.
  const bool keeps = !command.region || result.checkpoint_kept;
  Picture picture{
      std::move(image),       aovs,           result.film, result.key,           keeps ? checkpoint : "",
      result.checkpoint_kept, command.format, file,        scene.image.tone_map, dithers(command)};
  if (command.part && picture.key == 0) picture.key = hash_scene(flat);
  if (!command.part && !is_empty(result))
    save_image(std::move(picture), command.out);
  else if (command.part && result.complete)
    save_part(picture,
              {*command.part, picture.key, command.scene, settings_of(command, flat), command.aovs, shot,
               aov_layout(command.aovs).mattes ? names : MatteNames()},
              command.out);
  if (!result.checkpoint_error.empty()) throw IoError(result.checkpoint_error);
  std::error_code stays;  // ignored, since the picture is saved
  if (result.complete && !checkpoint.empty()) std::filesystem::remove(checkpoint, stays);
}

void write_so_far(const RenderCommand& command, const ImageSettings& settings, const Film& film) {
  try {
    Image image = film.develop(image_channels(command.out, settings.transparent));
    FileOptions file = file_options(command);
    file.region = region_of(command, settings);
    write_image(shown_in(command.out, std::move(image), settings.tone_map, dithers(command)), command.out, {},
                file);
  } catch (const IoError&) {
    // the disk may have room again when the picture is finished
  }
}

void tell_kept(const RenderResult& result, const std::string& checkpoint) {
  tell(fmt::format(
      "sundog: interrupted: {:.3g} % of the pixels are in {}; the same command with --resume {} continues "
      "from there\n",
      percent_done(result), checkpoint, checkpoint));
}

std::vector<std::string> warnings_of(const SceneDescription& scene, const RenderResult& result) {
  std::vector<std::string> all = losses(result.counts, scene);
  if (!has_light(scene))
    all.push_back(
        "the picture is black, for nothing in the scene shines: give it lights, an environment or a "
        "background");
  for (const DeviceReport& report : result.devices) {
    for (std::string& text : failures_text(report)) all.push_back(std::move(text));
    for (const std::string& note : report.notes)  // several kernels may have the same
      if (std::ranges::count(all, note) == 0) all.push_back(note);
  }
  if (const std::string& left = result.checkpoint_left; !left.empty())
    all.push_back(left + "; the frame began anew");
  return all;
}

void tell_result(const RenderCommand& command, const ImageSettings& image, u32 samples,
                 const RenderResult& result, const TimeLedger& times) {
  if (command.quiet) return;
  const double rays = static_cast<double>(ray_count(result.counts));
  const double seconds = times.render.render + times.render.readback;
  fmt::print("{}: {}x{}, {:.4g} Mrays in {:.2f} s ({:.3g} Mrays/s), {:.2f} s in all\n", command.out,
             result.film.width, result.film.height, rays / 1e6, seconds,
             seconds > 0 ? rays / 1e6 / seconds : 0, times.total);
  tell_samples(command, result, samples);
  if (!command.verbose) return;
  const double pixels = static_cast<double>(result.film.done.size());
  const std::uint64_t each = bytes_a_pixel(frame_output(command, image, !result.film.taken.empty()));
  fmt::print("{}  {:<22} {:10.1f} MiB, {} bytes a pixel\n", details_text(result, times),
             "memory of the frame", pixels * static_cast<double>(each) / (1 << 20), each);
}

int conclude(const RenderCommand& command, const RenderResult& result, bool told) {
  if (result.complete) return exit_done;
  if (result.time_limited && !result.failure) {
    if (!command.quiet)
      fmt::print("  the time limit of {} s ended it, passed by {:.2f} s: {}\n", command.time_limit,
                 seconds_of(result.times) - command.time_limit, part_text(command, result));
    return exit_done;
  }
  if (result.failure) {
    tell(fmt::format("sundog: every device failed: {}\n", part_text(command, result)));
    std::rethrow_exception(result.failure);
  }
  if (!told) tell(fmt::format("sundog: interrupted: {}\n", part_text(command, result)));
  return exit_interrupted;
}

}  // namespace sundog
