// See tuner.h.
#include "bench/tuner.h"

#include <algorithm>

#include "base/clock.h"
#include "base/error.h"
#include "bench/frame_runner.h"
#include "bench/samples.h"
#include "bench/tune_search.h"
#include "render/kernel_config.h"

namespace sundog {
namespace {

using enum WorkGroup::Kind;

constexpr int runs = 3, runs_at_the_end = 5;

/// The values to choose from, neighbours beside each other; index 0 of each is the default.
struct Choices {
  std::vector<WorkGroup> groups{{}};
  std::vector<std::pair<unsigned, unsigned>> shapes{{0, 0}};
  std::vector<unsigned> packets{0};
  std::vector<double> launches{0, 10, 25, 100, 200};
  std::vector<double> tiles{0, 50, 100, 500, 1000};

  std::vector<std::size_t> sizes() const {
    return {groups.size(), shapes.size(), packets.size(), launches.size(), tiles.size()};
  }
  Tuning at(const TunePoint& point) const {
    const auto [w, h] = shapes[point[1]];
    return {groups[point[0]], w, h, packets[point[2]], launches[point[3]], tiles[point[4]]};
  }
};

Choices make_choices(const DeviceInfo& device, const CompiledScene& scene) {
  Choices choices;
  const KernelConfig usual = make_kernel_config(scene, device);
  const std::size_t limit = std::min<std::size_t>(greatest_work_group(usual, device), 256);
  for (std::size_t x = 1; x <= limit; x *= 2) choices.groups.push_back({fixed, x, 1});
  for (std::size_t edge = 2; edge * edge <= limit; edge *= 2) choices.groups.push_back({fixed, edge, edge});
  if (usual.tile_w * usual.tile_h > 1) {  // explicit vectors; on other devices a lane is a pixel
    for (const std::pair<unsigned, unsigned>& shape :
         {std::pair(8u, 2u), {16u, 1u}, {2u, 8u}, {4u, 2u}, {2u, 2u}})
      choices.shapes.push_back(shape);
    choices.packets.insert(choices.packets.end(), {1, 3, 8, 12});
  }
  return choices;
}

/// Frames with one tuning; nothing where the device refuses it.
class Candidate {
 public:
  Candidate(const DeviceInfo& device, const CompiledScene& scene, const Tuning& tuning) {
    RenderOptions options;
    options.tuning = [tuning](const DeviceInfo&) { return tuning; };
    frames_ = std::make_unique<FrameRunner>(device, scene, options);
    frames_->run();
    frames_->save_programs();
  }
  double run() { return frames_->run(); }
  double median(int count) {
    std::vector<double> seconds;
    for (int i = 0; i < count; ++i) seconds.push_back(run());
    return spread(seconds).median;
  }
  Image image() const { return frames_->image(); }

 private:
  std::unique_ptr<FrameRunner> frames_;
};

/// The two in turn, so that what else the machine does falls on both.
std::pair<double, double> duel(Candidate& a, Candidate& b, int count) {
  std::vector<double> of_a, of_b;
  for (int i = 0; i < count; ++i) {
    of_a.push_back(a.run());
    of_b.push_back(b.run());
  }
  return {spread(of_a).median, spread(of_b).median};
}

}  // namespace

TuneOutcome tune_device(const DeviceInfo& device, const CompiledScene& scene, const std::string& scene_name,
                        double budget, const std::function<void(const std::string&)>& on_step) {
  const Stopwatch clock;
  const Choices choices = make_choices(device, scene);
  on_step("the defaults");
  Candidate usual(device, scene, {});
  const Image expected = usual.image();
  TuneProblem problem;
  problem.axes = choices.sizes();
  problem.start.assign(problem.axes.size(), 0);
  const double default_seconds = usual.median(runs);
  problem.measure = [&](const TunePoint& point) -> std::optional<double> {
    if (point == problem.start) return default_seconds;
    on_step(tuning_text(choices.at(point)));
    try {
      Candidate candidate(device, scene, choices.at(point));
      if (candidate.image().data != expected.data) return {};
      // The default beside it: a machine that has become slower meanwhile slows both.
      const auto [own, beside] = duel(candidate, usual, runs);
      return default_seconds * own / beside;
    } catch (const DeviceError&) {
      return {};
    } catch (const BuildError&) {
      return {};
    }
  };
  problem.measure_again = [&](const TunePoint&, const TunePoint& best) {
    on_step("the winner against the defaults");
    Candidate winner(device, scene, choices.at(best));
    return duel(usual, winner, runs_at_the_end);
  };
  problem.out_of_time = [&] { return clock.seconds() > budget; };
  const TuneResult found = search_tuning(problem);
  return {{scene_class(scene), scene_name, choices.at(found.best), 1e3 * found.default_seconds,
           1e3 * found.best_seconds},
          found.tried,
          found.rejected};
}

}  // namespace sundog
