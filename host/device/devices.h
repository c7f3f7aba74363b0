// Enumerates OpenCL devices and their capabilities, and selects those that a --device SPEC matches.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sundog {

class DriverThreads;
struct HostEnvironment;

/// The kind of kernel that suits a device (by what it reports, never by its name).
enum class DeviceClass { cpu, gpu };  // explicit vectors in a work-item; one ray per lane

/// A device as its driver reports it. A platform without devices has a row too, with device = -1.
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
  double estimate = 0;      // relative speed (estimate.cpp), decides the default
  unsigned sub_units = 0;   // not 0: a sub-device of that many compute units (/N)
  unsigned first_unit = 0;  // offset of a sub-device, after earlier ones of the same device
  std::string identity;  // equal in every process that sees the device: its UUID or bus address; often empty
  int rank = 0;          // rank of the process that owns it in a job
  std::string host;      // that process's host; empty: there is only one process
  void* handle = nullptr;                                // cl_device_id
  std::shared_ptr<const HostEnvironment> environment{};  // passed to enumerate_devices()
  std::weak_ptr<DriverThreads> threads{};                // takes over threads left in its driver
  std::shared_ptr<void> context{};  // from share_context(); null: each Device has its own

  /// Whether other devices of its machine may run on the same cores. A sub-device has its own cores.
  bool shares_cores() const { return type == "cpu" && sub_units == 0; }
  bool usable() const { return problem.empty() && device >= 0; }
  /// "0:1"; for a sub-device, the whole device's place.
  std::string place() const;
  /// "0:1", or "0:1/2" for a sub-device of two units: a SPEC for select_devices() that selects it.
  std::string spec() const;
  /// "0:1 Portable Computing Language / pthread-...", with "/2" for a sub-device of two units, "/2@4" if they
  /// start at unit 4, and "(rank 1 on node7)" in a job of several processes.
  std::string label() const;
};

/// Lists every platform and device; failures become a row's `problem`, and no driver makes it throw. Drivers'
/// settings are taken from the first call in a process.
std::vector<DeviceInfo> enumerate_devices(const std::shared_ptr<const HostEnvironment>& environment);

/// The devices that match `specs`, in the order first matched, without duplicates. Without specs: the usable
/// device with the highest estimate. Grammar: P:D | cpu | gpu | accelerator | all | part of "platform/device"
/// (case-insensitive) or a common name (pocl, nvidia, intel, amd), each with /N; or !SPEC, or !SPEC? if it
/// may be missing. /N takes the next units of each device that has them. Throws DeviceError with the list of
/// candidates if nothing matches, no match can provide /N, or a !SPEC excludes nothing; UsageError for a
/// malformed SPEC. `warnings` receives other likely mistakes, such as a device without the units.
std::vector<DeviceInfo> select_devices(std::span<const DeviceInfo> all, const std::vector<std::string>& specs,
                                       std::vector<std::string>* warnings = nullptr);

/// The rows that match one of `specs`, and no !SPEC, but are not usable. UsageError for a malformed SPEC.
std::vector<DeviceInfo> unusable_devices(std::span<const DeviceInfo> all,
                                         const std::vector<std::string>& specs);

}  // namespace sundog
