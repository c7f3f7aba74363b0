// Sets HWLOC_SYNTHETIC to one node with all processors and memory, unless hwloc finds /sys or the user
// describes the machine.
#include "device/machine_topology.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <thread>

#include "base/environment.h"

namespace sundog {
namespace {

/// Whether hwloc can find processors; any of these files is enough.
bool has_topology() {
  for (const char* folder : {"/sys/bus/cpu/devices", "/sys/devices/system/cpu"})
    for (const char* file : {"package_cpus", "core_cpus", "core_siblings", "thread_siblings"})
      if (::access(fmt::format("{}/cpu0/topology/{}", folder, file).c_str(), R_OK) == 0) return true;
  return false;
}

bool user_describes_machine(const HostEnvironment& environment) {
  for (const char* variable : {"HWLOC_SYNTHETIC", "HWLOC_XMLFILE", "HWLOC_FSROOT"})
    if (environment.drivers.contains(variable)) return true;
  return false;
}

/// One NUMA node and its processors, in hwloc's syntax.
std::string synthetic_machine() {
  const auto pages = std::max(0L, ::sysconf(_SC_PHYS_PAGES)), page = std::max(0L, ::sysconf(_SC_PAGESIZE));
  return fmt::format("numa:1(memory={}) pu:{}",
                     static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page),
                     std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace

void describe_machine_to_drivers(const HostEnvironment& environment) {
  if (!has_topology() && !user_describes_machine(environment))
    set_variable("HWLOC_SYNTHETIC", synthetic_machine());
}

std::string topology_note() {
  if (has_topology()) return "";
  return "/sys, where drivers read of processors and memory, is not mounted here: sundog describes the "
         "machine to "
         "PoCL, which would end the process otherwise; other programs need: mount -t sysfs sysfs /sys";
}

}  // namespace sundog
