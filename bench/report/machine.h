// Facts about the machine and its load that a report's figures depend on.
#pragma once
#include <string>

#include "bench/report/report.h"
#include "device/devices.h"

namespace sundog {

/// Processor, logical cores, operating system, and the current load, clock and time (UTC).
Facts machine_facts();

/// The load average of the last minute.
std::string load_text();

/// "2893 to 2901 MHz": the cores' current clocks; empty if unknown.
std::string clock_text();

/// A sentence for the report if other programs use a good part of the processor, by the load average of the
/// last minute; otherwise empty.
std::string busy_note();

/// This program's compiler and its options, for figures of plain C++.
std::string compiler_text();

/// Whether PoCL compiles a kernel for each work-group size, by its variable POCL_WORK_GROUP_SPECIALIZATION.
std::string pocl_fact(const HostEnvironment& environment);

/// "0:0/1@1": the place of the device or of its part.
std::string device_place(const DeviceInfo& device);

/// "1:0 NVIDIA H200": the device in tables, plots and names of rows: its place, and its name without the
/// trademarks and versions that drivers add, 40 letters at most.
std::string device_title(const std::string& label, const std::string& name);
std::string device_title(const DeviceInfo& device);

/// Appends the facts about the device that a paper must state.
void add_device_row(Table& table, const DeviceInfo& device);

/// "0:0 platform / name, 2 compute units, driver 3.1". A sub-device counts its own units.
std::string device_fact(const DeviceInfo& device);

}  // namespace sundog
