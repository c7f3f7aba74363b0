#include "app/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>

#include "app/bench_options.h"
#include "app/check_command.h"
#include "app/formulas_command.h"
#include "app/option_helpers.h"
#include "app/option_values.h"
#include "app/tune_command.h"
#include "base/error.h"

namespace sundog {
namespace {

constexpr const char* more_help = "(sundog --help tells more)";

/// The options of `render` as typed, before they are checked.
struct TypedRender {
  RenderCommand command;
  std::string size, samples, max_depth, integrator, work_group = "auto", split = "dynamic", part, tile,
                                                    frames;
};

/// The options that only shorten a --set come first, so that a --set of the same value wins.
std::vector<std::string> collect_overrides(const TypedRender& typed) {
  std::vector<std::string> all;
  if (!typed.size.empty()) all = parse_image_size(typed.size);
  if (!typed.samples.empty())
    all.push_back(fmt::format("/render/samples={}", parse_number("--samples", typed.samples, 1, 65536)));
  if (!typed.max_depth.empty())
    all.push_back(fmt::format("/render/max_depth={}", parse_number("--max-depth", typed.max_depth, 1, 64)));
  if (!typed.integrator.empty()) all.push_back(fmt::format("/render/integrator=\"{}\"", typed.integrator));
  for (const std::string& setting : typed.command.overrides) {
    check_override(setting);
    all.push_back(setting);
  }
  return all;
}

RenderCommand checked(const TypedRender& typed) {
  RenderCommand command = typed.command;
  command.overrides = collect_overrides(typed);
  command.work_group = parse_work_group(typed.work_group);
  command.split = parse_split(typed.split);
  if (!typed.frames.empty()) command.frames = parse_frames(typed.frames);
  if (!typed.part.empty()) command.part = parse_part(typed.part);
  if (!typed.tile.empty()) command.tile = parse_number("--tile", typed.tile, 4, 65536);
  if (command.devices.empty()) command.devices = devices_of_environment();
  for (const std::string& name : command.aovs)
    if (std::ranges::count(aov_names(), name) == 0)
      throw UsageError(fmt::format("--aov {}: wanted one of {}", name, fmt::join(aov_names(), ", ")));
  return command;
}

void add_render(Arguments& root, Command& chosen) {
  const auto typed = std::make_shared<TypedRender>();
  RenderCommand& command = typed->command;
  Arguments* app = root.add_subcommand(
      "render", "Render a scene to an image file; under mpirun, on the devices of all its processes");
  value(app, "SCENE", "FILE", command.scene, scene_help)->required();
  value(app, "-o,--out", "FILE", command.out, "image file: .png, .exr, .hdr or .pfm")->required();
  values(app, "--device", "SPEC", command.devices, device_help);
  value(app, "--tiles", "I/N", typed->part,
        "render part I of N only, into a .part file that `sundog merge` takes");
  app->add_flag("--isolate", command.isolate,
                "a worker process for each device: a driver that crashes or hangs takes nothing else along");
  value(app, "--size", "WxH", typed->size, "width and height in pixels");
  value(app, "--samples", "N", typed->samples, "samples a pixel");
  value(app, "--max-depth", "N", typed->max_depth,
        "greatest depth of the ray tree; 1: the camera's rays alone");
  value(app, "--integrator", "NAME", typed->integrator, "how light is followed: whitted");
  values(app, "--set", "POINTER=VALUE", command.overrides, "change the scene, as in /camera/fov=30");
  value(app, "--work-group", "SIZE", typed->work_group, "local size: N, WxH, auto or driver");
  value(app, "--split", "HOW", typed->split,
        "share the frame among devices: dynamic (by measured speed), static (fixed parts by estimated speed) "
        "or "
        "fixed shares such as 3,1");
  value(app, "--tile", "N", typed->tile, "edge of the tiles in pixels (default: by measured speed)");
  value(
      app, "--frames", "A..B", typed->frames,
      "render these frames of the scene's animation to numbered files (out_0001.png, or where OUT has ####)");
  value(app, "--stats", "FILE", command.stats, "write rays, times and devices to this JSON file");
  values(app, "--aov", "NAME", command.aovs,
         fmt::format("an extra image in the .exr: {}", fmt::join(aov_names(), ", ")));
  app->add_flag("--float", command.full_floats, "keep an .exr's colours as 32-bit floats (default: half)");
  value(app, "--resume", "FILE", command.resume,
        "checkpoint: written when interrupted, continued from when it is there");
  app->add_flag("--allow-native-code", command.native_code,
                "take OpenCL C that the scene carries (\"native\"); only for files that you trust");
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
  value(app, "-o,--out", "FILE", command->out, "image file: .png, .exr, .hdr or .pfm")->required();
  app->add_flag("--float", command->full_floats, "keep an .exr's colours as 32-bit floats (default: half)");
  app->callback([command, &chosen] { chosen = *command; });
}

/// The library's own message about an unknown command only asks for one. `at`: where its name stands.
void check_command_name(const CLI::App& parent, int argc, const char* const* argv, int at = 1) {
  std::vector<std::string> names;
  const std::string wanted = argc > at ? argv[at] : "";
  for (const CLI::App* command : parent.get_subcommands(nullptr)) {
    names.push_back(command->get_name());
    if (names.back() == wanted) return check_command_name(*command, argc, argv, at + 1);
  }
  if (!names.empty() && !wanted.starts_with('-'))
    throw UsageError(fmt::format("wanted a {} ({}), found {} {}", at > 1 ? "benchmark" : "command",
                                 fmt::join(names, ", "), wanted.empty() ? "none" : "'" + wanted + "'",
                                 more_help));
}

/// The library takes whatever follows an option for its value: with a forgotten value, that is the next
/// option. (What really begins like one goes as --stats=-o.)
void check_values_given(const CLI::App& root, int argc, const char* const* argv) {
  const CLI::App* command = &root;
  for (int i = 1; i + 1 < argc && std::string_view(argv[i]) != "--"; ++i) {
    for (const CLI::App* inner : command->get_subcommands(nullptr))
      if (inner->get_name() == argv[i]) {
        command = inner;
        break;
      }
    if (argv[i][0] != '-') continue;
    const CLI::Option* option = command->get_option_no_throw(argv[i]);
    if (!option || option->get_items_expected_min() == 0) continue;
    const std::string next = argv[++i];
    const std::string type = option->get_type_name();  // with what it is checked for behind a colon
    if (next.size() > 1 && next[0] == '-' && command->get_option_no_throw(next))
      throw UsageError(fmt::format("{} wants a value ({}), found the option {} {}", argv[i - 1],
                                   type.substr(0, type.find(':')), next, more_help));
  }
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
  add_info(arguments, chosen);
  add_compare(arguments, chosen);
  add_check(arguments, chosen);
  add_tune(arguments, chosen);
  add_merge(arguments, chosen);
  add_bench(arguments, chosen);
  check_command_name(root, argc, argv);
  check_values_given(root, argc, argv);
  try {
    root.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return ShowText{root.help()};
  } catch (const CLI::CallForVersion& version) {
    return ShowText{std::string(version.what()) + "\n"};
  } catch (const CLI::ExtrasError&) {
    throw UsageError(
        fmt::format("unknown option or argument: {} {}", fmt::join(root.remaining(true), " "), more_help));
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{} {}", error.what(), more_help));
  }
  return chosen;
}

}  // namespace sundog
