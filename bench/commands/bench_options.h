// Options, scenes and report files of all `sundog bench` commands.
//
// To add a benchmark, write `void add_bench_NAME(Arguments& bench, Command& chosen)` in a file of its own,
// which calls add_bench_command() (bench_run.h), and list NAME in SUNDOG_BENCHES. It measures parts with a
// BenchRun, each with measure() and add_to(Report&), and ends with publish().
#pragma once
#include "app/options/command.h"
#include "app/options/options.h"
#include "bench/report/report.h"
#include "compile/compiled_scene.h"

namespace sundog {

/// The files that a report is written to; empty: none.
struct ReportFiles {
  std::string json, csv, html, latex, svg, t4;
  bool quiet = false;

  std::vector<std::string> all() const { return {json, csv, html, latex, svg, t4}; }
};

struct BenchOptions : ReportFiles {
  std::vector<std::string> scenes, devices, overrides;
  std::string continue_from;  // a report whose runs count too; empty: none
  std::string size;           // "WxH" of the images; empty: the scenes' own
  int repeat = 6;
  double seconds = 0;          // see MeasureOptions
  std::string precision;       // "2%"
  bool outside_files = false;  // --allow-outside-files
};

/// Adds --json --csv --html --latex --svg --t4 --quiet.
void add_report_options(Arguments* app, ReportFiles& files);

/// Throws UsageError or IoError if a file cannot be written or is one of `inputs`. If one is "-", everything
/// else that is printed to stdout goes to stderr from now on.
void check_report_files(const ReportFiles& files, const std::vector<std::string>& inputs);

/// Writes the files and prints the report.
void write_report(const Report& report, const ReportFiles& files);

/// Adds SCENE..., --device, --set, --repeat and the like, and add_report_options(). SCENE is optional unless
/// `scene_needed`.
void add_bench_options(Arguments* app, BenchOptions& options, bool scene_needed);

/// Adds --size, for benchmarks that render frames of one size.
void add_bench_size(Arguments* app, BenchOptions& options);

/// Shows the current step on stderr if that is a terminal.
void show_step(const BenchOptions& options, const std::string& step);

/// A scene's name in reports: its file name without folder and extension, or the whole path if another of the
/// options' scenes has the same name.
std::string scene_name(const BenchOptions& options, const std::string& file);

/// Loads and compiles with the options' overrides and `more`.
CompiledScene bench_scene(const std::string& file, const BenchOptions& options,
                          const std::vector<std::string>& more = {});

/// Loads with the options' overrides and `more`, without compiling.
SceneDescription bench_description(const std::string& file, const BenchOptions& options,
                                   const std::vector<std::string>& more = {});

/// The devices that the options select.
std::vector<DeviceInfo> bench_devices(const BenchOptions& options);
/// The platforms and devices that the options select but that cannot be used: opening one throws its
/// DeviceError.
std::vector<DeviceInfo> unusable_bench_devices(const BenchOptions& options);

/// Stores the command line for the two functions below.
void remember_command_line(int argc, const char* const* argv);
/// The command line without the program's name.
std::vector<std::string> command_line_words();
/// The command line, quoted for a shell.
std::string command_line_text();

/// "1,2,4": whole numbers within [low, high], sorted and without duplicates. Throws UsageError.
std::vector<int> parse_list(const char* option, const std::string& text, int low, int high);

/// "a,b" -> a, b.
std::vector<std::string> split_names(const std::string& text);

/// X(name) for each bench, in the order of the help text.
#define SUNDOG_BENCHES(X) \
  X(workgroup)            \
  X(threads)              \
  X(rays)                 \
  X(samples)              \
  X(quality)              \
  X(textures)             \
  X(devices)              \
  X(kernels)              \
  X(roofline)             \
  X(compare)

#define SUNDOG_BENCH(name) AddCommand add_bench_##name;
SUNDOG_BENCHES(SUNDOG_BENCH)
#undef SUNDOG_BENCH

}  // namespace sundog
