// The common frame of the programs that measure in turn with a peer: their command lines, clocks and figures.
// Those of models have MODEL... and the same options on the command line, a result for each model, all of
// them as JSON.
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
  bool wall = false;     // the wall clock where else the processor's is taken
};

/// MODEL... --repeats --json --wall.
void add_peer_options(Arguments& app, PeerOptions& options);

/// Reads the command line, or prints help or an error; then calls `run`, whose errors are one line on stderr.
/// Returns main()'s status.
int run_program(Arguments& app, int argc, char** argv, const std::function<void()>& run);

/// run_program() that runs `measure` for each model and writes what it returned.
int run_peer_program(Arguments& app, int argc, char** argv, const PeerOptions& options,
                     const std::function<nlohmann::json(const std::string& model)>& measure);

/// Seconds by the wall clock, and by the processor's of all threads together.
struct Elapsed {
  double wall = 0, processor = 0;

  /// Seconds per thread. The processor's clock is steadier on a machine that others use too.
  double of_thread(unsigned threads, bool by_wall) const { return by_wall ? wall : processor / threads; }
};

template <class Work>
Elapsed elapsed(const Work& work) {
  const double start = processor_seconds();
  const Stopwatch clock;
  work();
  return {clock.seconds(), processor_seconds() - start};
}

/// How many times as long as we the peer took, run by run.
Spread ratio(const std::vector<double>& theirs, const std::vector<double>& ours);

/// {"median", "min", "max"}.
nlohmann::json to_json(const Spread& spread);

}  // namespace sundog
