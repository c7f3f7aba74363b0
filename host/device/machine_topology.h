// Describes the machine to drivers that cannot read /sys. Internal to the device layer, except for the note.
#pragma once
#include <string>

namespace sundog {

struct HostEnvironment;

/// PoCL uses the library hwloc, which reads /sys. Without /sys, as in a minimal chroot, PoCL finds no memory
/// and aborts. This passes hwloc the numbers from system calls in its variable HWLOC_SYNTHETIC, unless the
/// user has set hwloc's variables. Call before the first OpenCL call.
void describe_machine_to_drivers(const HostEnvironment& environment);

/// Why hwloc needed these numbers, and the remedy; empty if /sys is mounted.
std::string topology_note();

}  // namespace sundog
