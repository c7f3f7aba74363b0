// Commands in one style: each has a file with its add_NAME(), which declares the options and, where a command
// line names it, says what runs.
#pragma once
#include <functional>

#include "app/process/exit_status.h"

namespace sundog {

class Arguments;

/// A command line, ready to run.
struct Command {
  std::function<int()> run;  // returns the exit status; errors are exceptions
  /// Whether the process's first thread runs it. Else it has a thread of its own: drivers that work in the
  /// caller's thread need more stack than the first one has.
  bool in_first_thread = false;
  bool stops_on_signal = false;  // it has a StopOnSignal: no thread is to end by the signals themselves
};

/// Declares a command below `root`, and makes it `chosen` where it is named.
using AddCommand = void(Arguments& root, Command& chosen);

/// X(name) for each command, in the order of help; the last two are not for people: other processes of sundog
/// start them.
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
