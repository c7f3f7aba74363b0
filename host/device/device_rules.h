// A table of lanes, compiler options and definitions for each kind of device, found by the names it reports.
#pragma once
#include <array>
#include <span>
#include <string_view>

#include "device/devices.h"
#include "device/kernel_source.h"

namespace sundog {

/// A program's own options, by its entry.
struct ProgramOptions {
  std::string_view entry{}, options{};
};

/// A row of the table; the first row that matches a device decides.
struct DeviceRule {
  std::string_view name{};     // accepted by `sundog kernels --gpu`
  std::string_view reports{};  // part of the vendor's or platform's name
  bool of_gpus = false;        // matches only devices of the class gpu
  bool calls = false;          // the compiler keeps function calls
  // A work-item takes 16 rays in vectors (lanes) if the device reports vectors; otherwise one.
  bool vectors = false;
  std::string_view options{};  // compiler options, and definitions that override the kernels' defaults
  std::array<ProgramOptions, 3> of_programs{};  // add to `options` and replace those of the same name
  std::string_view tries_compact{};             // alternatives for `sundog tune` in the compact tracer, and
  std::string_view tries{};                     // in every program: options_to_try()
  bool matches(const DeviceInfo& device) const;
  std::string_view of_program(const KernelText& text) const;
};

/// The last row matches every device.
std::span<const DeviceRule> device_rules();

const DeviceRule& rule_of(const DeviceInfo& device);

/// A GPU that matches the row of that name, with only the properties that programs depend on. Throws
/// UsageError with the known names.
DeviceInfo typical_gpu(std::string_view name);

}  // namespace sundog
