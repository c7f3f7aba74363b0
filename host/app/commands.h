// What `sundog` does for each of its commands. Each returns the exit status; errors are exceptions.
#pragma once
#include "app/options.h"

namespace sundog {

/// The exit statuses, a contract with scripts.
enum ExitStatus {
  exit_done = 0,
  exit_failure = 1,  // internal or I/O
  exit_usage = 2,
  exit_scene = 3,       // the scene or an input file is bad
  exit_device = 4,      // no such device, or every device failed
  exit_build = 5,       // a kernel did not build
  exit_difference = 6,  // compare found one
  exit_interrupted = 130,
};

int render_command(const RenderCommand& command);
int info_command(const InfoCommand& command);
/// `argv` as main() has it.
int worker_command(int argc, const char* const* argv);
int compile_command(int argc, const char* const* argv);
int merge_command(const MergeCommand& command);
int compare_command(const CompareCommand& command);

}  // namespace sundog
