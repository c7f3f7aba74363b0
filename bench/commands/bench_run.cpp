// Collects facts and parts, writes the report while it grows, and ends with the exit status.
#include "bench/commands/bench_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "app/options/option_values.h"
#include "app/process/environment.h"
#include "app/process/exit_status.h"
#include "app/process/revision.h"
#include "app/process/standard_streams.h"
#include "app/process/variables.h"
#include "app/process/warnings.h"
#include "base/cache_folder.h"
#include "base/error.h"
#include "base/file.h"
#include "bench/commands/known_report.h"
#include "bench/report/machine.h"
#include "device/driver_folder.h"
#include "device/energy.h"
#include "render/film/hash.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

constexpr double between_keeps = 1;    // seconds
constexpr double most_of_time = 0.05;  // that keep() may take

/// The report's notes on its intervals and on disturbed runs.
std::vector<std::string> notes_on_runs(const Report& report, double limit, double precision) {
  std::size_t timed = 0, wide = 0, left_out = 0, slow = 0, least = 0, most = 0;
  std::vector<std::string> noisy;
  for (const MeasuredWay& way : report.ways) {
    timed += way.is_good();
    if (const std::size_t runs = way.seconds().runs.size(); way.is_good() && !way.once) {
      least = most ? std::min(least, runs) : runs;
      most = std::max(most, runs);
    }
    wide += precision > 0 && way.is_good() && !way.once && !is_precise(way, precision);
    if (way.noisy && way.is_good()) noisy.push_back(way.name);
    left_out += static_cast<std::size_t>(std::ranges::count(way.runs, std::string("busy"), &Run::left_out));
    slow += static_cast<std::size_t>(std::ranges::count(way.runs, std::string("slow clock"), &Run::left_out));
  }
  std::vector<std::string> notes;
  if (timed == 0) return notes;
  if (most == 0) least = most = 1;
  notes.push_back(fmt::format(
      "Each row has {} run{}. [low, high] behind a figure: the median lies between them with 95 % "
      "confidence, by order statistics; where there are fewer than six runs, they are the range, and one "
      "run has none.",
      least == most ? std::to_string(least) : fmt::format("{} to {}", least, most), most == 1 ? "" : "s"));
  if (wide > 0)
    notes.push_back(
        fmt::format("--precision {:.3g}% not reached: {} of {} rows. A row ends when as many runs were "
                    "disturbed as count, with 1000 runs, or when the time is over.",
                    100 * precision, wide, timed));
  if (left_out > 0)
    notes.push_back(fmt::format(
        "{} run{} left out and measured again, because other programs had more than {:.2g} cores meanwhile, "
        "or because a run had fewer cores than the others of its row.",
        left_out, left_out == 1 ? " was" : "s were", limit));
  if (slow > 0)
    notes.push_back(fmt::format(
        "{} run{} left out and measured again, because the clock was lower than in others of their row.",
        slow, slow == 1 ? " was" : "s were"));
  if (!noisy.empty())
    notes.push_back(fmt::format(
        "Not measured quietly: {} of {} rows. Other programs used the machine in too many runs; these rows "
        "count the least disturbed ones: {}{}.",
        noisy.size(), timed,
        fmt::join(noisy.begin(), noisy.begin() + std::min<std::ptrdiff_t>(3, std::ssize(noisy)), "; "),
        noisy.size() > 3 ? "; ..." : ""));
  return notes;
}

/// "2%" or "2": 0.02.
double precision_of(std::string text) {
  if (text.ends_with('%')) text.pop_back();
  return 0.01 * parse_real("--precision", text, 0.01, 100);
}

}  // namespace

BenchRun::BenchRun(const std::string& name, const std::string& title, const BenchOptions& options)
    : options_(options),
      load_(std::make_shared<LoadMeter>(std::thread::hardware_concurrency())),
      progress_(std::make_unique<BenchProgress>(!options.quiet, 0)) {
  check_report_files(options, options.scenes);
  for (const std::string& setting : options.overrides) check_override(setting);
  if (!options.precision.empty()) precision_of(options.precision);
  head_.name = name;
  head_.title = title;
  head_.complete = false;
  head_.facts = machine_facts();
  head_.facts.insert(head_.facts.begin(), {{"sundog", SUNDOG_VERSION},
                                           {"revision", build_revision()},
                                           {"compiler", compiler_text()},
                                           {"command", command_line_text()}});
  head_.environment = driver_variables();
  if (!options.continue_from.empty()) {
    take_known(options.continue_from);
    head_.facts.emplace_back("continues", options.continue_from);
  }
  std::error_code none;
  if (const fs::path kept = kept_for_next(); fs::exists(kept, none)) {
    const Table devices = known_devices_, scenes = known_scenes_;
    take_known(kept.string());
    known_devices_ = devices, known_scenes_ = scenes;  // checks only --continue's
  }
  if (const std::string why = cache_refusal(program_environment()->cache); !why.empty())
    head_.notes.push_back(why);
}

