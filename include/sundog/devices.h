// The machine's OpenCL devices.
#pragma once
#include <sundog/version.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace sundog {
inline namespace v0 {

/// What a device reports. Made by devices() and choose_devices(); copies are the same device. A driver cannot
/// be interrupted: when a picture is stopped, the thread that is in a driver's compiler stays there, and
/// belongs to the devices that were listed together. The last copy of the last of them waits for it, as long
/// as a minute; a driver that has not returned then hangs, and its thread is detached.
struct Device {
  std::string label{};          ///< "0:1 Portable Computing Language / cpu-..."
  int platform = 0;             ///< as `clinfo -l` numbers them, from 0
  int index = -1;               ///< of the device in its platform, from 0; -1: a platform without a device
  std::string platform_name{};  ///< as the platform reports it
  std::string name{};           ///< as the device reports it
  std::string vendor{};         ///< as the device reports it
  std::string driver{};         ///< the driver's version
  std::string type{};           ///< "cpu", "gpu", "accelerator", "custom"
  unsigned compute_units = 0;   ///< of a sub-device, those that it has
  std::uint64_t global_memory = 0;  ///< bytes
  double estimate = 0;              ///< relative speed, by which the default device is chosen
  bool usable = false;              ///< whether it can render; `problem` says why not
  std::string problem{};            ///< why it is not usable; empty where it is

  struct Handle;
  std::shared_ptr<const Handle> handle{};  ///< the library's own; null: not made by this library
};

/// Every device, and each platform that has none; one that fails has a `problem`. Any thread; the first call
/// loads the drivers, which can take a second. Throws Error (internal) for want of memory or of threads only.
SUNDOG_API std::vector<Device> devices();

/// The devices that `specs` mean, each once. No spec: the one estimated fastest. A spec is "P:D" (indices),
/// "cpu", "gpu", "accelerator", "all", a part of "platform/device" in any case, or "pocl", "nvidia", "intel",
/// "amd", each with "/N" for a sub-device of N units, or "!SPEC" to leave out ("!SPEC?": if it is there).
/// Throws Error: device where nothing matches or is left out, usage for another text. `warnings`, when given,
/// gets what was likely meant otherwise. Any thread.
SUNDOG_API std::vector<Device> choose_devices(const std::vector<std::string>& specs = {},
                                              std::vector<std::string>* warnings = nullptr);

/// How many threads drivers have not let go of, of these devices and of those listed with them: they compile
/// for a picture that was stopped, or hang. While there are any, end the process by _exit(), because static
/// destructors would take away what they use. Any thread.
SUNDOG_API unsigned threads_left_behind(const std::vector<Device>& devices);

}  // namespace v0
}  // namespace sundog
