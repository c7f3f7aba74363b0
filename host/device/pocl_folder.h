// A folder of its own for what PoCL writes. Internal to the device layer.
#pragma once
#include <string>

#include "device/devices.h"

namespace sundog {

struct HostEnvironment;

bool is_pocl(const DeviceInfo& device);

/// PoCL keeps compiled kernels in a folder that all its processes share, and aborts the process when a file
/// there is damaged. Sundog's own cache holds the same binaries behind a checksum, so each process gives PoCL
/// an empty folder, "pocl/*" in the cache, which goes at its end; those of processes that were killed
/// go too. Where the cache cannot be written it is one among the temporary files: PoCL has no device without
/// a folder. A POCL_CACHE_DIR that the user set stays. To be called before the first OpenCL call; never
/// throws.
void give_pocl_a_folder(const HostEnvironment& environment) noexcept;

/// Removes it before a process ends by _exit(). PoCL may end the process when one of its threads is at work.
void remove_pocl_folder() noexcept;

/// What keeps PoCL from writing what it compiles, and the mend, for the end of a message; empty: nothing
/// known. It needs to be asked before: PoCL ends the process, or says nothing of it.
std::string pocl_folder_problem(const HostEnvironment& environment);

}  // namespace sundog
