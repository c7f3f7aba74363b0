// Ctrl-C: the first one asks the render to stop, the second ends the program. A terminal that is closed asks
// too, and a limit on processor time. And SIGCONT, which mpirun sends a second before it ends a process.
#pragma once
#include <atomic>
#include <initializer_list>
#include <string>

namespace sundog {

/// While it lives, SIGINT, SIGTERM, SIGXCPU and (unless it is ignored, as by nohup) SIGHUP, whichever thread
/// they are meant for, go to a thread that waits for them: a driver's compiler (LLVM's) puts handlers of its
/// own in the place of a program's, which remove the files that it is writing, so that it fails with a
/// message of its own. Made before any other thread, which would not inherit that they are held back. One at
/// a time. From then on a reader of messages who leaves ends nothing by SIGPIPE.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  /// From here on a signal sets the flag, and a second one ends the program with status 130. So it is at
  /// first.
  void asks() const;
  /// From here on a signal ends the program at once with status 130: "sundog: interrupted: " and `why`.
  void ends_all(const std::string& why) const;

  const std::atomic<bool>& flag() const;
  /// Set by SIGCONT; its reader clears it.
  std::atomic<bool>& continued() const;
};

/// For a process that another of this program has started, which decides what a signal means: a terminal
/// sends Ctrl-C to both. Before any other thread is made.
void hold_back(std::initializer_list<int> signals);

}  // namespace sundog
