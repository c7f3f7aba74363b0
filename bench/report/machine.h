// Facts about the machine and its load that a report's figures depend on.
#pragma once
#include <string>

#include "bench/report/report.h"
#include "device/devices.h"

namespace sundog {

/// Processor, logical cores, operating system, load when asked, and the time (UTC).
Facts machine_facts();

/// The load of the last minute.
std::string load_text();

/// "2893 to 2901 MHz": the cores' clocks now; empty where the system does not tell.
std::string clock_text();

/// A sentence for the reader of times that were taken while other programs had a good part of the processor;
/// empty where they had not. By the load of the last minute.
std::string busy_note();

/// The compiler of this program and its options, for figures of plain C++.
std::string compiler_text();

/// How PoCL compiles for work-group sizes, by the variable that it reads.
std::string pocl_fact(const HostEnvironment& environment);

/// "0:0/1@1": the device, or its part, by its place.
std::string device_place(const DeviceInfo& device);

/// "1:0 NVIDIA H200": what tables, plots and names of rows call a device: its place, and its name without the
/// marks and versions that drivers add.
std::string device_title(const std::string& label, const std::string& name);
std::string device_title(const DeviceInfo& device);

/// Appends what a paper must say of it.
void add_device_row(Table& table, const DeviceInfo& device);

/// "0:0 platform / name, 2 compute units, driver 3.1". Of a sub-device its own units.
std::string device_fact(const DeviceInfo& device);

}  // namespace sundog
