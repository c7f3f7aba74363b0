// A private folder for drivers' files. Internal to the device layer.
#pragma once
#include <string>

#include "device/devices.h"

namespace sundog {

struct HostEnvironment;

bool is_pocl(const DeviceInfo& device);

/// PoCL keeps compiled kernels in a folder that its processes share, and aborts if a file there is damaged.
/// sundog's own cache holds the same binaries with a checksum, so each process gives PoCL an empty folder,
/// "pocl/*" in the cache, removed at exit; folders of killed processes are removed too. If the cache is not
/// writable, it is a temporary folder: PoCL has no device without a folder, and Mesa, which then uses it too,
/// would recompile a kernel for each launch. Keeps a POCL_CACHE_DIR or MESA_SHADER_CACHE_DIR set by the user.
class DriverFolder {
 public:
  /// Create before the first OpenCL call; never throws.
  explicit DriverFolder(const HostEnvironment& environment) noexcept;
  /// Runs after PoCL's own cleanup if created before PoCL was loaded.
  ~DriverFolder() { remove(); }
  DriverFolder(const DriverFolder&) = delete;
  DriverFolder& operator=(const DriverFolder&) = delete;

  /// For a process that ends by _exit(). PoCL may abort if one of its threads is still working.
  void remove() const noexcept;
  /// Why PoCL cannot write its files, and the remedy, to end a message with; empty if no problem is known.
  /// Call before using PoCL, which would abort or fail silently.
  std::string problem(const HostEnvironment& environment) const;

 private:
  std::string own_;    // empty: drivers use the user's folder or their own
  const int process_;  // owner; a child of fork() leaves the folder alone
};

/// The process's folder, created by the first call: drivers read their settings once.
const DriverFolder& driver_folder(const HostEnvironment& environment);

}  // namespace sundog
