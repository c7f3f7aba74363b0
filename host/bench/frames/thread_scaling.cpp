// See thread_scaling.h.
#include "bench/frames/thread_scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/clock.h"
#include "base/error.h"
#include "bench/frames/frame_runner.h"
#include "bench/frames/thread_budget.h"
#include "bench/plain/whitted.h"

namespace sundog {
namespace {

/// One count at work on one size.
struct ThreadRunner {
  ThreadTime result;
  std::function<double()> run;  // a frame's seconds; empty: there is a problem
  std::function<Image()> image;
  std::vector<double> seconds, cores;

  bool is_plain() const { return result.threads == 0; }
  std::string name() const {
    if (is_plain()) return "plain C++";
    return fmt::format("{} thread{}", result.threads, result.threads == 1 ? "" : "s");
  }
  void warm_up(const DeviceInfo& whole, const CompiledScene& scene) {
    try {
      is_plain() ? prepare_plain(scene) : prepare(whole, scene);
      if (!run) return;
      // Plain C++ compiles nothing and may take minutes: its first frame is the one that counts.
      is_plain() ? time() : void(run());
    } catch (const DeviceError& error) {
      fail(error.what());
    }
  }
  void prepare(DeviceInfo part, const CompiledScene& scene) {
    if (result.threads > part.compute_units)
      return fail(fmt::format("the device has {} compute units", part.compute_units));
    part.sub_units = result.threads;
    const auto frames = std::make_shared<FrameRunner>(part, scene);
    frames->run();
    run = [frames] { return frames->run(); };
    image = [frames] { return frames->image(); };
  }
  void prepare_plain(const CompiledScene& scene) {
    if (const std::string refusal = plain_refusal(scene); !refusal.empty()) return fail(refusal);
    const auto last = std::make_shared<Image>();
    run = [last, &scene] {
      const Stopwatch clock;
      *last = render_plain(scene);
      return clock.seconds();
    };
    image = [last] { return *last; };
  }
  void time() {
    const Stopwatch clock;
    const double processor = processor_seconds();
    seconds.push_back(run());
    cores.push_back((processor_seconds() - processor) / clock.seconds());
  }
  void fail(const std::string& why) {
    result.problem = why;
    run = nullptr;
  }
};

/// The image of the first count that works is what all must show.
void check_images(std::vector<ThreadRunner>& runners) {
  const ThreadRunner* first = nullptr;
  Image expected;
  for (ThreadRunner& runner : runners) {
    if (!runner.run || runner.is_plain()) continue;
    const Image image = runner.image();
    if (!first) {
      first = &runner;
      expected = image;
    } else if (image.data != expected.data) {
      runner.fail(fmt::format("its image differs from that of {} threads", first->result.threads));
    }
  }
  for (ThreadRunner& runner : runners) {
    if (!runner.run || !runner.is_plain()) continue;
    const std::string why =
        first ? plain_difference(runner.image(), expected) : "there is no device image to compare it with";
    if (!why.empty()) runner.fail(why);
  }
}

const ThreadTime* find(const std::vector<ThreadTime>& times, int size, unsigned threads) {
  for (const ThreadTime& time : times)
    if (time.size == size && time.threads == threads && time.problem.empty()) return &time;
  return nullptr;
}

double milliseconds(double seconds) { return 1e3 * seconds; }

/// How many times as fast as one thread; where the least count is greater, that one counts as ideal.
std::optional<Spread> speed_up(const std::vector<ThreadTime>& times, const ThreadScaling& plan, int size,
                               unsigned count) {
  const ThreadTime *one = find(times, size, plan.counts.front()), *many = find(times, size, count);
  if (!one || !many) return {};
  const double base = plan.counts.front();
  return Spread{base * one->seconds.median / many->seconds.median,
                base * one->seconds.median / many->seconds.max,
                base * one->seconds.median / many->seconds.min};
}

/// A row a size and a column a count, of what `cell` makes of them.
Table pivot(const std::string& title, const std::string& unit, const ThreadScaling& plan,
            const std::function<Cell(int, unsigned)>& cell) {
  Table table{title, {{"pixels a side", ""}}, {}};
  if (plan.plain) table.columns.push_back({"plain C++", unit});
  for (const unsigned count : plan.counts)
    table.columns.push_back({fmt::format("{} thread{}", count, count == 1 ? "" : "s"), unit});
  for (const int size : plan.sizes) {
    std::vector<Cell> row{static_cast<double>(size)};
    if (plan.plain) row.push_back(cell(size, 0));
    for (const unsigned count : plan.counts) row.push_back(cell(size, count));
    table.rows.push_back(std::move(row));
  }
  return table;
}

CurvePlot speed_up_curves(const ThreadScaling& plan, const std::vector<ThreadTime>& times) {
  CurvePlot plot{plan.scene + ": speed-up by threads", "threads", "times as fast", {}, true};
  for (const int size : plan.sizes) {
    Curve curve{fmt::format("{0} × {0}", size), {}};
    for (const unsigned count : plan.counts)
      if (const auto value = speed_up(times, plan, size, count))
        curve.points.push_back({static_cast<double>(count), *value});
    if (!curve.points.empty()) plot.curves.push_back(std::move(curve));
  }
  return plot;
}

void add_measurements(Table& table, const ThreadScaling& plan, const std::vector<ThreadTime>& times) {
  if (table.columns.empty())
    table.columns = {{"scene", ""}, {"device", ""},   {"size", "pixels"}, {"threads", ""}, {"time", "ms"},
                     {"runs", ""},  {"speed-up", ""}, {"cores used", ""}, {"problem", ""}};
  for (const ThreadTime& time : times) {
    const bool is_plain = time.threads == 0;
    std::vector<Cell> row{plan.scene, is_plain ? "plain C++" : plan.device.label(),
                          static_cast<double>(time.size), is_plain ? 1.0 : time.threads};
    if (!time.problem.empty()) {
      row.resize(table.columns.size());
    } else {
      row.insert(row.end(), {scaled(time.seconds, 1e3), static_cast<double>(time.seconds.runs.size())});
      const auto gain = speed_up(times, plan, time.size, time.threads);
      row.push_back(gain ? Cell(gain->median) : Cell());
      row.insert(row.end(), {time.cores, Cell()});
    }
    if (!time.problem.empty()) row.back() = time.problem;
    table.rows.push_back(std::move(row));
  }
}

}  // namespace

PixelCost pixel_cost(const ThreadScaling& plan) {
  constexpr int greatest_side = 64;
  const int side = std::min(greatest_side, plan.sizes.front());
  const double pixels = static_cast<double>(side) * side;
  PixelCost cost;
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

std::vector<ThreadTime> measure_threads(const ThreadScaling& plan, const OnPart& on_part) {
  const double expected = expected_seconds(plan);
  double done = 0;
  const auto tell = [&](int size, const std::string& what) {
    on_part(fmt::format("{}, {}x{}, {}", plan.scene, size, size, what), expected > 0 ? done / expected : 0);
  };
  std::vector<ThreadTime> times;
  for (const int size : plan.sizes) {
    const CompiledScene scene = plan.compile_for(size);
    std::vector<unsigned> counts = plan.counts;
    if (plan.plain && size <= plan.greatest_plain_size) counts.insert(counts.begin(), 0);
    std::vector<ThreadRunner> runners(counts.size());
    for (std::size_t i = 0; i < runners.size(); ++i) {
      runners[i].result.size = size;
      runners[i].result.threads = counts[i];
      tell(size, runners[i].name());
      runners[i].warm_up(plan.device, scene);
      done += counts[i] ? 2 * frame_seconds(plan, size, counts[i]) : plain_seconds(plan, size);
    }
    check_images(runners);
    for (int i = 0; i < plan.repeat; ++i)
      for (ThreadRunner& runner : runners) {
        if (!runner.run || runner.is_plain()) continue;
        tell(size, runner.name());
        runner.time();
        done += frame_seconds(plan, size, runner.result.threads);
      }
    for (ThreadRunner& runner : runners) {
      runner.result.seconds = spread(runner.seconds);
      runner.result.cores = spread(runner.cores).median;
      times.push_back(runner.result);
    }
  }
  return times;
}

void add_thread_tables(Report& report, const ThreadScaling& plan, const std::vector<ThreadTime>& times) {
  const auto time_cell = [&](int size, unsigned count) -> Cell {
    const ThreadTime* time = find(times, size, count);
    return time ? Cell(milliseconds(time->seconds.median)) : Cell();
  };
  const auto gain_cell = [&](double scale, int size, unsigned count) -> Cell {
    const auto gain = speed_up(times, plan, size, count);
    return gain ? Cell(gain->median * scale) : Cell();
  };
  report.parts.push_back(pivot(plan.scene + ": time of a frame", "ms", plan, time_cell));
  report.parts.push_back(pivot(plan.scene + ": speed-up", "", plan,
                               [&](int size, unsigned count) { return gain_cell(1, size, count); }));
  report.parts.push_back(
      pivot(plan.scene + ": efficiency (speed-up by threads)", "", plan,
            [&](int size, unsigned count) { return count ? gain_cell(1.0 / count, size, count) : Cell(); }));
  report.parts.push_back(speed_up_curves(plan, times));
  add_measurements(report.measurements, plan, times);
}

}  // namespace sundog
