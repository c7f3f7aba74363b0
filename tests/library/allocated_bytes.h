// Counts what a program and its libraries allocate by `new`.
#pragma once
#include <cstddef>

/// The bytes that were allocated since it was made, by any thread, those that were given back too.
class AllocatedBytes {
 public:
  AllocatedBytes();
  std::size_t count() const;

 private:
  std::size_t before_;
};
