#include "app/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>

#include "bench/commands/bench_options.h"
#include "bench/commands/tune_command.h"
#include "app/commands/bake_command.h"
#include "app/commands/check_command.h"
#include "app/commands/formulas_command.h"
#include "app/commands/gallery_command.h"
#include "app/commands/halo_command.h"
#include "app/commands/kernels_command.h"
#include "app/options/command_words.h"
#include "app/options/commands.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/process/standard_streams.h"
#include "app/serve/serve_command.h"
#include "base/error.h"
#include "base/image_io.h"
#include "base/names.h"
#include "scene/integrators.h"
#include "scene/kinds.h"

namespace sundog {
namespace {

constexpr const char* short_help =
    R"(sundog renders scenes with OpenCL, on any device there is.

  sundog render SCENE -o OUT.png   render a scene (.json) or a model (.gltf .glb .obj .ply .stl .nff)
  sundog check                     check drivers, caches and devices
  sundog devices                   list the devices, for --device
  sundog info SCENE                what a scene holds
  sundog formulas                  the fractals and solids that scenes may name

All commands: {}.
`sundog --help` describes all commands, `sundog COMMAND --help` a command's options.
)";

/// The options of `render` as typed, before they are checked.
struct TypedRender {
  RenderCommand command;
  std::string size, samples, seed, max_depth, integrator, filter, filter_radius, adaptive, time_limit, noise,
      write_every, work_group = "auto", split = "dynamic", part, region, tile, frames, step;
  bool subsample = false, caustics = false;
};

/// The options that only shorten a --set come first, so that a --set of the same value wins.
std::vector<std::string> collect_overrides(const TypedRender& typed) {
  std::vector<std::string> all;
  if (!typed.size.empty()) all = parse_image_size(typed.size);
  if (!typed.samples.empty())
    all.push_back(fmt::format("/render/samples={}", parse_number("--samples", typed.samples, 1, 65536)));
  if (typed.seed == "frame")
    all.emplace_back("/render/seed=frame");
  else if (!typed.seed.empty())
    all.push_back(fmt::format("/render/seed={}", parse_number("--seed", typed.seed, 0, 2147483647)));
  if (!typed.max_depth.empty())
    all.push_back(
        fmt::format("/render/max_depth={}", parse_number("--max-depth", typed.max_depth, 1, 65536)));
  if (typed.caustics && !typed.integrator.empty() && !traces_paths(typed.integrator))
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
  // What may end early begins with a sample of each pixel.
  if (typed.adaptive.empty() && !typed.subsample && (!typed.time_limit.empty() || !typed.noise.empty()))
    all.push_back("/render/progressive=true");
  for (const std::string& setting : typed.command.overrides) {
    check_override(setting);
    all.push_back(setting);
  }
  return all;
}

void add_picture(Arguments* app, PictureOptions& picture) {
  value(app, "-o,--out", "FILE", picture.out,
        "image file: .png, .jpg, .exr, .hdr or .pfm; -: the standard output")
      ->required();
  value(app, "--format", "NAME", picture.format,
        fmt::format("of the image that -o - writes: {} (default: png)", fmt::join(image_formats(), ", ")));
  app->add_flag("--float", picture.full_floats, "keep an .exr's colours as 32-bit floats (default: half)");
  value(app, "--color-space", "NAME", picture.color_space, "of an .exr's colours: srgb (default) or acescg")
      ->one_of({"srgb", "acescg"});
  value(app, "--bits", "N", picture.bits, "of a .png's channels: 8 (default) or 16")->range(8, 16);
  value(app, "--tone-map", "CURVE", picture.tone_curve,
        fmt::format("how .png and .jpg show colours brighter than white: {}",
                    fmt::join(tone_curve_names, ", ")));
  value(app, "--exposure", "STOPS", picture.exposure, "brighten .png and .jpg by so many stops");
  value(app, "--white-balance", "KELVIN", picture.white_balance,
        "the temperature of the light that is white in .png and .jpg");
  value(app, "--dpi", "N", picture.dpi, "pixels an inch that .png, .jpg and .exr state (default 72)")
      ->range(1, 65535);
  app->add_flag("--icc", picture.icc, "put an ICC profile, that of sRGB, into .png and .jpg");
  value(app, "--far", "Z", picture.far, "the AOV depth where nothing is (default: infinite)");
  app->add_flag("--no-dither", picture.no_dither, "round colours of .png and .jpg to the nearest of 8 bits");
}

void check_format(PictureOptions& picture) {
  const auto& known = image_formats();
  if (!picture.format.empty() && !is_standard_stream(picture.out))
    throw UsageError("--format is for -o -: a file's name says its format");
  if (!picture.format.empty() && std::ranges::count(known, picture.format) == 0)
    throw UsageError(fmt::format(
        "--format {}: {}", picture.format,
        did_you_mean(picture.format, known, fmt::format("wanted one of {}", fmt::join(known, ", ")), "")));
  if (picture.format.empty()) picture.format = "png";
}

constexpr const char* light_parts = "light_parts";  // stands for all parts of light

/// The AOVs, each once.
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
  if (!typed.time_limit.empty()) command.time_limit = parse_amount("--time-limit", typed.time_limit);
  if (!typed.noise.empty()) command.noise = parse_amount("--noise-threshold", typed.noise);
  if (!typed.write_every.empty()) command.write_every = parse_amount("--write-every", typed.write_every);
  if (!typed.tile.empty()) command.tile = parse_number("--tile", typed.tile, 4, 65536);
  if (command.devices.empty()) command.devices = devices_of_environment();
  command.aovs = with_parts_named(command.aovs);
  for (const std::string& name : command.aovs)
    if (std::ranges::count(aov_names(), name) == 0)
      throw UsageError(
          fmt::format("--aov {}: {}", name,
                      did_you_mean(name, aov_names(),
                                   fmt::format("wanted one of {}", fmt::join(aov_names(), ", ")), "")));
  return command;
}

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
  value(app, "--work-group", "SIZE", typed->work_group, "local size: N, WxH, auto or driver");
  value(app, "--split", "HOW", typed->split,
        "share the frame among devices: dynamic (by measured speed), static (fixed parts by estimated speed) "
        "or "
        "fixed shares such as 3,1");
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
         fmt::format("an extra image in the .exr: {}; {}: all ten parts of light",
                     fmt::join(aov_names(), ", "), light_parts));
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
  app->callback([typed, &chosen] { chosen = checked(*typed); });
}

