// See thread_scaling.h.
#include "bench/frames/thread_scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/clock.h"
#include "base/error.h"
#include "bench/frames/frame_runner.h"
#include "bench/plain/whitted.h"
#include "bench/runs/ratio.h"

namespace sundog {
namespace {

std::string threads_text(unsigned threads) {
  return threads ? fmt::format("{} thread{}", threads, threads == 1 ? "" : "s") : "plain C++";
}

/// A size's scene and the image that all counts must show.
struct OneSize {
  CompiledScene scene;
  Image expected;
  unsigned first = 0;  // the count that drew it
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

/// Compiles nothing and may take minutes: its first frame is the one that counts.
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

ThreadTimes::ThreadTimes(ThreadScaling plan) : plan_(std::move(plan)) {
  for (const int side : plan_.sizes) {
    const auto size = std::make_shared<OneSize>(OneSize{plan_.compile_for(side), {}, 0});
    const auto add = [&](unsigned threads, Subject subject) {
      subject.name = fmt::format("{}, {}x{}, {}", plan_.scene, side, side, threads_text(threads));
      ways_.emplace_back(side, threads);
      subjects_.push_back(std::move(subject));
    };
    for (const unsigned count : plan_.counts) add(count, thread_subject(plan_, count, size));
    if (plan_.plain && side <= plan_.greatest_plain_size) add(0, plain_subject(size));
  }
}

void ThreadTimes::measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }

const Subject* ThreadTimes::find(int size, unsigned threads) const {
  for (std::size_t i = 0; i < ways_.size(); ++i)
    if (ways_[i] == std::pair(size, threads) && subjects_[i].is_good()) return &subjects_[i];
  return nullptr;
}

/// How many times as fast as one thread, with the interval of pairs of runs in turn; where the least count is
/// greater, that one counts as ideal.
std::optional<Spread> ThreadTimes::speed_up(int size, unsigned count) const {
  const Subject *one = find(size, plan_.counts.front()), *many = find(size, count);
  if (!one || !many) return {};
  const double base = plan_.counts.front(), value = base * one->seconds().median / many->seconds().median;
  const Ratio pairs = paired_ratio(one->runs, many->runs);
  if (!pairs.is_known()) return Spread{value, value, value};
  return Spread{value, std::min(value, base / pairs.high), std::max(value, base / pairs.low)};
}

/// A row a size and a column a count, of what `cell` makes of them.
Table ThreadTimes::pivot(const std::string& title, const std::string& unit,
                         const std::function<Cell(int, unsigned)>& cell) const {
  Table table{fmt::format("{}: {}", plan_.scene, title), {{"pixels a side", ""}}, {}};
  for (const int size : plan_.sizes) {
    std::vector<Field> row{{"pixels a side", "", static_cast<double>(size)}};
    if (plan_.plain) row.push_back({threads_text(0), unit, cell(size, 0)});
    for (const unsigned count : plan_.counts) row.push_back({threads_text(count), unit, cell(size, count)});
    add_row(table, row);
  }
  return table;
}

/// Sizes whose frames are so short that starting and ending them counts.
std::string ThreadTimes::tiny_sizes() const {
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

void ThreadTimes::add_to(Report& report) const {
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
  CurvePlot plot{plan_.scene + ": speed-up by threads", "threads", "times as fast", {}, true};
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
                  {"device", "", threads ? plan_.device.label() : "plain C++"},
                  {"size", "pixels", static_cast<double>(size)},
                  {"threads", "", threads ? static_cast<double>(threads) : 1.0}},
                 {{"speed-up", "", gain ? Cell(gain->median) : Cell()}});
    if (!subjects_[i].problem.empty())
      report.notes.push_back(fmt::format("{}: {}", subjects_[i].name, subjects_[i].problem));
  }
}

}  // namespace sundog