void BenchRun::take_known(const std::string& file) {
  KnownReport known = read_report(file);
  if (known.bench != head_.name)
    throw UsageError(fmt::format("--continue {}: it is of bench {}", file, known.bench));
  if (known.revision != build_revision())
    throw UsageError(fmt::format("--continue {}: revision {} has measured it, this is {}: measure anew", file,
                                 known.revision, build_revision()));
  known_devices_ = std::move(known.devices);
  known_scenes_ = std::move(known.scenes);
  for (MeasuredWay& way : known.ways)
    if (way.problem.empty()) known_[way.name] = std::move(way);
}

void BenchRun::add_devices(const std::vector<DeviceInfo>& devices) {
  for (const DeviceInfo& device : devices) {
    head_.facts.emplace_back("device", device_fact(device));
    head_.facts.emplace_back(
        "energy", fmt::format("{}: {}", device_place(device), EnergyMeter(std::array{device}).source()));
    add_device_row(head_.devices, device);
    check_known(known_devices_, head_.devices, {"label"}, options_.continue_from);
  }
  if (std::ranges::any_of(devices, is_pocl))
    head_.facts.emplace_back("PoCL", pocl_fact(*program_environment()));
}

std::vector<DeviceInfo> BenchRun::devices() {
  std::vector<DeviceInfo> all = bench_devices(options_);
  add_devices(all);
  return all;
}

void BenchRun::add_scene(const std::string& file, const CompiledScene& scene,
                         const std::vector<std::string>& more) {
  add_row(head_.scenes, {{"name", "", scene_name(options_, file)},
                         {"file", "", file},
                         {"settings", "", fmt::format("{}", fmt::join(more, " "))},
                         {"width", "pixels", static_cast<double>(scene.info.width)},
                         {"height", "pixels", static_cast<double>(scene.info.height)},
                         {"samples", "", static_cast<double>(scene.info.samples)},
                         {"seed", "", static_cast<double>(scene.info.seed)},
                         {"integrator", "", scene.integrator},
                         {"max depth", "", static_cast<double>(scene.info.max_depth)},
                         {"hash", "", fmt::format("{:016x}", hash_scene(scene))}});
  check_known(known_scenes_, head_.scenes, {"name", "settings"}, options_.continue_from);
}

std::shared_ptr<const CompiledScene> BenchRun::compiled(const std::string& file,
                                                        const std::vector<std::string>& more) {
  auto scene = std::make_shared<const CompiledScene>(bench_scene(file, options_, more));
  add_scene(file, *scene, more);
  return scene;
}

MeasureOptions BenchRun::measuring(double budget, int repeat) {
  progress_ = std::make_unique<BenchProgress>(!options_.quiet, 0);
  MeasureOptions measuring;
  measuring.repeat = repeat < 0 ? options_.repeat : repeat;
  measuring.seconds = options_.seconds;
  if (!options_.precision.empty()) measuring.precision = precision_of(options_.precision);
  measuring.budget = budget;
  measuring.stop = &stop_.flag();
  measuring.known = known_;
  measuring.load = load_;
  measuring.enter_row = enter_row;
  measuring.on_step = [this](const std::string& step, double done) { progress_->update(step, done); };
  measuring.on_runs = [this] {
    if (since_kept_.seconds() > std::max(between_keeps, keeping_ / most_of_time)) keep();
  };
  return measuring;
}

Report BenchRun::so_far() const {
  Report report = head_;
  report.notes.clear();
  for (const auto& part : parts_) part(report);
  report.notes.insert(report.notes.end(), head_.notes.begin(), head_.notes.end());
  const double precision = options_.precision.empty() ? 0 : precision_of(options_.precision);
  for (std::string& note : notes_on_runs(report, load_->limit(), precision))
    report.notes.push_back(std::move(note));
  report.facts.emplace_back("load after", load_text());
  report.facts.emplace_back("clock after", clock_text());
  return report;
}

void BenchRun::keep() {
  const Stopwatch clock;
  ReportFiles files;
  files.json = options_.json;
  files.quiet = true;
  if (!files.json.empty() && !is_standard_stream(files.json) && !is_pipe_or_device(files.json))
    write_report(so_far(), files);
  files.json = kept_for_next().string();
  try {
    if (!files.json.empty()) write_report(so_far(), files);
  } catch (const IoError&) {  // disk full: the next child measures again
  }
  keeping_ = clock.seconds();
  since_kept_ = {};
}

int BenchRun::publish(bool all_right) {
  progress_->erase();
  Report report = so_far();
  report.complete = !is_stopped();
  if (is_stopped()) report.notes.insert(report.notes.begin(), "Interrupted: some of it was not measured.");
  write_report(report, options_);
  if (is_stopped()) {
    tell(fmt::format("sundog: interrupted: {}\n",
                     options_.json.empty() ? "the report has what was measured until then"
                                           : fmt::format("--continue {} measures the rest", options_.json)));
    return exit_interrupted;
  }
  for (const MeasuredWay& way : report.ways)
    if (all_right && !way.problem.empty() && !way.failure) throw DeviceError(way.problem);
  const auto failed = [](const MeasuredWay& way) { return !way.problem.empty(); };
  if (!report.ways.empty() && std::ranges::all_of(report.ways, failed)) {
    const MeasuredWay& first = report.ways.front();
    if (first.failure) std::rethrow_exception(first.failure);
    throw DeviceError(first.problem);
  }
  return exit_done;
}

}  // namespace sundog
