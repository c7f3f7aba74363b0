// Tunes the frame's kernel, then the AOVs' with 15 % of the budget; each candidate runs in turn with the
// default, and tune_search.h chooses the candidates.
#include "bench/tune/tuner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <utility>

#include "base/clock.h"
#include "base/error.h"
#include "bench/frames/frame_runner.h"
#include "bench/frames/smaller_scene.h"
#include "bench/report/samples.h"
#include "bench/tune/tune_search.h"
#include "device/build_options.h"
#include "render/device/kernel_config.h"
#include "render/device/tuning.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

using enum WorkGroup::Kind;

constexpr int runs = 3, runs_at_the_end = 20;

constexpr double budget_of_surfaces = 0.15;  // of the whole
constexpr double frame_part = 1.0 / 200;     // of the whole, for one frame: a candidate takes eight

/// The values to choose from, in order; index 0 of each axis is the default.
struct Choices {
  std::string kernel = frame_kernel;
  std::vector<WorkGroup> groups{{}};
  std::vector<std::pair<unsigned, unsigned>> shapes{{0, 0}};
  std::vector<unsigned> packets{0};
  std::vector<double> launches{0}, tiles{0};
  std::vector<std::vector<std::string>> options;  // one axis for each option

  std::vector<std::size_t> sizes() const {
    std::vector<std::size_t> all{groups.size(), shapes.size(), packets.size(), launches.size(), tiles.size()};
    for (const auto& values : options) all.push_back(values.size());
    return all;
  }
  Tuning at(const TunePoint& point) const {
    const WorkGroup& group = groups[point[0]];
    if (kernel == surfaces_kernel) return {{}, group, 0, 0, 0, 0, 0};
    const auto [w, h] = shapes[point[1]];
    Tuning tuning{group, {}, w, h, packets[point[2]], launches[point[3]], tiles[point[4]]};
    for (std::size_t i = 0; i < options.size(); ++i)
      if (const std::string& option = options[i][point[first_option + i]]; !option.empty())
        tuning.options += (tuning.options.empty() ? "" : " ") + option;
    return tuning;
  }
  /// The part of a point that needs a program of its own.
  static TunePoint program_of(const TunePoint& point) {
    TunePoint program{point[1], point[2]};
    program.insert(program.end(), point.begin() + first_option, point.end());
    return program;
  }

  static constexpr std::ptrdiff_t first_option = 5;  // in a point
};

std::size_t group_limit(const DeviceInfo& device, const CompiledScene& scene) {
  return std::min<std::size_t>(greatest_work_group(make_kernel_config(scene, device), device), 256);
}

Choices choices_of_frame(const DeviceInfo& device, const CompiledScene& scene) {
  Choices choices;
  const KernelConfig usual = make_kernel_config(scene, device);
  const std::size_t limit = group_limit(device, scene);
  for (std::size_t x = 1; x <= limit; x *= 2) choices.groups.push_back({fixed, x, 1});
  for (std::size_t edge = 2; edge * edge <= limit; edge *= 2) choices.groups.push_back({fixed, edge, edge});
  if (usual.tile_w * usual.tile_h > 1) {  // explicit vectors; on other devices a work-item is a pixel
    for (const std::pair<unsigned, unsigned>& shape :
         {std::pair(8u, 2u), {16u, 1u}, {2u, 8u}, {4u, 2u}, {2u, 2u}})
      choices.shapes.push_back(shape);
    choices.packets.insert(choices.packets.end(), {1, 3, 8, 12});
  }
  choices.launches.insert(choices.launches.end(), {10, 25, 100, 200});
  choices.tiles.insert(choices.tiles.end(), {50, 100, 500, 1000});
  for (std::vector<std::string>& values :
       options_to_try(device, find_integrator(scene.integrator)->entry, traces_compact(scene, device))) {
    values.insert(values.begin(), "");
    choices.options.push_back(std::move(values));
  }
  return choices;
}

// The frame's other settings do not apply: AOVs take one launch for each tile and one ray for each pixel.
Choices choices_of_surfaces(const DeviceInfo& device, const CompiledScene& scene) {
  Choices choices;
  choices.kernel = surfaces_kernel;
  const std::size_t limit = group_limit(device, scene);
  for (std::size_t x = 1; x <= limit; x *= 2) choices.groups.push_back({fixed, x, 1});
  return choices;
}

