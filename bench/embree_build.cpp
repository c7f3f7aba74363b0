// embree_build MODEL... : builds the BVH of the same models with compile() and with Embree's medium quality,
// in turn, on the same number of threads. sundog is charged for all of compile(): the flattened tree,
// triangle blocks, vertices. Embree is charged for its commit, its buffers filled before.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "bench/samples.h"
#include "embree_peer.h"
#include "scene/model.h"

using namespace sundog;

namespace {

struct Options {
  std::vector<std::string> models;
  std::vector<unsigned> threads{1, 2};
  std::string json;
  unsigned repeats = 9;
  bool spatial_splits = false, wall = false;
};

SceneDescription scene_of_model(const std::string& path, const Options& options) {
  Model model = load_model(path);
  SceneDescription scene;
  scene.file = path;
  scene.media.resize(1);
  scene.render.spatial_splits = options.spatial_splits;
  scene.materials = std::move(model.materials);
  scene.meshes = std::move(model.meshes);
  scene.objects = std::move(model.objects);
  return scene;
}

/// One thread is timed by the processor's clock, unless told otherwise: other programs disturb it less.
bool by_wall(const Options& options, unsigned threads) { return options.wall || threads > 1; }

nlohmann::json to_json(const Spread& s) { return {{"median", s.median}, {"min", s.min}, {"max", s.max}}; }

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

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"The BVH's build, sundog's and Embree's, in turn"};
  app.add_option("models", options.models, ".obj, .ply, .stl, .gltf")->required();
  app.add_option("--threads", options.threads, "numbers of threads to try");
  app.add_option("--repeats", options.repeats, "pairs of measurements");
  app.add_option("--json", options.json, "file for the figures");
  app.add_flag("--spatial", options.spatial_splits, "spatial splits, against Embree's high quality");
  app.add_flag("--wall", options.wall, "wall clock for one thread too");
  CLI11_PARSE(app, argc, argv);
  try {
    nlohmann::json results = nlohmann::json::array();
    for (const std::string& path : options.models) {
      const SceneDescription scene = scene_of_model(path, options);
      fmt::print("{}\n  {:>7}{:>11}{:>11}{:>8}{:>23}{:>9}{:>9}{:>7}\n", path, "threads", "sundog ms",
                 "Embree ms", "ratio", "SAH cost", "nodes", "blocks", "fill");
      nlohmann::json rows = nlohmann::json::array();
      for (const unsigned threads : options.threads) rows.push_back(compare_builds(scene, threads, options));
      results.push_back({{"model", path}, {"builds", rows}});
    }
    if (!options.json.empty()) write_file(options.json, results.dump(2) + "\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "embree_build: {}\n", error.what());
    return 1;
  }
}
