// embree_build MODEL... : builds the BVH of the same models with compile() and with Embree's medium quality,
// in turn, on the same number of threads. sundog is charged for all of compile(): the flattened tree,
// triangle blocks, vertices. Embree is charged for its commit, its buffers filled before.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include "bench_scenes.h"
#include "compile/compiled_scene.h"
#include "embree_peer.h"
#include "peer_program.h"

using namespace sundog;

namespace {

struct Options : PeerOptions {
  std::vector<unsigned> threads{1, 2};
};

/// One thread is timed by the processor's clock, unless told otherwise: other programs disturb it less.
bool by_wall(const Options& options, unsigned threads) { return options.wall || threads > 1; }

nlohmann::json compare_builds(const SceneDescription& scene, unsigned threads, const Options& options) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);  // Embree's too
  const bool wall = by_wall(options, threads);
  std::vector<double> ours, theirs, ratio;
  BvhFigures figures;
  for (unsigned i = 0; i <= options.repeats; ++i) {
    const EmbreePeer embree(scene, {.robust = false, .high_quality = options.spatial_splits});
    const double start = processor_seconds();
    figures = compile(scene).figures;
    const double mine = wall ? figures.build_seconds : processor_seconds() - start;
    if (i == 0) continue;  // the first warms caches and wakes threads
    ours.push_back(mine * 1e3);
    theirs.push_back((wall ? embree.build_seconds() : embree.build_processor_seconds()) * 1e3);
    ratio.push_back(theirs.back() / ours.back());
  }
  const Spread r = spread(ratio);
  fmt::print("  {:>7}{:>11.1f}{:>11.1f}{:>8.2f} ({:.2f}..{:.2f}){:>9.2f}{:>9}{:>9}{:>7.2f}\n", threads,
             spread(ours).median, spread(theirs).median, r.median, r.min, r.max, figures.sah_cost,
             figures.nodes, figures.blocks, figures.mean_block_fill);
  std::fflush(stdout);
  return {{"threads", threads},
          {"clock", wall ? "wall" : "processor"},
          {"sundog_ms", to_json(spread(ours))},
          {"embree_ms", to_json(spread(theirs))},
          {"ratio", to_json(r)},
          {"sah_cost", figures.sah_cost},
          {"nodes", figures.nodes},
          {"blocks", figures.blocks},
          {"block_fill", figures.mean_block_fill},
          {"bytes", figures.bytes}};
}

nlohmann::json compare_model(const Options& options, const std::string& path) {
  const SceneDescription scene = scene_of_model(path, options.spatial_splits);
  fmt::print("{}\n  {:>7}{:>11}{:>11}{:>8}{:>23}{:>9}{:>9}{:>7}\n", path, "threads", "sundog ms", "Embree ms",
             "ratio", "SAH cost", "nodes", "blocks", "fill");
  nlohmann::json rows = nlohmann::json::array();
  for (const unsigned threads : options.threads) rows.push_back(compare_builds(scene, threads, options));
  return {{"model", path}, {"builds", rows}};
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  Arguments app{
      "The BVH's build, sundog's (with --spatial against Embree's high quality) and Embree's, in turn"};
  add_peer_options(app, options);
  app.add_option("--threads", options.threads, "numbers of threads to try");
  return run_peer_program(app, argc, argv, options,
                          [&](const std::string& model) { return compare_model(options, model); });
}
