// `sundog bench threads`: times frames by image size and number of threads.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/process/progress.h"
#include "app/process/warnings.h"
#include "base/clock.h"
#include "base/error.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/frame_runner.h"
#include "bench/frames/thread_budget.h"
#include "bench/plain/whitted.h"
#include "bench/report/machine.h"
#include "bench/report/report.h"
#include "bench/runs/measure.h"
#include "bench/runs/ratio.h"
#include "compile/compiled_scene.h"
#include "device/devices.h"

namespace sundog {
namespace {

std::string threads_text(unsigned threads) {
  return threads ? fmt::format("{} thread{}", threads, threads == 1 ? "" : "s") : "plain C++";
}

/// A size's scene, and the image that every number of threads must produce.
struct OneSize {
  CompiledScene scene;
  Image expected;
  unsigned first = 0;  // the number of threads that drew it; 0: none yet
};

Subject thread_subject(const ThreadScaling& plan, unsigned threads, const std::shared_ptr<OneSize>& size) {
  const auto frames = std::make_shared<std::shared_ptr<FrameRunner>>();
  Subject subject;
  subject.prepare = [=, part = plan.device]() mutable {
    if (threads > part.compute_units)
      throw DeviceError(fmt::format("the device has {} compute units", part.compute_units));
    part.sub_units = threads;
    *frames = std::make_shared<FrameRunner>(part, size->scene);
    if (size->first > 0) {
      (*frames)->run();
      return;
    }
    size->expected = confirmed_image(**frames);
    size->first = threads;
  };
  subject.run = [frames] { return (*frames)->run(); };
  subject.check = [=]() -> std::string {
    if (same_bits_of((*frames)->image(), size->expected)) return "";
    return fmt::format("its image differs from that of {}", threads_text(size->first));
  };
  return subject;
}

/// The plain program needs no warm-up and may take minutes, so its first frame counts.
Subject plain_subject(const std::shared_ptr<OneSize>& size) {
  const auto last = std::make_shared<Image>();
  Subject subject;
  subject.once = true;
  subject.prepare = [size] {
    if (const std::string refusal = plain_refusal(size->scene); !refusal.empty()) throw DeviceError(refusal);
  };
  subject.run = [size, last] {
    const Stopwatch clock;
    *last = render_plain(size->scene);
    return clock.seconds();
  };
  subject.check = [size, last]() -> std::string {
    return size->first ? plain_difference(*last, size->expected)
                       : "there is no device image to compare it with";
  };
  return subject;
}

/// Times a small frame of the scene, which also compiles its kernels into the cache. Zeros if the frame
/// cannot be drawn.
PixelCost pixel_cost(const ThreadScaling& plan) {
  constexpr int greatest_side = 64;
  const int side = std::min(greatest_side, plan.sizes.front());
  const double pixels = static_cast<double>(side) * side;
  PixelCost cost;
  if (!enter_row(plan.scene + ", a small frame").empty()) return cost;
  try {
    const CompiledScene scene = plan.compile_for(side);
    DeviceInfo part = plan.device;
    part.sub_units = plan.counts.front();
    if (part.sub_units <= part.compute_units) {
      FrameRunner frames(part, scene);
      frames.run();
      cost.device = frames.run() * std::min(part.sub_units, plan.cores) / pixels;
    }
    if (plan.plain && plain_refusal(scene).empty()) {
      const Stopwatch clock;
      render_plain(scene);
      cost.plain = clock.seconds() / pixels;
    }
  } catch (const DeviceError&) {
    return {};  // the measurement will say why
  }
  return cost;
}

/// Times a plan's sizes and counts in turn. Every image of a size must have the bits of its first; the plain
/// program's may differ by rounding only.
class ThreadTimes {
 public:
  explicit ThreadTimes(ThreadScaling plan) : plan_(std::move(plan)) {
    for (const int side : plan_.sizes) {
      const auto size = std::make_shared<OneSize>(OneSize{plan_.compile_for(side), {}, 0});
      const auto add = [&](unsigned threads, Subject subject) {
        subject.name = fmt::format("{}, {}x{}, {}", plan_.scene, side, side, threads_text(threads));
        if (threads > 0 || plan_.device.type == "cpu") subject.devices = {plan_.device};
        ways_.emplace_back(side, threads);
        subjects_.push_back(std::move(subject));
      };
      for (const unsigned count : plan_.counts) add(count, thread_subject(plan_, count, size));
      if (plan_.plain && side <= plan_.greatest_plain_size) add(0, plain_subject(size));
    }
  }

