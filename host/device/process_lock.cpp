// Locks a mutex, then a file of /proc with flock(), which all copies of this library share.
#include "device/process_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <memory>
#include <mutex>

namespace sundog {
namespace {

std::mutex& own_lock() {
  static const auto mutex = std::make_unique<std::mutex>();
  return *mutex;
}

}  // namespace

ProcessLock::ProcessLock() noexcept : file_(-1) {
  own_lock().lock();
  file_ = ::open("/proc/self/status", O_RDONLY | O_CLOEXEC);
  // Each open file has its own lock, even within a process.
  while (file_ >= 0 && ::flock(file_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

ProcessLock::~ProcessLock() {
  if (file_ >= 0) {
    ::flock(file_, LOCK_UN);  // even if fork() has copied the descriptor meanwhile
    ::close(file_);
  }
  own_lock().unlock();
}

}  // namespace sundog
