// A process-wide lock. Internal to the device layer.
#pragma once

namespace sundog {

/// Held during its lifetime, by one thread of the process at a time. Unlike a mutex, copies of this library
/// loaded side by side share it: it is a file lock on the process's entry in /proc. Without /proc it only
/// works within one copy.
class ProcessLock {
 public:
  ProcessLock() noexcept;
  ~ProcessLock();
  ProcessLock(const ProcessLock&) = delete;
  ProcessLock& operator=(const ProcessLock&) = delete;

 private:
  int file_;  // negative: none
};

}  // namespace sundog
