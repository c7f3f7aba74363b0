// Which OpenCL devices there are, what each can do, and which ones a --device SPEC means.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sundog {

class DriverThreads;
struct HostEnvironment;

/// How a device wants to be fed (design: by what it reports, never by its name).
enum class DeviceClass { cpu, gpu };  // explicit vectors in a work-item; one ray a lane

/// What one device reports. A row exists for every device, and for every platform that has none (device =
/// -1).
struct DeviceInfo {
  int platform = 0, device = -1;  // as `clinfo -l` prints them
  std::string platform_name, platform_version, name, vendor, driver, version, c_version, extensions;
  std::string type;  // "cpu", "gpu", "accelerator", "custom"
  unsigned compute_units = 0, clock_mhz = 0, native_vector_width = 0, preferred_vector_width = 0;
  std::uint64_t global_memory = 0, max_allocation = 0, local_memory = 0, cache = 0;
  std::size_t max_work_group = 0, timer_resolution_ns = 0;
  unsigned max_sub_devices = 0;
  bool little_endian = true, compiler_available = true, available = true, host_unified_memory = false;
  DeviceClass device_class = DeviceClass::cpu;
  std::string problem;      // empty: usable
  double estimate = 0;      // relative speed (estimate.cpp): for the default choice
  unsigned sub_units = 0;   // not 0: a sub-device of that many compute units was asked for (/N)
  unsigned first_unit = 0;  // of a sub-device, where earlier ones of the same device take the units before
  std::string identity;  // the same in every process that sees it: its UUID or place on the bus; often empty
  int rank = 0;          // of the process that has it, in a job of several
  std::string host;      // that process's machine; empty: there is only this process
  void* handle = nullptr;                                // cl_device_id
  std::shared_ptr<const HostEnvironment> environment{};  // what enumerate_devices() was given
  std::weak_ptr<DriverThreads> threads{};                // takes over those that its driver has not let go of
  std::shared_ptr<void> context{};                       // share_context()'s; null: each Device has its own

  bool usable() const { return problem.empty() && device >= 0; }
  /// "0:1 Portable Computing Language / pthread-...", with "/2" for a sub-device of two units, "/2@4" where
  /// they begin with unit 4, and behind it "(rank 1 on node7)" in a job of several.
  std::string label() const;
};

/// Every platform and device, each failure a row with its `problem`; never throws for one driver. Drivers'
/// own settings are those of a process's first call.
std::vector<DeviceInfo> enumerate_devices(const std::shared_ptr<const HostEnvironment>& environment);

/// The devices that `specs` mean, in the order first matched, without doubles. No specs: the usable device
/// with the greatest estimate. Grammar: P:D | cpu | gpu | accelerator | all | part of "platform/device" (any
/// case) or a name that people use (pocl, nvidia, intel, amd), each with /N, or !SPEC, or !SPEC? for what may
/// be missing. A /N takes the next units of each device that has them. Throws DeviceError with the list of
/// candidates when nothing matches, no match can give a /N or a !SPEC takes nothing away, UsageError for a
/// malformed SPEC. `warnings` takes what else was likely meant otherwise: a device without the units.
std::vector<DeviceInfo> select_devices(std::span<const DeviceInfo> all, const std::vector<std::string>& specs,
                                       std::vector<std::string>* warnings = nullptr);

}  // namespace sundog
