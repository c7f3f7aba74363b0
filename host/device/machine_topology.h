// The machine's processors and memory for drivers that cannot read them from /sys. Internal to the device
// layer, but for the note.
#pragma once
#include <string>

namespace sundog {

struct HostEnvironment;

/// PoCL asks the library hwloc for the machine, which reads /sys; where that is not mounted, as in a minimal
/// chroot, PoCL finds no memory and aborts the process. There hwloc is given the figures that the system
/// calls tell, by its variable HWLOC_SYNTHETIC; what the user set for hwloc stays. Before the first OpenCL
/// call.
void describe_machine_to_drivers(const HostEnvironment& environment);

/// Why the figures had to be given, and the mend; empty where /sys is there.
std::string topology_note();

}  // namespace sundog
