// The system's limits on threads and on their stacks.
#pragma once
#include <cstddef>

namespace sundog {

/// Throws std::runtime_error, with the limit and the mend, where the limits leave no room for the threads of
/// a driver that runs on so many processors and for those of a frame, with stacks of so many bytes each:
/// drivers end the process then, or wait for ever.
void check_thread_limits(unsigned processors, std::size_t stack);

}  // namespace sundog
