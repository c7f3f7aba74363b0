// See bench_options.h.
#include "app/bench/bench_options.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "app/options/commands.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/options/output_files.h"
#include "app/options/pick_devices.h"
#include "app/process/environment.h"
#include "app/process/revision.h"
#include "app/process/warnings.h"
#include "base/cache_folder.h"
#include "base/error.h"
#include "base/file.h"
#include "bench/report/machine.h"
#include "device/build_options.h"
#include "device/driver_folder.h"
#include "scene/json/override.h"
#include "scene/load.h"

namespace sundog {
namespace {

std::string& command_line() {
  static std::string text;
  return text;
}

/// As a shell takes it for one word.
std::string quoted(std::string_view word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) return std::string(word);
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

void remember_command_line(int argc, const char* const* argv) {
  std::string& text = command_line();
  text.clear();
  for (int i = 0; i < argc; ++i) {
    if (i > 0) text += ' ';
    text += quoted(argv[i]);
  }
}

const std::string& command_line_text() { return command_line(); }

void add_bench_options(Arguments* app, BenchOptions& options, bool scene_needed) {
  auto* scenes =
      value(app, "SCENE", "FILE", options.scenes, std::string(scene_help) + "; several may be given");
  if (scene_needed) scenes->required();
  values(app, "--device", "SPEC", options.devices, device_help);
  values(app, "--set", "POINTER=VALUE", options.overrides, "change the scenes, as in /camera/fov=30");
  app->add_option("--repeat", options.repeat, "runs of each measurement, in turn with the others (default 6)")
      ->type_name("N")
      ->range(1, 10000);
  value(app, "--json", "FILE", options.json, "write the measurements as JSON");
  value(app, "--csv", "FILE", options.csv, "write the measurements as CSV");
  value(app, "--continue", "FILE", options.continue_from,
        "take the runs that this JSON of an earlier run has, and measure the others");
  value(app, "--html", "FILE", options.html, "write the report as one page with plots");
  outside_files(app, options.outside_files);
  app->add_flag("-q,--quiet", options.quiet, "print nothing");
}

void add_bench_size(Arguments* app, BenchOptions& options) {
  value(app, "--size", "WxH", options.size, "width and height in pixels (default: the scene's)");
}

void show_step(const BenchOptions& options, const std::string& step) {
  if (!options.quiet && isatty(STDERR_FILENO)) fmt::print(stderr, "\r\x1b[K{}", step);
}

std::string scene_name(const std::string& file) { return std::filesystem::path(file).stem().string(); }

SceneDescription bench_description(const std::string& file, const BenchOptions& options,
                                   const std::vector<std::string>& more) {
  std::vector<std::string> overrides = more;
  if (!options.size.empty())
    for (const std::string& setting : parse_image_size(options.size)) overrides.push_back(setting);
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  return load_beside({options.json, options.csv, options.html}, [&] {
    return load_scene(file, overrides, with_streams({.outside_files = options.outside_files}));
  });
}

CompiledScene bench_scene(const std::string& file, const BenchOptions& options,
                          const std::vector<std::string>& more) {
  return compile(bench_description(file, options, more));
}

SceneDescription sized(SceneDescription scene, const BenchOptions& options) {
  if (!options.size.empty()) std::tie(scene.image.width, scene.image.height) = parse_size(options.size);
  return scene;
}

std::vector<DeviceInfo> bench_devices(const BenchOptions& options) {
  return pick_devices(list_devices(), options.devices.empty() ? devices_of_environment() : options.devices);
}

std::vector<int> parse_list(const char* option, const std::string& text, int low, int high) {
  std::vector<int> numbers;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');)
    numbers.push_back(parse_number(option, part, low, high));
  if (numbers.empty() || text.ends_with(','))
    throw UsageError(fmt::format("{} '{}': wanted numbers with commas between, such as 1,2,4", option, text));
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    if (comma > at) parts.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

void add_bench(Arguments& root, Command& chosen) {
  Arguments* bench =
      root.add_subcommand("bench", "Measure, and write tables, JSON, CSV or a page with plots");
  bench->require_subcommand(1);
  add_bench_workgroup(*bench, chosen);
  add_bench_threads(*bench, chosen);
  add_bench_rays(*bench, chosen);
  add_bench_samples(*bench, chosen);
  add_bench_quality(*bench, chosen);
  add_bench_textures(*bench, chosen);
  add_bench_devices(*bench, chosen);
  add_bench_kernels(*bench, chosen);
}

}  // namespace sundog
