// `sundog render`: declares its options and checks their values; render_scene() runs it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "app/options/command.h"
#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/options/picture_options.h"
#include "app/render/render_scene.h"
#include "base/error.h"
#include "render/film/group_names.h"
#include "scene/integrators.h"
#include "scene/kinds.h"

namespace sundog {
namespace {

/// The options of `render` as typed, before they are checked.
struct TypedRender {
  RenderCommand command;
  std::string size, samples, seed, max_depth, integrator, filter, filter_radius, adaptive, time_limit, noise,
      write_every, work_group = "auto", split = "dynamic", part, region, tile, frames, step;
  bool subsample = false, caustics = false;
};

/// The options as overrides of the scene. Those that abbreviate a --set come first, so that a --set of the
/// same value wins.
std::vector<std::string> collect_overrides(const TypedRender& typed) {
  std::vector<std::string> all;
  if (!typed.size.empty()) all = parse_image_size(typed.size);
  if (!typed.samples.empty()) all.push_back(render_setting("--samples", "samples", typed.samples));
  if (typed.seed == "frame")
    all.emplace_back("/render/seed=frame");
  else if (!typed.seed.empty())
    all.push_back(render_setting("--seed", "seed", typed.seed));
  if (!typed.max_depth.empty()) all.push_back(render_setting("--max-depth", "max_depth", typed.max_depth));
  const Integrator* named = find_integrator(typed.integrator);
  if (typed.caustics && !typed.integrator.empty() && !(named && named->photons))
    throw UsageError(fmt::format("--caustics: photons are for --integrator path, not {}", typed.integrator));
  if (typed.caustics) all.insert(all.end(), {"/render/integrator=\"path\"", "/render/caustics=true"});
  if (!typed.integrator.empty()) all.push_back(fmt::format("/render/integrator=\"{}\"", typed.integrator));
  if (!typed.filter.empty()) all.push_back(fmt::format("/render/filter=\"{}\"", typed.filter));
  if (!typed.filter_radius.empty()) all.push_back("/render/filter_radius=" + typed.filter_radius);
  for (const std::string& setting : tone_map_overrides(typed.command)) all.push_back(setting);
  if (!typed.adaptive.empty())
    all.push_back(fmt::format("/render/adaptive/threshold={}", parse_amount("--adaptive", typed.adaptive)));
  if (typed.subsample) all.push_back("/render/subsample/on=true");
  if (typed.command.transparent) all.push_back("/image/transparent=true");
  // A render that may end early first takes one sample of each pixel.
  if (typed.adaptive.empty() && !typed.subsample && (!typed.time_limit.empty() || !typed.noise.empty()))
    all.push_back("/render/progressive=true");
  for (const std::string& setting : typed.command.overrides) {
    check_override(setting);
    all.push_back(setting);
  }
  return all;
}

constexpr const char* light_parts = "light_parts";  // stands for all parts of light

/// The AOVs, each once, with "light_parts" expanded.
std::vector<std::string> with_parts_named(const std::vector<std::string>& typed) {
  std::vector<std::string> all;
  const auto add = [&](const std::string& name) {
    if (std::ranges::count(all, name) == 0) all.push_back(name);
  };
  for (const std::string& name : typed) {
    if (name != light_parts) add(name);
    for (const std::string& part : aov_names())
      if (name == light_parts && is_light(part)) add(part);
  }
  return all;
}

RenderCommand checked(const TypedRender& typed) {
  RenderCommand command = typed.command;
  check_format(command);
  command.overrides = collect_overrides(typed);
  command.work_group = parse_work_group(typed.work_group);
  command.split = parse_split(typed.split);
  if (!typed.frames.empty())
    command.frames =
        parse_frames(typed.frames, typed.step.empty() ? 1 : parse_number("--step", typed.step, 1, 999999));
  if (typed.frames.empty() && (!typed.step.empty() || command.skip_existing))
    throw UsageError(fmt::format("{} is for an animation: give its --frames as well",
                                 command.skip_existing ? "--skip-existing" : "--step"));
  if (!typed.part.empty()) command.part = parse_part(typed.part);
  if (!typed.region.empty()) command.region = parse_region(typed.region);
  if (command.part && command.region)
    throw UsageError("--crop makes a part of the picture as a picture: leave --tiles out");
  if (command.draft && (command.isolate || command.part || !command.resume.empty()))
    throw UsageError(
        "--draft makes a preview, which other parts and passes do not fit: leave --isolate, --tiles and "
        "--resume out");
  if (!typed.time_limit.empty()) command.time_limit = parse_amount("--time-limit", typed.time_limit);
  if (!typed.noise.empty()) command.noise = parse_amount("--noise-threshold", typed.noise);
  if (!typed.write_every.empty()) command.write_every = parse_amount("--write-every", typed.write_every);
  if (!typed.tile.empty()) command.tile = parse_number("--tile", typed.tile, 4, 65536);
  if (command.devices.empty()) command.devices = devices_of_environment();
  command.aovs = with_parts_named(command.aovs);
  for (const std::string& name : command.aovs)
    if (!is_light_group(name)) check_aov(name, "--aov ");
  return command;
}

}  // namespace

void add_render(Arguments& root, Command& chosen) {
  const auto typed = std::make_shared<TypedRender>();
  RenderCommand& command = typed->command;
  Arguments* app = root.add_subcommand(
      "render", "Render a scene to an image file; under mpirun, on the devices of all its processes");
  value(app, "SCENE", "FILE", command.scene, scene_help)->required();
  add_picture(app, command);
  values(app, "--device", "SPEC", command.devices, device_help);
  value(app, "--tiles", "I/N", typed->part,
        "render part I of N only, into a .part file that `sundog merge` takes");
  app->add_flag("--isolate", command.isolate,
                "a worker process for each device: a driver that crashes or hangs takes nothing else along");
  value(app, "--size", "WxH", typed->size, "width and height in pixels");
  value(app, "--crop", "X,Y,WxH", typed->region,
        "only this rectangle of the picture: X and Y are its upper left corner, from that of the picture");
  value(app, "--samples", "N", typed->samples, "samples a pixel");
  value(app, "--max-depth", "N", typed->max_depth,
        "greatest depth of the ray tree; 1: the camera's rays alone. Without it paths end by chance");
  value(app, "--seed", "N", typed->seed,
        "other random numbers: pictures of several seeds have a mean with less noise; frame: the frame's "
        "number, as --frames has it without a seed");
  value(app, "--integrator", "NAME", typed->integrator,
        fmt::format("how light is followed: {}", fmt::join(integrator_names, ", ")));
  app->add_flag("--caustics", typed->caustics,
                "path tracing with photons, which bring the light behind glass and off mirrors");
  value(app, "--filter", "NAME", typed->filter,
        fmt::format("how a pixel's samples add up: {}", fmt::join(filter_names, ", ")));
  value(app, "--filter-radius", "R", typed->filter_radius, "the filter's reach in pixels");
  value(app, "--adaptive", "T", typed->adaptive,
        "more samples only where the picture's estimated error is above T; --samples is the most");
  app->add_flag("--subsample", typed->subsample,
                "samples for every second pixel each way, and for the others where they are needed");
  value(app, "--time-limit", "S", typed->time_limit,
        "end the render after S seconds and write the picture so far");
  value(app, "--noise-threshold", "T", typed->noise,
        "end the render when its mean estimated error is below T");
  value(app, "--write-every", "S", typed->write_every, "write the picture so far every S seconds");
  values(app, "--set", "POINTER=VALUE", command.overrides, "change the scene, as in /camera/fov=30");
  app->add_flag("--draft", command.draft,
                "a preview by kernels that all scenes share: whatever is edited, nothing is compiled anew. "
                "They are slower and round otherwise, so a few pixels differ from the picture");
  value(app, "--work-group", "SIZE", typed->work_group, "local size: N, WxH, auto or driver");
  value(app, "--split", "HOW", typed->split,
        "share the frame among devices: dynamic (by measured speed), static (fixed parts by estimated speed) "
        "or fixed shares such as 3,1");
  value(app, "--tile", "N", typed->tile, "edge of the tiles in pixels (default: by measured speed)");
  value(app, "--frames", "LIST", typed->frames,
        "render these frames of the scene's animation, as 0..48, 48..0 or 1,4,10..20, to numbered files "
        "(out_0001.png, or where OUT has ####)");
  value(app, "--step", "N", typed->step, "of each range of --frames render every Nth frame");
  app->add_flag("--skip-existing", command.skip_existing,
                "leave frames alone whose picture is there and not empty");
  value(app, "--stats", "FILE", command.stats,
        "write rays, times and devices to this JSON file; -: the standard output");
  values(app, "--aov", "NAME", command.aovs,
         fmt::format("an extra image in the .exr: {}; {}: all ten parts of light; light_NAME: a group of "
                     "lights; {}: all of them",
                     fmt::join(aov_names(), ", "), light_parts, light_groups_aov));
  app->add_flag("--transparent", command.transparent,
                "leave what is behind the scene out of .png and .exr: their alpha says what covers it");
  app->add_flag("--denoise", command.denoise,
                "take the noise out of the picture by Open Image Denoise, a library that is loaded for it");
  app->add_flag("--metadata", command.metadata,
                "write scene, settings, devices, version and time into the .png or .exr");
  value(app, "--resume", "FILE", command.resume,
        "checkpoint: written when interrupted, continued from when it is there");
  app->add_flag("--allow-native-code", command.native_code,
                "take OpenCL C that the scene carries (\"native\"); only for files that you trust");
  outside_files(app, command.outside_files);
  app->add_flag("-q,--quiet", command.quiet, "no progress bar and no summary");
  app->add_flag("-v,--verbose", command.verbose, "tell more: times, rays, kernels");
  app->callback([typed, &chosen] {
    chosen = {.run = [command = checked(*typed)] { return render_scene(command); }, .in_first_thread = true};
  });
}

}  // namespace sundog
