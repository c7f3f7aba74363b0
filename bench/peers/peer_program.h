// Command line, clocks and ratios of the programs that time sundog and a peer in turn. Programs that take
// MODEL... share their options and write one JSON result for each model.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/arguments.h"
#include "base/clock.h"
#include "bench/report/samples.h"

namespace sundog {

struct PeerOptions {
  std::vector<std::string> models;
  std::string json;
  unsigned repeats = 7;  // pairs of measurements
  bool wall = false;     // wall-clock time instead of processor time
};

/// Adds MODEL... --repeats --json --wall.
void add_peer_options(Arguments& app, PeerOptions& options);

/// Parses the command line and calls `run`; prints help, or an error of either as one line on stderr. Returns
/// main()'s status.
int run_program(Arguments& app, int argc, char** argv, const std::function<void()>& run);

/// run_program() that calls `measure` for each model and writes the results to options.json.
int run_peer_program(Arguments& app, int argc, char** argv, const PeerOptions& options,
                     const std::function<nlohmann::json(const std::string& model)>& measure);

/// Wall-clock seconds, and processor seconds of all threads together.
struct Elapsed {
  double wall = 0, processor = 0;

  /// Seconds per thread. Processor time varies less on a machine that other programs use too.
  double of_thread(unsigned threads, bool by_wall) const { return by_wall ? wall : processor / threads; }
};

template <class Work>
Elapsed elapsed(const Work& work) {
  const double start = processor_seconds();
  const Stopwatch clock;
  work();
  return {clock.seconds(), processor_seconds() - start};
}

/// The peer's time divided by ours, run by run.
Spread ratio(const std::vector<double>& theirs, const std::vector<double>& ours);

/// {"median", "min", "max"}.
nlohmann::json to_json(const Spread& spread);

}  // namespace sundog
