#include "app/options.h"

#include <fmt/format.h>

#include <charconv>
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>

#include "base/error.h"

namespace sundog {
namespace {

constexpr int greatest_size = 65536;

std::optional<int> whole_number(std::string_view text, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high) return {};
  return value;
}

int option_number(const char* option, const std::string& text, int low, int high) {
  const std::optional<int> value = whole_number(text, low, high);
  if (!value)
    throw UsageError(fmt::format("{} {}: wanted a whole number from {} to {}", option, text, low, high));
  return *value;
}

/// "WxH", both from 1 to `high`; none when the text is anything else.
std::optional<std::pair<int, int>> size_pair(std::string_view text, int high) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return {};
  const std::optional<int> width = whole_number(text.substr(0, cross), 1, high);
  const std::optional<int> height = whole_number(text.substr(cross + 1), 1, high);
  if (!width || !height) return {};
  return std::pair(*width, *height);
}

WorkGroup parse_work_group(const std::string& text) {
  using enum WorkGroup::Kind;
  if (text == "auto") return {automatic};
  if (text == "driver") return {driver};
  constexpr int high = 65536;
  if (const auto edge = whole_number(text, 1, high)) return {fixed, static_cast<std::size_t>(*edge), 1};
  if (const auto pair = size_pair(text, high))
    return {fixed, static_cast<std::size_t>(pair->first), static_cast<std::size_t>(pair->second)};
  throw UsageError(
      fmt::format("--work-group {}: wanted a size (64), width x height (8x8), auto or driver", text));
}

double parse_tolerance(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value) || value < 0)
    throw UsageError(fmt::format("--tolerance {}: wanted a number, 0 or more", text));
  return value;
}

std::vector<std::string> devices_of_environment() {
  const char* text = std::getenv("SUNDOG_DEVICE");
  return text && *text ? CLI::detail::split(text, ',') : std::vector<std::string>();
}

void check_override(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals < 2 || setting[0] != '/')
    throw UsageError(fmt::format("--set {}: wanted JSON_POINTER=VALUE, such as /camera/fov=30", setting));
}

/// Options as typed, before they are checked.
struct Typed {
  std::string size, samples, max_depth, integrator, work_group = "auto", tile, tolerance = "0";
};

/// The options that only shorten a --set come first, so that a --set of the same value wins.
std::vector<std::string> collect_overrides(const Typed& typed, std::vector<std::string> settings) {
  std::vector<std::string> all;
  if (!typed.size.empty()) {
    const auto size = size_pair(typed.size, greatest_size);
    if (!size)
      throw UsageError(fmt::format("--size {}: wanted WIDTHxHEIGHT, each from 1 to {}, such as 640x480",
                                   typed.size, greatest_size));
    all.push_back(fmt::format("/image/width={}", size->first));
    all.push_back(fmt::format("/image/height={}", size->second));
  }
  if (!typed.samples.empty())
    all.push_back(fmt::format("/render/samples={}", option_number("--samples", typed.samples, 1, 65536)));
  if (!typed.max_depth.empty())
    all.push_back(fmt::format("/render/max_depth={}", option_number("--max-depth", typed.max_depth, 1, 64)));
  if (!typed.integrator.empty()) all.push_back(fmt::format("/render/integrator=\"{}\"", typed.integrator));
  for (std::string& setting : settings) {
    check_override(setting);
    all.push_back(std::move(setting));
  }
  return all;
}

