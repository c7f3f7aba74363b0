// Signed distance fields on a device, for tests.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "catch.h"
#include "compile/fields/sdf.h"
#include "default_field.h"
#include "devices.h"

/// Builds `text`, which includes lib/sdf/..., for the fields, with LANES lanes.
inline sundog::Program build_fields(sundog::Device& device, const std::string& text,
                                    const sundog::CompiledFields& fields, int lanes, bool two_sided = false) {
  sundog::KernelDefines defines{{"LANES", std::to_string(lanes)}, {"SDF_TWO_SIDED", two_sided ? "1" : "0"}};
  defines.merge(all_features());
  return device.build("test.cl", defines, nullptr, {{"test.cl", text}, {"generated/sdf.cl", fields.source}});
}

/// All surfaces of the list with their defaults.
inline std::vector<sundog::SdfDescription> listed_fields() {
  std::vector<sundog::SdfDescription> fields;
  for (const auto& definition : sundog::formula_list()) fields.push_back(sundog::default_field(definition));
  return fields;
}

inline sundog::SdfDescription listed_field(const std::string& name) {
  const auto* definition = sundog::find_formula(name);
  REQUIRE(definition != nullptr);
  return sundog::default_field(*definition);
}

/// Devices whose compilers are fast enough for a program of all the listed formulas.
inline bool is_quick(const sundog::DeviceInfo& info) {
  return info.platform_name.find("Portable") != std::string::npos;
}

/// Lanes of a work-item as the renderer would choose them.
inline int usual_lanes(const sundog::DeviceInfo& info) { return is_quick(info) ? 16 : 1; }
