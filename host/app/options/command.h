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

AddCommand add_render, add_devices, add_formulas, add_kernels, add_info, add_compare, add_check, add_tune,
    add_merge, add_mix, add_bake, add_gallery, add_halo, add_serve, add_bench;
/// Not for people: other processes of sundog start these.
AddCommand add_compile, add_worker;

}  // namespace sundog
