// Lanes, compiler options and definitions by device, chosen by the names that it reports: one table.
#pragma once
#include <span>
#include <string_view>

#include "device/devices.h"
#include "device/kernel_source.h"

namespace sundog {

/// A row of the table; the first row that matches a device decides.
struct DeviceRule {
  std::string_view name{};     // as in `sundog kernels --gpu`
  std::string_view reports{};  // in its vendor or platform
  bool of_gpus = false;        // only for the class gpu
  bool calls = false;          // its compiler keeps calls of functions
  // A work-item takes 16 rays in vectors (lanes), where the device reports vectors; otherwise one.
  bool vectors = false;
  std::string_view options{};    // for its compiler; definitions that kernels have defaults for
  std::string_view of_tracer{};  // of entry/trace_rays.cl, in place of options by the same name
  std::string_view of_lathes{};  // instead of these, if not empty, for scenes with lathes
  std::string_view of_paths{};   // of entry/render_path.cl, likewise
  std::string_view tries{};      // alternatives for `sundog tune`: options_to_try()
  bool matches(const DeviceInfo& device) const;
  /// The options that a program has in place of, or beside, the general ones.
  std::string_view of_program(const KernelText& text) const;
};

/// The last row matches every device.
std::span<const DeviceRule> device_rules();

const DeviceRule& rule_of(const DeviceInfo& device);

/// A GPU that matches that row, as far as programs depend on it. Throws UsageError with the known names.
DeviceInfo typical_gpu(std::string_view name);

}  // namespace sundog
