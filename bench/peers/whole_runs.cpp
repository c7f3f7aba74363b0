// See whole_runs.h.
#include "whole_runs.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/arguments.h"
#include "base/file.h"
#include "parse_arguments.h"

namespace sundog {

int run_whole_runs(const std::string& about, int argc, char** argv, WholeRuns& options,
                   const std::function<nlohmann::json()>& measure) {
  namespace fs = std::filesystem;
  Arguments app(about);
  app.add_option("--size", options.size, "pixels a side")->range(16, 4096);
  app.add_option("--repeats", options.repeats)->range(1, 100);
  app.add_option("--device", options.device, "sundog's OpenCL device");
  app.add_option("--folder", options.folder, "for scenes, pictures and caches");
  app.add_option("--json", options.json, "file for the figures");
  parse_or_exit(app, argc, argv);
  try {
    options.folder = fs::absolute(options.folder).string();
    fs::create_directories(options.folder);
    const nlohmann::json figures = measure();
    if (!options.json.empty()) write_file(options.json, figures.dump(2) + "\n");
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", fs::path(argv[0]).filename().string(), error.what());
    return 1;
  }
}

}  // namespace sundog
