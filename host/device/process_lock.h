// One lock for a whole process. Internal to the device layer.
#pragma once

namespace sundog {

/// Held while it lives, by one thread of the process at a time. Copies of this library that are loaded side
/// by side share it, which a mutex of the library's own would not: it is a file lock on the process's entry
/// in /proc. Where /proc is not mounted only the threads of one copy take turns.
class ProcessLock {
 public:
  ProcessLock() noexcept;
  ~ProcessLock();
  ProcessLock(const ProcessLock&) = delete;
  ProcessLock& operator=(const ProcessLock&) = delete;

 private:
  int file_;  // negative: there is none
};

}  // namespace sundog