/// A repeatable option that takes one value each time.
CLI::Option* repeatable(CLI::App* app, const std::string& name, std::vector<std::string>& values,
                        const std::string& help) {
  return app->add_option(name, values, help)
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

CLI::App* add_render(CLI::App& app, RenderCommand& render, Typed& typed) {
  CLI::App* command = app.add_subcommand("render", "Render a scene to an image file");
  command->add_option("SCENE", render.scene, "a .json scene, or a .gltf .glb .obj .ply .stl .nff model")
      ->required();
  command->add_option("-o,--out", render.out, "image file: .png, .exr, .hdr or .pfm")->required();
  repeatable(
      command, "--device", render.devices,
      "P:D, cpu, gpu, accelerator, all, part of a name, or !SPEC to take away; /N for N compute units; "
      "repeatable (default: SUNDOG_DEVICE, or the fastest)");
  command->add_option("--size", typed.size, "WIDTHxHEIGHT in pixels");
  command->add_option("--samples", typed.samples, "samples a pixel");
  command->add_option("--max-depth", typed.max_depth,
                      "greatest depth of the ray tree; 1: the camera's rays alone");
  command->add_option("--integrator", typed.integrator, "how light is followed: whitted");
  repeatable(command, "--set", render.overrides,
             "JSON_POINTER=VALUE changes the scene, as in /camera/fov=30; repeatable");
  command->add_option("--work-group", typed.work_group, "local size: N, WxH, auto or driver");
  command->add_option("--tile", typed.tile, "edge of the tiles in pixels");
  command->add_option("--stats", render.stats, "write rays, times and devices to this JSON file");
  repeatable(command, "--aov", render.aovs,
             fmt::format("an extra image in the .exr: {}; repeatable", fmt::join(aov_names(), ", ")));
  command->add_flag("--float", render.full_floats, "keep an .exr's colours as 32-bit floats (default: half)");
  command->add_option("--resume", render.resume,
                      "checkpoint file: written when interrupted, continued from when there");
  command->add_flag("-q,--quiet", render.quiet, "no progress bar and no summary");
  command->add_flag("-v,--verbose", render.verbose, "tell more: times, rays, kernels");
  return command;
}

CLI::App* add_compare(CLI::App& app, CompareCommand& compare, Typed& typed) {
  CLI::App* command = app.add_subcommand("compare", "Compare two images; exit status 6 when they differ");
  command->add_option("A", compare.a, "image file: .png, .jpg, .exr, .hdr or .pfm")->required();
  command->add_option("B", compare.b, "image file")->required();
  command->add_option("--tolerance", typed.tolerance,
                      "greatest difference that passes, in linear colour (1 = white; default 0)");
  command->add_option("--diff", compare.diff, "write a picture that shows where they differ");
  command->add_flag("--json", compare.json, "print the figures as JSON");
  return command;
}

void check_render(RenderCommand& render, const Typed& typed) {
  render.overrides = collect_overrides(typed, std::move(render.overrides));
  render.work_group = parse_work_group(typed.work_group);
  if (!typed.tile.empty()) render.tile = option_number("--tile", typed.tile, 4, greatest_size);
  if (render.devices.empty()) render.devices = devices_of_environment();
  for (const std::string& name : render.aovs)
    if (std::ranges::count(aov_names(), name) == 0)
      throw UsageError(fmt::format("--aov {}: wanted one of {}", name, fmt::join(aov_names(), ", ")));
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  CLI::App app("sundog renders scenes with OpenCL, on any device there is.", "sundog");
  app.set_version_flag("--version", "sundog " SUNDOG_VERSION);
  app.require_subcommand(1);
  RenderCommand render;
  DevicesOptions devices;
  InfoCommand info;
  CompareCommand compare;
  Typed typed;
  const CLI::App* render_app = add_render(app, render, typed);
  CLI::App* devices_app = app.add_subcommand("devices", "List every OpenCL platform and device");
  devices_app->add_flag("--json", devices.json, "as JSON");
  CLI::App* info_app =
      app.add_subcommand("info", "What a scene holds: triangles, lights, BVH figures, bytes");
  info_app->add_option("SCENE", info.scene, "a .json scene, or a model file")->required();
  info_app->add_flag("--json", info.json, "as JSON");
  const CLI::App* compare_app = add_compare(app, compare, typed);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return ShowText{app.help()};
  } catch (const CLI::CallForVersion& version) {
    return ShowText{std::string(version.what()) + "\n"};
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{} (sundog --help tells more)", error.what()));
  }
  if (render_app->parsed()) {
    check_render(render, typed);
    return render;
  }
  if (compare_app->parsed()) {
    compare.tolerance = parse_tolerance(typed.tolerance);
    return compare;
  }
  if (info_app->parsed()) return info;
  return devices;
}

}  // namespace sundog