/// Whether both films have the same bits.
bool are_same(const Film& a, const Film& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
  };
  return same(a.sums, b.sums) && same(a.weights, b.weights) && same(a.aovs, b.aovs);
}

/// Renders frames with one tuning. The constructor throws if the device refuses it.
class Candidate {
 public:
  Candidate(const DeviceInfo& device, const CompiledScene& scene, const Choices& choices,
            const TunePoint& point)
      : kernel_(choices.kernel) {
    RenderOptions options;
    options.tuning = [tuning = choices.at(point)](const DeviceInfo&) { return tuning; };
    if (kernel_ == surfaces_kernel) options.aovs = {"depth"};
    const Stopwatch clock;
    frames_ = std::make_unique<FrameRunner>(device, scene, options);
    frames_->run();
    start_seconds_ = clock.seconds();
  }
  const Film& film() const { return frames_->film(); }
  /// Records the cost of its start.
  void add_to(TuneCosts& costs) const {
    double& most = frames_->times().cached ? costs.open : costs.compile;
    most = std::max(most, start_seconds_);
  }
  /// Sets the film that each frame must equal.
  void expect(const Film& film) { expected_ = &film; }
  /// Seconds of the frame, or of the AOVs' kernel, which is too short to show in the frame's time. Throws
  /// DeviceError if the picture is not the expected one.
  double run() {
    const double seconds = frames_->run();
    if (expected_ && !are_same(film(), *expected_))
      throw DeviceError("another picture than with the defaults");
    return kernel_ == surfaces_kernel ? frames_->kernel_seconds(kernel_) : seconds;
  }
  double median(int count) {
    std::vector<double> seconds;
    for (int i = 0; i < count; ++i) seconds.push_back(run());
    return spread(seconds).median;
  }
  std::size_t greatest_group() const { return frames_->greatest_group(); }

 private:
  std::string kernel_;
  std::unique_ptr<FrameRunner> frames_;
  const Film* expected_ = nullptr;
  double start_seconds_ = 0;
};

/// Runs the two in turn, so that other load on the machine affects both; they alternate in going first.
TunePairs duel(Candidate& usual, Candidate& best, int count) {
  std::vector<double> of_usual, of_best;
  TunePairs pairs{0, 0, 0, count};
  for (int i = 0; i < count; ++i) {
    if (i % 2 == 0) of_usual.push_back(usual.run());
    of_best.push_back(best.run());
    if (i % 2 == 1) of_usual.push_back(usual.run());
    pairs.wins += of_best.back() < of_usual.back();
  }
  pairs.usual = spread(of_usual).median;
  pairs.best = spread(of_best).median;
  return pairs;
}

/// Tracks the time that remains for a kernel, and estimates whether it suffices for another point.
class TimeLeft {
 public:
  TimeLeft(double budget, TuneCosts& costs) : budget_(budget), costs_(costs) {}

  bool has_started_in_time(double frame_seconds) {
    frame_ = frame_seconds;
    return left() > 0;
  }
  bool is_enough_for(const TunePoint& program) const {
    constexpr double caution = 1.25, slower = 1.5;
    const double start = built_.count(program) ? open() : compile();
    const double again = open() + 2 * runs_at_the_end * frame_;
    return left() > caution * start + slower * 2 * runs * frame_ + again;
  }
  void add(const Candidate& candidate, const TunePoint& program) {
    candidate.add_to(costs_);
    built_.insert(program);
  }

 private:
  double left() const { return budget_ - clock_.seconds(); }
  double open() const { return costs_.open > 0 ? costs_.open : 0.5; }
  /// If everything so far came from the cache, assumes that a compilation is ten times as slow.
  double compile() const { return costs_.compile > 0 ? costs_.compile : std::max(3.0, 10 * open()); }

  double budget_, frame_ = 0;
  TuneCosts& costs_;
  std::set<TunePoint> built_;  // Choices::program_of()
  Stopwatch clock_;
};

