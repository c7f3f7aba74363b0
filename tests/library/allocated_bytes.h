// Counts what a program and its libraries allocate by `new`, and takes memory away from one thread.
#pragma once
#include <cstddef>

/// Counts bytes that any thread has allocated since it was made. One at a time.
class AllocatedBytes {
 public:
  AllocatedBytes();
  std::size_t count() const;  ///< bytes, those that were given back too
  std::size_t held() const;   ///< bytes that are still held
  std::size_t most() const;   ///< the most that were held at once

 private:
  std::size_t before_, held_before_;
};

/// While it lives, this thread's allocations of `size` bytes or more fail, all but the first `allowed`.
class LargeAllocationsFail {
 public:
  LargeAllocationsFail(std::size_t size, int allowed);
  ~LargeAllocationsFail();
  LargeAllocationsFail(const LargeAllocationsFail&) = delete;
  LargeAllocationsFail& operator=(const LargeAllocationsFail&) = delete;
  static bool failed();  ///< whether one of this thread did, of the last or the one there is
};
