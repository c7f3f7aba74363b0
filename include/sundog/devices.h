// Lists and selects the machine's OpenCL devices.
#pragma once
#include <sundog/version.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sundog {
inline namespace v0 {

/// An OpenCL device as its driver reports it. Returned by devices() and choose_devices(); copies refer to the
/// same device. A driver cannot be interrupted: when a render is stopped, a thread in a driver's compiler
/// keeps running. The process waits for such threads at its exit, up to a minute, then detaches them.
struct Device {
  std::string label{};              ///< "0:1 Portable Computing Language / cpu-..."
  int platform = 0;                 ///< as `clinfo -l` numbers them, from 0
  int index = -1;                   ///< in its platform, from 0; -1: a platform without devices
  std::string platform_name{};      ///< reported by the platform
  std::string name{};               ///< reported by the device
  std::string vendor{};             ///< reported by the device
  std::string driver{};             ///< the driver's version
  std::string type{};               ///< "cpu", "gpu", "accelerator", "custom"
  unsigned compute_units = 0;       ///< of the sub-device, if it is one
  std::uint64_t global_memory = 0;  ///< bytes
  double estimate = 0;              ///< estimated relative speed; decides the default device
  bool usable = false;              ///< false: it cannot render; `problem` says why
  std::string problem{};            ///< why the device is unusable; empty if usable

  struct Handle;
  std::shared_ptr<const Handle> handle{};  ///< internal; null: not made by this library
};

/// Returns every device, and an entry for each platform without devices; a device that fails has a `problem`.
/// Thread-safe; the first call loads the drivers (about 1 s). Throws Error (internal) only if out of memory.
SUNDOG_API std::vector<Device> devices();

/// Returns the devices that match `specs`, each once; without specs, the device estimated fastest. A spec is
/// "P:D" (indices), "cpu", "gpu", "accelerator", "all", part of "platform/device" (case-insensitive), or
/// "pocl", "nvidia", "intel", "amd"; suffix "/N" selects a sub-device of N units; "!SPEC" excludes devices
/// ("!SPEC?": if there are any). Throws Error: device if a spec matches or excludes nothing, usage for a
/// malformed spec. `warnings`, if given, receives a line for each spec that looks mistaken. Thread-safe.
SUNDOG_API std::vector<Device> choose_devices(const std::vector<std::string>& specs = {},
                                              std::vector<std::string>* warnings = nullptr);

/// Returns the number of threads that are still inside drivers: they compile for a stopped render, or hang.
/// While it is above 0, exit() waits for them, up to a minute; _exit() does not. Thread-safe.
SUNDOG_API unsigned threads_left_behind();
/// Returns the same number for any devices, since the threads belong to the process.
inline unsigned threads_left_behind(const std::vector<Device>&) { return threads_left_behind(); }

/// Waits for these threads now, up to a minute, then detaches them. Call it before exit() if the process may
/// end during its first compilation: a driver's compiler creates static objects as it runs, and exit()
/// destroys the newest first. Thread-safe.
SUNDOG_API void wait_for_threads() noexcept;

}  // namespace v0
}  // namespace sundog
