// Tests limits by starting threads, because a container's thread limit cannot be queried.
#include "device/thread_limits.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <mutex>
#include <stdexcept>
#include <vector>

namespace sundog {
namespace {

// A frame's threads besides the driver's (one per processor). A compile process may need as many again.
constexpr unsigned frame_threads = 4;
// Memory that libraries and the compiler need beyond current use, without stacks (PoCL 3.1: 320 MiB total).
constexpr std::size_t other_memory = std::size_t{256} << 20;

void* wait_for_all(void* all) {
  const std::lock_guard started(*static_cast<std::mutex*>(all));
  return nullptr;
}

/// Whether this many additional threads can exist.
bool can_start(unsigned count) {
  pthread_attr_t attributes;
  if (::pthread_attr_init(&attributes) != 0) return false;
  ::pthread_attr_setstacksize(&attributes, std::size_t{256} << 10);
  std::vector<pthread_t> threads;
  std::mutex all;
  bool started = true;
  {
    const std::lock_guard lock(all);
    while (started && threads.size() < count) {
      pthread_t thread{};
      started = ::pthread_create(&thread, &attributes, wait_for_all, &all) == 0;
      if (started) threads.push_back(thread);
    }
  }
  for (const pthread_t thread : threads) ::pthread_join(thread, nullptr);
  ::pthread_attr_destroy(&attributes);
  return started;
}

bool can_reserve(std::size_t bytes) {
  void* memory = ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) return false;
  ::munmap(memory, bytes);
  return true;
}

}  // namespace

void check_thread_limits(unsigned processors, std::size_t stack) {
  rlimit space = {};
  const std::size_t needed = (processors + frame_threads) * stack + other_memory;
  if (::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY && !can_reserve(needed))
    throw std::runtime_error(fmt::format(
        "the limit on address space (`ulimit -v`, or a batch system's) of {} MiB leaves no room for "
        "the {} that {} processors take ({} a thread, for its stack): raise it",
        space.rlim_cur >> 20, needed >> 20, processors, stack >> 20));
  if (const unsigned threads = 2 * (processors + frame_threads); !can_start(threads))
    throw std::runtime_error(fmt::format(
        "{} threads cannot be started: raise the limit on them (`ulimit -u`, or the container's)", threads));
}

}  // namespace sundog
