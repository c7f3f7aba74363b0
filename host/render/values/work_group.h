// The local size (work-group) of the render kernels.
#pragma once
#include <cstddef>

namespace sundog {

/// Automatic (the default), the driver's choice, or a fixed size.
struct WorkGroup {
  enum class Kind { automatic, driver, fixed } kind = Kind::automatic;
  std::size_t x = 64, y = 1;
  friend bool operator==(const WorkGroup&, const WorkGroup&) = default;
};

}  // namespace sundog