TuneOutcome tune_kernel(const DeviceInfo& device, const CompiledScene& scene, const std::string& scene_name,
                        Choices choices, double budget, TuneCosts& costs, const TuneListener& listener) {
  TimeLeft time(budget, costs);
  const auto tell = [&](const std::string& what) { return listener.on_step(choices.kernel + ": " + what); };
  tell("the defaults");
  TuneProblem problem;
  problem.start.assign(choices.sizes().size(), 0);
  Candidate usual(device, scene, choices, problem.start);
  time.add(usual, Choices::program_of(problem.start));
  // The limit of work-groups is known only after the kernels are built.
  std::erase_if(choices.groups, [most = usual.greatest_group()](const WorkGroup& group) {
    return most > 0 && group.kind == fixed && group.x * group.y > most;
  });
  problem.axes = choices.sizes();
  const Film expected = usual.film();
  usual.expect(expected);
  const double first_seconds = usual.run();
  const double default_seconds = time.has_started_in_time(first_seconds) ? usual.median(runs) : first_seconds;
  problem.affordable = [&](const TunePoint& point) { return time.is_enough_for(Choices::program_of(point)); };
  std::vector<std::string> rejected;
  problem.measure = [&](const TunePoint& point) -> std::optional<double> {
    if (point == problem.start) return default_seconds;
    const std::string settings = tuning_text(choices.at(point));
    const auto reject = [&](const std::string& why) -> std::optional<double> {
      rejected.push_back(fmt::format("{}: {}", settings, why));
      return {};
    };
    if (const std::string why = tell(settings); !why.empty()) return reject(why);
    try {
      Candidate candidate(device, scene, choices, point);
      time.add(candidate, Choices::program_of(point));
      if (!are_same(candidate.film(), expected)) return reject("another picture than with the defaults");
      candidate.expect(expected);
      // Runs the default in turn, so that a machine that has become slower slows both.
      const TunePairs beside = duel(usual, candidate, runs);
      return default_seconds * beside.best / beside.usual;
    } catch (const DeviceError& error) {
      return reject(error.what());
    } catch (const BuildError& error) {
      return reject(error.what());
    }
  };
  problem.measure_again = [&](const TunePoint&, const TunePoint& best) {
    tell("the winner against the defaults");
    Candidate winner(device, scene, choices, best);
    winner.expect(expected);
    return duel(usual, winner, runs_at_the_end);
  };
  const TuneResult found = search_tuning(problem);
  return {{choices.kernel, scene_class(scene), scene_name, choices.at(found.best),
           1e3 * found.default_seconds, 1e3 * found.best_seconds},
          found.tried,
          std::move(rejected),
          found.left_out,
          {}};
}

}  // namespace

bool tune_device(const DeviceInfo& device, const CompiledScene& scene, const std::string& scene_name,
                 double budget, TuneCosts& costs, const TuneListener& listener) {
  const Stopwatch clock;
  listener.on_step(fmt::format("{}: the first small frame", frame_kernel));
  CompiledScene smaller = scene_in_time(scene, frame_part * budget, [&](const CompiledScene& small) {
    Candidate candidate(device, small, {}, TunePoint(Choices().sizes().size(), 0));
    candidate.add_to(costs);
    return candidate.run();
  });
  const SceneInfo &whole = scene.info, &info = smaller.info;
  const bool is_smaller = info.width < whole.width || info.samples < whole.samples;
  const auto tune = [&](const Choices& choices, double seconds) {
    TuneOutcome outcome = tune_kernel(device, smaller, scene_name, choices, seconds, costs, listener);
    if (is_smaller)
      outcome.frames = fmt::format("{}x{} pixels and {} sample{} a pixel", info.width, info.height,
                                   info.samples, info.samples == 1 ? "" : "s");
    listener.on_outcome(outcome);
  };
  tune(choices_of_frame(device, smaller), (1 - budget_of_surfaces) * budget - clock.seconds());
  const double left = budget - clock.seconds();
  if (left < std::max(costs.compile, costs.open)) return false;
  smaller.info.samples = 1;  // AOVs are rendered once, whatever the number of samples
  tune(choices_of_surfaces(device, smaller), left);
  return true;
}

}  // namespace sundog
