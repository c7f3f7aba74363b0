// Turns exceptions into one line on stderr and an exit status. Only this code catches all exceptions.
#pragma once
#include <functional>

namespace sundog {

/// The exit statuses, which scripts rely on.
enum ExitStatus {
  exit_done = 0,
  exit_failure = 1,  // internal or I/O error
  exit_usage = 2,
  exit_scene = 3,       // the scene or an input file is bad
  exit_device = 4,      // no such device, or every device failed
  exit_build = 5,       // a kernel did not build
  exit_difference = 6,  // compare or check found a difference
  exit_interrupted = 130,
};

/// Runs the command. Returns its status or, if it throws, the error's; prints the error if `speaks`.
int exit_status_of(const std::function<int()>& command, bool speaks = true);

}  // namespace sundog
