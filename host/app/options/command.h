// The list of commands. Each command has a file with add_NAME(), which declares its options and, if the
// command line names it, sets the function to run.
#pragma once
#include <functional>

#include "app/process/exit_status.h"

namespace sundog {

class Arguments;

/// A command line, ready to run.
struct Command {
  std::function<int()> run;  // returns the exit status; errors are exceptions
  /// Whether the process's first thread runs it. If not, a new thread does: drivers that work in the caller's
  /// thread need more stack than the first thread has.
  bool in_first_thread = false;
  bool stops_on_signal = false;  // it creates a StopOnSignal: all threads block the signals
  bool only_prints = false;      // it is refused if the standard output is closed
};

/// Declares a command below `root`; stores it in `chosen` if the command line names it.
using AddCommand = void(Arguments& root, Command& chosen);

/// X(name) for each command, in the order of help. Only sundog itself starts the last two.
#define SUNDOG_COMMANDS(X) \
  X(render)                \
  X(devices)               \
  X(formulas)              \
  X(kernels)               \
  X(info)                  \
  X(compare)               \
  X(check)                 \
  X(tune)                  \
  X(merge)                 \
  X(mix)                   \
  X(bake)                  \
  X(gallery)               \
  X(halo)                  \
  X(serve)                 \
  X(bench)                 \
  X(compile)               \
  X(worker)

#define SUNDOG_COMMAND(name) AddCommand add_##name;
SUNDOG_COMMANDS(SUNDOG_COMMAND)
#undef SUNDOG_COMMAND

}  // namespace sundog
