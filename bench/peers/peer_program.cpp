// Parses the command line, measures each model, and writes the results as JSON.
#include "peer_program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"

namespace sundog {

void add_peer_options(Arguments& app, PeerOptions& options) {
  app.add_option("models", options.models,
                 ".obj, .ply, .stl, .gltf, also .gz; .json scenes of meshes, with Embree also of balls")
      ->required();
  app.add_option("--repeats", options.repeats, "pairs of measurements")->positive();
  app.add_option("--json", options.json, "file for the figures");
  app.add_flag("--wall", options.wall, "wall clock, not processor time over threads");
}

int run_program(Arguments& app, int argc, char** argv, const std::function<void()>& run) {
  try {
    app.parser().parse(argc, argv);
    run();
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.parser().exit(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", std::filesystem::path(argv[0]).filename().string(), error.what());
    return 1;
  }
}

int run_peer_program(Arguments& app, int argc, char** argv, const PeerOptions& options,
                     const std::function<nlohmann::json(const std::string& model)>& measure) {
  return run_program(app, argc, argv, [&] {
    nlohmann::json results = nlohmann::json::array();
    for (const std::string& model : options.models) results.push_back(measure(model));
    if (!options.json.empty()) write_file(options.json, results.dump(2) + "\n");
  });
}

Spread ratio(const std::vector<double>& theirs, const std::vector<double>& ours) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < theirs.size(); ++i) ratios.push_back(theirs[i] / ours[i]);
  return spread(ratios);
}

nlohmann::json to_json(const Spread& s) { return {{"median", s.median}, {"min", s.min}, {"max", s.max}}; }

}  // namespace sundog
