// A folder of its own for what drivers write. Internal to the device layer.
#pragma once
#include <string>

#include "device/devices.h"

namespace sundog {

struct HostEnvironment;

bool is_pocl(const DeviceInfo& device);

/// PoCL keeps compiled kernels in a folder that all its processes share, and aborts the process when a file
/// there is damaged. Sundog's own cache holds the same binaries behind a checksum, so each process gives PoCL
/// an empty folder, "pocl/*" in the cache, which is removed at its end; those of processes that were killed
/// are removed too. Where the cache cannot be written it is one among the temporary files: PoCL has no device
/// without a folder, and Mesa, which gets it then too, compiles a kernel anew for each launch. A
/// POCL_CACHE_DIR or MESA_SHADER_CACHE_DIR that the user set stays.
class DriverFolder {
 public:
  /// To be made before the first OpenCL call; never throws.
  explicit DriverFolder(const HostEnvironment& environment) noexcept;
  /// After PoCL's own end, where it was made before PoCL was loaded.
  ~DriverFolder() { remove(); }
  DriverFolder(const DriverFolder&) = delete;
  DriverFolder& operator=(const DriverFolder&) = delete;

  /// For a process that ends by _exit(). PoCL may end the process when one of its threads is at work.
  void remove() const noexcept;
  /// What keeps PoCL from writing what it compiles, and the mend, for the end of a message; empty: nothing
  /// known. It needs to be asked before: PoCL ends the process, or says nothing of it.
  std::string problem(const HostEnvironment& environment) const;

 private:
  std::string own_;    // empty: drivers have the user's, or their own
  const int process_;  // whose folder it is: a child that fork() has made leaves it alone
};

/// The process's own, which the first call makes: drivers take their settings once a process.
const DriverFolder& driver_folder(const HostEnvironment& environment);

}  // namespace sundog
