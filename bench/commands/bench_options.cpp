// Loads and compiles a bench's scenes with its overrides, and writes its reports.
#include "bench/commands/bench_options.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ranges>
#include <sstream>

#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/process/environment.h"
#include "app/process/standard_streams.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "device/build_options.h"

namespace sundog {
namespace {

std::vector<std::string>& command_line() {
  static std::vector<std::string> words;
  return words;
}

void write_json(const std::string& file, const nlohmann::json& json) {
  if (file.empty()) return;
  write_output(file, json_text(json, 2) + "\n", program_environment()->faults);
}

}  // namespace

void remember_command_line(int argc, const char* const* argv) { command_line().assign(argv, argv + argc); }

std::vector<std::string> command_line_words() { return {command_line().begin() + 1, command_line().end()}; }

std::string command_line_text() {
  std::string text;
  for (const std::string& word : command_line()) text += (text.empty() ? "" : " ") + shell_word(word);
  return text;
}

void add_bench_options(Arguments* app, BenchOptions& options, bool scene_needed) {
  auto* scenes =
      value(app, "SCENE", "FILE", options.scenes, std::string(scene_help) + "; several may be given");
  if (scene_needed) scenes->required();
  values(app, "--device", "SPEC", options.devices, device_help);
  values(app, "--set", "POINTER=VALUE", options.overrides, "change the scenes, as in /camera/fov=30");
  value(app, "--repeat", "N", options.repeat,
        fmt::format("runs of each measurement, in turn with the others (default {})", options.repeat))
      ->range(1, 10000);
  value(app, "--seconds", "S", options.seconds, "further runs until those of each measurement took so long")
      ->range(0, 1e6);
  value(app, "--precision", "P%", options.precision,
        "further runs, at most 1000, until the median is known to P per cent: half of its interval");
  value(app, "--continue", "FILE", options.continue_from,
        "take the runs that this JSON of an earlier run has, and measure the others");
  outside_files(app, options.outside_files);
  add_report_options(app, options);
}

void add_report_options(Arguments* app, ReportFiles& files) {
  value(app, "--json", "FILE", files.json, "write the measurements as JSON");
  value(app, "--csv", "FILE", files.csv, "write the measurements as CSV");
  value(app, "--html", "FILE", files.html, "write the report as one page with plots");
  value(app, "--latex", "FILE", files.latex, "write the tables for LaTeX with booktabs");
  value(app, "--svg", "FILE.svg", files.svg,
        "write the plots for a paper's column: the first to FILE.svg, then FILE-2.svg, ...");
  value(app, "--t4", "FILE", files.t4, "write the measurements as JSON in the T4 format of tuners");
  app->add_flag("-q,--quiet", files.quiet, "print nothing");
}

void check_report_files(const ReportFiles& files, const std::vector<std::string>& inputs) {
  check_output_files(files.all(), inputs);
  if (!files.svg.empty() && std::filesystem::path(files.svg).extension() != ".svg")
    throw UsageError(fmt::format("--svg {}: wanted a file name that ends in .svg", files.svg));
  for (const std::string& file : files.all())
    if (is_standard_stream(file))
      claim_standard_output();
    else if (!file.empty())
      check_writable(file);
}

void write_report(const Report& report, const ReportFiles& files) {
  write_json(files.json, report_json(report));
  if (!files.t4.empty()) write_json(files.t4, report_t4(report));
  if (!files.latex.empty()) write_output(files.latex, report_latex(report));
  if (!files.svg.empty()) {
    const std::filesystem::path file(files.svg);
    const std::vector<std::string> plots = report_svgs(report);
    for (std::size_t i = 0; i < plots.size(); ++i) {
      const std::string name = fmt::format("{}-{}{}", file.stem().string(), i + 1, file.extension().string());
      write_file(i == 0 ? file : file.parent_path() / name, plots[i]);
    }
  }
  if (!files.csv.empty()) write_output(files.csv, report_csv(report));
  if (!files.html.empty()) write_output(files.html, report_html(report));
  if (!files.quiet) fmt::print("{}", report_text(report));
}

void add_bench_size(Arguments* app, BenchOptions& options) {
  value(app, "--size", "WxH", options.size, "width and height in pixels (default: the scene's)");
}

void show_step(const BenchOptions& options, const std::string& step) {
  if (!options.quiet && isatty(STDERR_FILENO)) fmt::print(stderr, "\r\x1b[K{}", step);
}

std::string scene_name(const BenchOptions& options, const std::string& file) {
  const auto stem = [](const std::string& name) { return std::filesystem::path(name).stem().string(); };
  const bool shared = std::ranges::any_of(
      options.scenes, [&](const auto& other) { return other != file && stem(other) == stem(file); });
  return shared ? file : stem(file);
}

SceneDescription bench_description(const std::string& file, const BenchOptions& options,
                                   const std::vector<std::string>& more) {
  std::vector<std::string> overrides = more;
  if (!options.size.empty())
    for (const std::string& setting : parse_image_size(options.size)) overrides.push_back(setting);
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  return load_for_command(file, overrides, {.outside_files = options.outside_files}, options.all());
}

CompiledScene bench_scene(const std::string& file, const BenchOptions& options,
                          const std::vector<std::string>& more) {
  return compile(bench_description(file, options, more));
}

std::vector<DeviceInfo> bench_devices(const BenchOptions& options) { return pick_devices(options.devices); }

std::vector<DeviceInfo> unusable_bench_devices(const BenchOptions& options) {
  return unusable_devices(list_devices(),
                          options.devices.empty() ? devices_of_environment() : options.devices);
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
  for (const auto part : std::views::split(text, ','))
    if (!part.empty()) parts.emplace_back(part.begin(), part.end());
  return parts;
}

void add_bench(Arguments& root, Command& chosen) {
  Arguments* bench =
      root.add_subcommand("bench", "Measure, and write tables, JSON, CSV or a page with plots");
  bench->require_subcommand(1);
#define SUNDOG_BENCH(name) add_bench_##name(*bench, chosen);
  SUNDOG_BENCHES(SUNDOG_BENCH)
#undef SUNDOG_BENCH
}

}  // namespace sundog
