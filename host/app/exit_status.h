// What goes wrong becomes one line on stderr and an exit status: the one place that catches everything.
#pragma once
#include <functional>

namespace sundog {

/// Runs the command; its status, or, when it throws, that of the error, which is printed if `speaks`.
int exit_status_of(const std::function<int()>& command, bool speaks = true);

}  // namespace sundog