void add_devices(Arguments& root, Command& chosen) {
  const auto command = std::make_shared<DevicesOptions>();
  Arguments* app = root.add_subcommand("devices", "List every OpenCL platform and device");
  app->add_flag("--json", command->json, "as JSON");
  app->callback([command, &chosen] { chosen = *command; });
}

void add_info(Arguments& root, Command& chosen) {
  const auto command = std::make_shared<InfoCommand>();
  Arguments* app = root.add_subcommand("info", "What a scene holds: triangles, lights, BVH figures, bytes");
  value(app, "SCENE", "FILE", command->scene, scene_help)->required();
  values(app, "--set", "POINTER=VALUE", command->overrides,
         "change the scene, as in /render/spatial_splits=true");
  outside_files(app, command->outside_files);
  app->add_flag("--json", command->json, "as JSON");
  app->callback([command, &chosen] { chosen = *command; });
}

void add_compare(Arguments& root, Command& chosen) {
  const auto command = std::make_shared<CompareCommand>();
  const auto tolerance = std::make_shared<std::string>("0");
  Arguments* app = root.add_subcommand("compare", "Compare two images; exit status 6 when they differ");
  value(app, "A", "FILE", command->a, "image file: .png, .jpg, .exr, .hdr or .pfm")->required();
  value(app, "B", "FILE", command->b, "image file")->required();
  value(app, "--tolerance", "T", *tolerance,
        "greatest difference that passes, in linear colour (1 is white; default 0)");
  value(app, "--diff", "FILE", command->diff, "write a picture that shows where they differ");
  app->add_flag("--json", command->json, "print the figures as JSON");
  app->callback([command, tolerance, &chosen] {
    command->tolerance = parse_tolerance(*tolerance);
    chosen = *command;
  });
}

void add_merge(Arguments& root, Command& chosen) {
  const auto command = std::make_shared<MergeCommand>();
  Arguments* app = root.add_subcommand("merge", "Join the parts that render --tiles has written");
  app->add_option("PART", command->parts, "files that render --tiles has written")
      ->required()
      ->type_name("FILE");
  add_picture(app, *command);
  app->add_flag("--transparent", command->transparent,
                "keep alpha in a .png, of parts that were so rendered");
  app->callback([command, &chosen] {
    check_format(*command);
    chosen = *command;
  });
}

CommandWords words_of(const CLI::App& app, const std::string& before = "") {
  CommandWords words{app.get_name(), before + app.get_name(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();  // with what it is checked for behind a colon
    OptionWords one{{}, option->get_items_expected_min() > 0, type.substr(0, type.find(':'))};
    for (const std::string& name : option->get_lnames()) one.names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) one.names.push_back("-" + name);
    words.options.push_back(one);
  }
  for (const CLI::App* command : app.get_subcommands(nullptr))
    words.commands.push_back(words_of(*command, words.line + " "));
  return words;
}

}  // namespace

std::vector<std::string> devices_of_environment() {
  const char* text = std::getenv("SUNDOG_DEVICE");
  if (!text || !*text) return {};
  std::vector<std::string> specs = CLI::detail::split(text, ',');
  for (std::string& spec : specs) CLI::detail::trim(spec);
  return specs;
}

Command parse_command_line(int argc, const char* const* argv) {
  remember_command_line(argc, argv);
  Arguments arguments("sundog renders scenes with OpenCL, on any device there is.", "sundog");
  CLI::App& root = arguments.parser();
  root.set_version_flag("--version", "sundog " SUNDOG_VERSION);
  root.require_subcommand(1);
  Command chosen;
  add_render(arguments, chosen);
  add_devices(arguments, chosen);
  add_formulas(arguments, chosen);
  add_kernels(arguments, chosen);
  add_info(arguments, chosen);
  add_compare(arguments, chosen);
  add_check(arguments, chosen);
  add_tune(arguments, chosen);
  add_merge(arguments, chosen);
  add_bake(arguments, chosen);
  add_gallery(arguments, chosen);
  add_halo(arguments, chosen);
  add_serve(arguments, chosen);
  add_bench(arguments, chosen);
  const CommandWords words = words_of(root);
  if (argc < 2) return ShowText{fmt::format(short_help, fmt::join(command_names(words), ", ")), exit_usage};
  const CommandWords& named = check_words(words, argc, argv);
  try {
    root.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return ShowText{root.help()};
  } catch (const CLI::CallForVersion& version) {
    return ShowText{std::string(version.what()) + "\n"};
  } catch (const CLI::ExtrasError&) {
    throw UsageError(
        fmt::format("unknown argument: {} {}", fmt::join(root.remaining(true), " "), see_help(named)));
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{} {}", error.what(), see_help(named)));
  }
  return chosen;
}

}  // namespace sundog
