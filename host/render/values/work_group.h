// Local size of the render kernels.
#pragma once
#include <cstddef>

namespace sundog {

/// The default, the driver's choice, or the user's size.
struct WorkGroup {
  enum class Kind { automatic, driver, fixed } kind = Kind::automatic;
  std::size_t x = 64, y = 1;
  friend bool operator==(const WorkGroup&, const WorkGroup&) = default;
};

}  // namespace sundog
