// How long sundog takes from the command to a small picture: with no kernel in any cache, with all of them,
// and after an edit of a scene's formula with all else cached. The caches are folders of this program's own.
// A picture of 64x64 pixels is one tile, so its end is the first that anyone can see of it.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "bench/report/samples.h"
#include "run_program.h"
#include "whole_runs.h"

using namespace sundog;
namespace fs = std::filesystem;

namespace {

struct Start {
  std::string name, what;
  std::vector<double> wall, processor;
};

std::string shipped(const char* name) { return fmt::format("{}/scenes/{}.json", SUNDOG_SOURCE_DIR, name); }

/// scenes/formula.json with another map.
void write_edited(const fs::path& file) {
  std::string text = read_file(shipped("formula"));
  const std::string line = "\"z = abs(z) - shift\"";
  const std::size_t at = text.find(line);
  if (at == std::string::npos) throw std::runtime_error("scenes/formula.json has no line " + line);
  write_file(file, text.replace(at, line.size(), "\"z = abs(z + shift) - 2 * shift\""));
}

/// One sample a pixel: the scenes of paths have many.
void time_start(const WholeRuns& options, const std::string& scene, const fs::path& caches, Start& start) {
  const fs::path folder = options.folder;
  const std::vector<std::string> command{SUNDOG_BINARY,
                                         "render",
                                         scene,
                                         "--size",
                                         fmt::format("{0}x{0}", options.size),
                                         "--device",
                                         options.device,
                                         "--quiet",
                                         "--samples",
                                         "1",
                                         "-o",
                                         (folder / (start.name + ".png")).string()};
  const Elapsed used = run_program(
      {command,
       (folder / (start.name + ".log")).string(),
       {{"XDG_CACHE_HOME", (caches / "sundog").string()}, {"POCL_CACHE_DIR", (caches / "pocl").string()}}});
  start.wall.push_back(used.wall);
  start.processor.push_back(used.processor);
}

/// One run of each, so that a machine's moods touch all alike.
void time_round(const WholeRuns& options, std::vector<Start>& starts) {
  const fs::path folder = options.folder, edited = folder / "edited.json";
  write_edited(edited);
  std::size_t next = 0;
  for (const char* scene : {"spheres", "cornell_path", "glass_path", "formula"}) {
    const fs::path caches = folder / fmt::format("caches_{}", scene);
    fs::remove_all(caches);
    for (int run = 0; run < 2; ++run) time_start(options, shipped(scene), caches, starts.at(next++));
  }
  time_start(options, edited.string(), folder / "caches_formula", starts.at(next));
}

nlohmann::json report(const WholeRuns& options, const std::vector<Start>& starts) {
  nlohmann::json json{{"size", options.size}, {"repeats", options.repeats}, {"device", options.device}};
  fmt::print("{:16} {:>9} {:>17} {:>11}\n", "", "wall [s]", "range", "processor");
  for (const Start& start : starts) {
    const Spread wall = spread(start.wall), processor = spread(start.processor);
    fmt::print("{:16} {:9.3f} {:8.3f}-{:8.3f} {:11.3f}   {}\n", start.name, wall.median, wall.min, wall.max,
               processor.median, start.what);
    json["starts"].push_back({{"name", start.name},
                              {"what", start.what},
                              {"wall_seconds", to_json(wall)},
                              {"processor_seconds", to_json(processor)}});
  }
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  WholeRuns options{.folder = "start_up"};
  const auto measure = [&] {
    std::vector<Start> starts{
        {"spheres_cold", "scenes/spheres.json, no kernel in any cache", {}, {}},
        {"spheres_warm", "its kernels cached", {}, {}},
        {"cornell_cold", "scenes/cornell_path.json, no kernel in any cache", {}, {}},
        {"cornell_warm", "its kernels cached", {}, {}},
        {"glass_cold", "scenes/glass_path.json with photons, no kernel in any cache", {}, {}},
        {"glass_warm", "its kernels cached", {}, {}},
        {"formula_cold", "scenes/formula.json, no kernel in any cache", {}, {}},
        {"formula_warm", "its kernels cached", {}, {}},
        {"formula_edited", "another map in it, all else cached", {}, {}}};
    for (int i = 0; i < options.repeats; ++i) time_round(options, starts);
    return report(options, starts);
  };
  return run_whole_runs("Times from the command to a small picture: with and without cached kernels.", argc,
                        argv, options, measure);
}
