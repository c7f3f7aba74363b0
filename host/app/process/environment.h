// Creates the HostEnvironment (base/environment.h) that this program passes to the layers below.
#pragma once
#include <memory>

#include "base/driver_threads.h"
#include "base/environment.h"

namespace sundog {

/// Read at the first call, before a command starts threads. Throws UsageError for a malformed SUNDOG_FAULTS.
const EnvironmentPtr& program_environment();

/// The threads left in drivers. While there are any, the process must end by _exit(), because static
/// destructors and drivers' exit handlers would destroy what these threads use.
const std::shared_ptr<DriverThreads>& driver_threads();

}  // namespace sundog
