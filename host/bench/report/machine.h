// What a report must say about the machine for its figures to mean anything.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "device/devices.h"

namespace sundog {

using Facts = std::vector<std::pair<std::string, std::string>>;

/// Processor, logical cores, operating system, load when asked, and the time (UTC).
Facts machine_facts();

/// A sentence for the reader of times that were taken while other programs had a good part of the processor;
/// empty where they had not. By the load of the last minute.
std::string busy_note();

/// The compiler of this program and its options, for figures of plain C++.
std::string compiler_text();

/// How PoCL compiles for work-group sizes, by the variable that it reads.
std::string pocl_fact(const HostEnvironment& environment);

/// "0:0 platform / name, 2 compute units, driver 3.1".
std::string device_fact(const DeviceInfo& device);

}  // namespace sundog