  void measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }
  /// Adds the scene's tables (times, speed-up, efficiency), curves and measurements.
  void add_to(Report& report) const {
    if (const std::string sizes = tiny_sizes(); !sizes.empty())
      report.notes.push_back(fmt::format(
          "{}, {} pixels a side: frames take less than 10 ms, of which launches and transfers are a part "
          "that no thread shortens. Do not conclude from these efficiencies; take larger --sizes.",
          plan_.scene, sizes));
    const auto time_cell = [&](int size, unsigned count) {
      const Subject* time = find(size, count);
      return time ? milliseconds(*time) : Cell();
    };
    const auto gain_cell = [&](double scale, int size, unsigned count) {
      const auto gain = speed_up(size, count);
      return gain ? Cell(scaled(*gain, scale)) : Cell();
    };
    report.parts.push_back(pivot("time of a frame", "ms", time_cell));
    report.parts.push_back(
        pivot("speed-up", "", [&](int size, unsigned count) { return gain_cell(1, size, count); }));
    report.parts.push_back(pivot("efficiency (speed-up by threads)", "", [&](int size, unsigned count) {
      return count ? gain_cell(1.0 / count, size, count) : Cell();
    }));
    if (std::ranges::any_of(subjects_, [](const Subject& subject) { return subject.joules() >= 0; }))
      report.parts.push_back(pivot("energy of a frame", "J", [&](int size, unsigned count) {
        const Subject* time = find(size, count);
        return time && time->joules() >= 0 ? Cell(time->joules()) : Cell();
      }));
    CurvePlot plot{fmt::format("{}: speed-up by threads of {}", plan_.scene, device_title(plan_.device)),
                   "threads",
                   "times as fast",
                   {},
                   true};
    for (const int size : plan_.sizes) {
      Curve curve{fmt::format("{0} × {0}", size), {}};
      for (const unsigned count : plan_.counts)
        if (const auto value = speed_up(size, count))
          curve.points.push_back({static_cast<double>(count), *value});
      if (!curve.points.empty()) plot.curves.push_back(std::move(curve));
    }
    report.parts.emplace_back(std::move(plot));
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      const auto [size, threads] = ways_[i];
      const auto gain = threads ? speed_up(size, threads) : std::nullopt;
      add_measured(report, subjects_[i],
                   {{"scene", "", plan_.scene},
                    {"device", "", threads ? device_title(plan_.device) : "plain C++"},
                    {"size", "pixels", static_cast<double>(size)},
                    {"threads", "", threads ? static_cast<double>(threads) : 1.0}},
                   {{"speed-up", "", gain ? Cell(gain->median) : Cell()}});
      if (!subjects_[i].problem.empty())
        report.notes.push_back(fmt::format("{}: {}", subjects_[i].name, subjects_[i].problem));
    }
  }

 private:
  const Subject* find(int size, unsigned threads) const {
    for (std::size_t i = 0; i < ways_.size(); ++i)
      if (ways_[i] == std::pair(size, threads) && subjects_[i].is_good()) return &subjects_[i];
    return nullptr;
  }

  /// Speed relative to one thread, with the interval of paired runs. If the least count is greater than one,
  /// its speed-up is assumed to be ideal.
  std::optional<Spread> speed_up(int size, unsigned count) const {
    const Subject *one = find(size, plan_.counts.front()), *many = find(size, count);
    if (!one || !many) return {};
    const double base = plan_.counts.front(), value = base * one->seconds().median / many->seconds().median;
    const Ratio pairs = paired_ratio(one->runs, many->runs);
    if (!pairs.is_known() || many->seconds().runs.size() < 2) return Spread{value, value, value};
    return Spread{value, std::min(value, base / pairs.high), std::max(value, base / pairs.low)};
  }

