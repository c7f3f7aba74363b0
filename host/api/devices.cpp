// Converts the host's device list to public Devices, and owns the threads that drivers keep.
#include "api/impl.h"

#include <unistd.h>

#include <cstdlib>

namespace sundog {
inline namespace v0 {
namespace {

Device device_of(DeviceInfo info) {
  Device device;
  device.label = info.label();
  device.platform = info.platform;
  device.index = info.device;
  device.platform_name = info.platform_name;
  device.name = info.name;
  device.vendor = info.vendor;
  device.driver = info.driver;
  device.type = info.type;
  device.compute_units = info.sub_units > 0 ? info.sub_units : info.compute_units;
  device.global_memory = info.global_memory;
  device.estimate = info.estimate;
  device.usable = info.usable();
  device.problem = info.problem;
  device.handle = std::make_shared<const Device::Handle>(Device::Handle{std::move(info)});
  return device;
}

/// The process's environment variables, listed in docs/guide/library.md.
const EnvironmentPtr& environment() {
  static const EnvironmentPtr read = sundog::plain_environment();
  return read;
}

/// Owns the threads that drivers keep. Created after the drivers are loaded, hence waited for before they are
/// unloaded at the end of the process; never destroyed, because a session may end later.
const std::shared_ptr<DriverThreads>& threads_of_process() {
  static const auto& threads = *[] {
    std::atexit([] { wait_for_threads(); });
    return new const auto(std::make_shared<DriverThreads>());
  }();
  return threads;
}

/// The id of the process that called first.
int process_of_threads() noexcept {
  static const int process = ::getpid();
  return process;
}

std::vector<Device> devices_of_host(const std::vector<DeviceInfo>& all) {
  std::vector<Device> result;
  result.reserve(all.size());
  for (const DeviceInfo& info : all) result.push_back(device_of(info));
  return result;
}

}  // namespace

bool is_forked() noexcept { return process_of_threads() != ::getpid(); }

void wait_for_threads_at_exit() noexcept {
  const auto& threads = threads_of_process();
  if (!is_forked() && threads && threads->count() > 0) std::atexit([] { threads_of_process()->wait(); });
}

void enter_threads() {
  if (is_forked())
    throw UsageError(
        "this process was forked from one that had used sundog, and has none of its threads: begin processes "
        "by spawn, as Python's multiprocessing.get_context(\"spawn\") does, or before sundog is first used");
}

std::vector<Device> devices() {
  return translated([] {
    enter_threads();
    return devices_of_host(enumerate_devices(environment()));
  });
}

std::vector<Device> choose_devices(const std::vector<std::string>& specs,
                                   std::vector<std::string>* warnings) {
  return translated([&] {
    enter_threads();
    const std::vector<DeviceInfo> all = enumerate_devices(environment());
    return devices_of_host(select_devices(all, specs, warnings));
  });
}

void wait_for_threads() noexcept {
  if (!is_forked()) threads_of_process()->wait();
}

unsigned threads_left_behind() { return is_forked() ? 0 : threads_of_process()->count(); }

std::vector<DeviceInfo> devices_of(const std::vector<Device>& devices) {
  enter_threads();
  std::vector<DeviceInfo> result;
  if (devices.empty()) result = select_devices(enumerate_devices(environment()), {});
  for (const Device& device : devices) {
    if (!device.handle) throw UsageError("a device wants to come from devices() or choose_devices()");
    if (!device.usable) throw DeviceError(device.label + ": " + device.problem);
    result.push_back(device.handle->info);
  }
  for (DeviceInfo& info : result) info.threads = threads_of_process();
  return result;
}

core::WorkGroup group_of(const WorkGroup& group) {
  if (group.driver) return {.kind = core::WorkGroup::Kind::driver};
  if (group.x == 0) return {};
  if (group.y == 0) throw UsageError("a work-group wants one work-item or more each way");
  return {.kind = core::WorkGroup::Kind::fixed, .x = group.x, .y = group.y};
}

int tile_of(int tile) {
  if (tile < 0) throw UsageError("a tile wants an edge of 1 pixel or more, or 0 for one that is chosen");
  return tile;
}

double seconds_of(const char* name, double seconds) {
  if (!(seconds >= 0)) throw UsageError(std::string(name) + ": wanted seconds, 0 or more");
  return seconds;
}

}  // namespace v0
}  // namespace sundog
