// The common frame of the programs that time whole runs of sundog, from the command to the picture: the same
// options on the command line, figures as JSON.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace sundog {

struct WholeRuns {
  int size = 64, repeats = 5;
  std::string device = "cpu";  // SPEC of sundog's
  std::string folder{};        // for what the runs read and write; made
  std::string json{};          // file for the figures; empty: none
};

/// Parses --size --repeats --device --folder --json into `options`, which has the defaults, makes the folder,
/// and writes what `measure` returned; main()'s result. Errors are one line on stderr.
int run_whole_runs(const std::string& about, int argc, char** argv, WholeRuns& options,
                   const std::function<nlohmann::json()>& measure);

}  // namespace sundog