  /// Sizes whose frames are so short that their overhead matters.
  std::string tiny_sizes() const {
    constexpr double tiny = 0.01;  // seconds
    std::string sizes;
    for (const int size : plan_.sizes) {
      const auto is_tiny = [&](unsigned count) {
        const Subject* time = find(size, count);
        return time && time->seconds().median < tiny;
      };
      if (std::ranges::any_of(plan_.counts, is_tiny))
        sizes += (sizes.empty() ? "" : ", ") + std::to_string(size);
    }
    return sizes;
  }

  /// A table with a row for each size and a column for each count, filled by `cell`.
  Table pivot(const std::string& title, const std::string& unit,
              const std::function<Cell(int, unsigned)>& cell) const {
    Table table{fmt::format("{}: {} on {}", plan_.scene, title, device_title(plan_.device)),
                {{"pixels a side", ""}},
                {}};
    for (const int size : plan_.sizes) {
      std::vector<Field> row{{"pixels a side", "", static_cast<double>(size)}};
      if (plan_.plain) row.push_back({threads_text(0), unit, cell(size, 0)});
      for (const unsigned count : plan_.counts) row.push_back({threads_text(count), unit, cell(size, count)});
      add_row(table, row);
    }
    return table;
  }

  ThreadScaling plan_;
  std::vector<std::pair<int, unsigned>> ways_;  // side and threads of each subject; 0 threads: plain C++
  std::vector<Subject> subjects_;
};

struct ThreadsOptions : BenchOptions {
  std::string sizes, counts;  // empty: the defaults
  double budget = -1;         // seconds; 0: no limit; below 0: not given
  bool no_plain = false;
};

/// Gives PoCL `most` compute units if the machine has fewer cores. Must run before the first OpenCL call.
void allow_threads(int most) {
  if (most > static_cast<int>(std::thread::hardware_concurrency()))
    setenv("POCL_MAX_PTHREAD_COUNT", std::to_string(most).c_str(), 0);
}

/// The device that the options select, or the fastest that supports sub-devices. Throws UsageError,
/// DeviceError.
DeviceInfo device_to_split(const BenchOptions& options) {
  const bool asked = !options.devices.empty() || !devices_of_environment().empty();
  std::vector<DeviceInfo> devices;
  if (asked) {
    devices = bench_devices(options);
  } else {
    for (const DeviceInfo& row : list_devices())
      if (row.usable() && row.max_sub_devices > 0) devices.push_back(row);
    if (devices.empty())
      throw DeviceError(
          "no device here can be split into sub-devices (PoCL's can: Debian's pocl-opencl-icd)");
    devices = {*std::ranges::max_element(devices, {}, &DeviceInfo::estimate)};
  }
  if (devices.size() > 1)
    throw UsageError(fmt::format("bench threads takes one device, but --device matches {}: {} and {}",
                                 devices.size(), devices[0].label(), devices[1].label()));
  if (devices[0].max_sub_devices == 0)
    throw DeviceError(
        fmt::format("{} cannot be split into sub-devices: choose another --device", devices[0].label()));
  return devices[0];
}

/// Powers of two up to the number of cores, at least one and two.
std::vector<unsigned> usual_counts() {
  std::vector<unsigned> counts{1, 2};
  while (2 * counts.back() <= std::thread::hardware_concurrency()) counts.push_back(2 * counts.back());
  return counts;
}

std::vector<unsigned> counts_of(const ThreadsOptions& options) {
  if (options.counts.empty()) return usual_counts();
  const std::vector<int> counts = parse_list("--counts", options.counts, 1, 4096);
  return {counts.begin(), counts.end()};
}

