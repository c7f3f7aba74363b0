// Checks the system's limits on threads and stacks.
#pragma once
#include <cstddef>

namespace sundog {

/// Throws std::runtime_error, with the limit and the remedy, if there is no room for the threads of a driver
/// on this many processors and of a frame, with stacks of this size: drivers would abort or hang.
void check_thread_limits(unsigned processors, std::size_t stack);

}  // namespace sundog
