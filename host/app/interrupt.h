// Ctrl-C: the first one asks the render to stop, the second ends the program. And SIGCONT, which mpirun sends
// a second before it ends a process.
#pragma once
#include <atomic>

namespace sundog {

/// While it lives, SIGINT and SIGTERM set the flag instead of ending the program; a second one ends it at
/// once with status 130. One at a time.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  const std::atomic<bool>& flag() const;
  /// Set by SIGCONT; whoever has seen it takes it back.
  std::atomic<bool>& continued() const;
};

}  // namespace sundog
