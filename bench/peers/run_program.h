// Another program as a benchmark runs it.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "bench_scenes.h"

namespace sundog {

struct ProgramRun {
  std::vector<std::string> command;                // the program first, found by PATH
  std::string log;                                 // file for what it prints
  std::map<std::string, std::string> environment;  // besides this program's own
  bool one_processor = false;
};

/// The child's time until it ends. Throws std::runtime_error when it fails.
Elapsed run_program(const ProgramRun& run);

}  // namespace sundog
