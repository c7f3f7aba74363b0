// Handles signals. The first Ctrl-C asks the render to stop, the second ends the program. A closed terminal
// and a limit on processor time also ask it to stop. mpirun sends SIGCONT a second before it ends a process.
#pragma once
#include <atomic>
#include <initializer_list>
#include <string>

namespace sundog {

/// During its lifetime, a dedicated thread receives SIGINT, SIGTERM, SIGXCPU and (unless ignored, as under
/// nohup) SIGHUP. Signal handlers would not do: a driver's compiler (LLVM) replaces them by its own, which
/// remove the files that it is writing, so that it fails with a message of its own. Create before any other
/// thread, so that all inherit the blocked signals; only one at a time. From then on the process ignores
/// SIGPIPE, so that it continues if nobody reads its messages any more.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  /// From now on (and initially) a signal sets the flag, and a second one ends the program with status 130.
  void asks() const;
  /// From now on a signal prints "sundog: interrupted: " and `why`, and ends the program with status 130.
  void ends_all(const std::string& why) const;

  const std::atomic<bool>& flag() const;
  /// Set by SIGCONT; its reader clears it.
  std::atomic<bool>& continued() const;
};

/// Blocks signals in this process. For example, a terminal sends Ctrl-C to a worker too, but its parent
/// decides what to do. Call before starting threads.
void hold_back(std::initializer_list<int> signals);

}  // namespace sundog
