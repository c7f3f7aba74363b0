// Makes the HostEnvironment (base/environment.h) that this program passes to the layers below.
#pragma once
#include <memory>

#include "base/driver_threads.h"
#include "base/environment.h"
#include "scene/load.h"

namespace sundog {

/// Read at the first call, which a command makes before it has threads. Throws UsageError for SUNDOG_FAULTS
/// that are none.
const EnvironmentPtr& program_environment();

/// The threads that drivers have not let go of. While there are any, the process ends by _exit(): what static
/// destructors and drivers' exit handlers take down is in use.
const std::shared_ptr<DriverThreads>& driver_threads();

/// The options, with the standard input for a scene named "-".
LoadOptions with_streams(LoadOptions options);

}  // namespace sundog
