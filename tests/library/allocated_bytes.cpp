// Counts bytes in the program's own operators new and delete, which the library calls too.
#include "allocated_bytes.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

std::atomic<std::size_t> allocated{0}, held_now{0}, most_held{0};

/// The allocations that this thread is refused.
struct Refusal {
  std::size_t size = std::numeric_limits<std::size_t>::max();
  int allowed = 0;
  bool failed = false;
};
thread_local Refusal refusal;

void note(void* memory, std::size_t size) {
  allocated += size;
  const std::size_t held = held_now += ::malloc_usable_size(memory);
  std::size_t most = most_held;
  while (held > most && !most_held.compare_exchange_weak(most, held)) continue;
}

void give_back(void* memory) {
  held_now -= ::malloc_usable_size(memory);
  std::free(memory);
}

}  // namespace

AllocatedBytes::AllocatedBytes() : before_(allocated), held_before_(held_now) { most_held = held_before_; }
std::size_t AllocatedBytes::count() const { return allocated - before_; }
std::size_t AllocatedBytes::held() const {
  return std::max<std::size_t>(held_now, held_before_) - held_before_;
}
std::size_t AllocatedBytes::most() const { return most_held - held_before_; }

LargeAllocationsFail::LargeAllocationsFail(std::size_t size, int allowed) {
  refusal = {size, allowed, false};
}
LargeAllocationsFail::~LargeAllocationsFail() { refusal.size = std::numeric_limits<std::size_t>::max(); }
bool LargeAllocationsFail::failed() { return refusal.failed; }

[[gnu::noinline]] void* operator new(std::size_t size) {
  if (size >= refusal.size && --refusal.allowed < 0) {
    refusal.failed = true;
    throw std::bad_alloc();
  }
  void* memory = std::malloc(size > 0 ? size : 1);
  if (!memory) throw std::bad_alloc();
  note(memory, size);
  return memory;
}
[[gnu::noinline]] void* operator new(std::size_t size,
                                     const std::nothrow_t&) noexcept {  // AddressSanitizer has its own
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { give_back(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { give_back(memory); }