/// One plan for each scene, cut down to the budget. Notes in the report list the omissions.
std::vector<ThreadScaling> make_plans(const ThreadsOptions& options, const ThreadScaling& usual,
                                      BenchRun& run) {
  std::vector<ThreadScaling> plans;
  for (const std::string& file : options.scenes) {
    ThreadScaling plan = usual;
    plan.scene = scene_name(options, file);
    plan.compile_for = [&run, &options, file](int size) {
      const std::vector<std::string> more{fmt::format("/image/width={}", size),
                                          fmt::format("/image/height={}", size)};
      auto scene = bench_scene(file, options, more);
      run.add_scene(file, scene, more);
      return scene;
    };
    show_step(options, plan.scene + ", a small frame for the estimate");
    plan.cost = pixel_cost(plan);
    enter_row("");
    // Without --budget, all sizes that the user names are measured.
    const double budget = options.budget >= 0 ? options.budget : options.sizes.empty() ? 100.0 : 0.0;
    if (budget > 0) {
      const auto left_out = fit_into(plan, budget / static_cast<double>(options.scenes.size()));
      if (!left_out.empty())
        run.head().notes.push_back(
            fmt::format("{}: left out to take about {} in all: {} (--budget SECONDS, or --sizes).",
                        plan.scene, duration_text(budget), fmt::join(left_out, ", ")));
    }
    plans.push_back(std::move(plan));
  }
  return plans;
}

/// Prints the estimated time and the omissions.
void announce(const ThreadsOptions& options, const std::vector<ThreadScaling>& plans, const Report& report) {
  double seconds = 0, plain = 0;
  for (const ThreadScaling& plan : plans) {
    seconds += expected_seconds(plan);
    for (const int size : plan.sizes) plain += plain_seconds(plan, size);
  }
  if (options.quiet) return;
  if (stderr_is_terminal()) tell("\r\033[K");
  tell(fmt::format(
      "sundog: this will take about {}{}\n", duration_text(seconds),
      plain >= 1 ? fmt::format(", {} of it in plain C++ (--no-plain)", duration_text(plain)) : ""));
  for (const std::string& note : report.notes)
    if (note.find(": left out to take") != std::string::npos) tell(fmt::format("sundog: {}\n", note));
}

int bench_threads(const ThreadsOptions& options) {
  BenchRun run("threads", "Times by image size and number of threads", options);
  Report& head = run.head();
  ThreadScaling plan;
  if (!options.sizes.empty()) plan.sizes = parse_list("--sizes", options.sizes, 1, 65536);
  plan.counts = counts_of(options);
  plan.repeat = options.repeat;
  plan.plain = !options.no_plain;
  plan.cores = std::max(1u, std::thread::hardware_concurrency());
  allow_threads(static_cast<int>(plan.counts.back()));
  plan.device = device_to_split(options);
  run.add_devices({plan.device});
  if (plan.plain) head.facts.emplace_back("plain C++", compiler_text() + ", one thread");
  const std::vector<ThreadScaling> plans = make_plans(options, plan, run);
  announce(options, plans, head);
  head.notes.emplace_back(
      "Medians of frames after two to warm up, sizes and counts in turn, from the first launch "
      "until the film is on the host, without building kernels. Threads are compute units of a "
      "sub-device. All images of a size are the same to the bit.");
  if (plan.plain)
    head.notes.push_back(
        "Plain C++ is the same integrator written as an ordinary program: recursion, scalar floats, the same "
        "BVH, none of the kernels' code. It draws one frame of each size, which is the device's image but "
        "for rounding. Speed-ups are over one thread of the device.");
  for (const ThreadScaling& each : plans) run.measure(std::make_shared<ThreadTimes>(each), 0, each.repeat);
  return run.publish();
}

}  // namespace

void add_bench_threads(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<ThreadsOptions>();
  Arguments* app = add_bench_command(bench, chosen, "threads",
                                     "Times by image size and number of threads, speed-up, efficiency",
                                     options, bench_threads);
  value(app, "--sizes", "N,N...", options->sizes, "pixels a side (default 128,256,352,448,512,640)");
  value(app, "--counts", "N,N...", options->counts,
        "threads (default: powers of two up to the machine's cores)");
  value(app, "--budget", "SECONDS", options->budget,
        "about how long it may take: larger sizes of plain C++, frames, then larger images are left out "
        "(default 100, or no limit with --sizes)")
      ->range(0, 1e6);
  app->add_flag("--no-plain", options->no_plain, "without the column of plain single-threaded C++");
}

}  // namespace sundog
