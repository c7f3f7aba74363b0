// `sundog devices`: lists every platform and device with its capabilities.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "app/options/command.h"
#include "app/options/devices.h"
#include "base/arguments.h"
#include "base/error.h"
#include "base/json_text.h"
#include "device/choice.h"
#include "device/devices.h"

namespace sundog {
namespace {

using nlohmann::json;

// The extensions that matter to kernels and launches; others are left out of the table.
constexpr std::array telling_extensions = {
    "cl_khr_fp16",       "cl_khr_fp64",           "cl_khr_int64_base_atomics", "cl_khr_subgroups",
    "cl_khr_il_program", "cl_khr_priority_hints", "cl_khr_device_uuid",        "cl_khr_pci_bus_info"};

std::vector<std::string> extensions_that_matter(const DeviceInfo& device) {
  std::vector<std::string> found;
  std::istringstream in(device.extensions);
  for (std::string name; in >> name;)
    if (std::ranges::count(telling_extensions, name) > 0) found.push_back(name);
  return found;
}

const char* class_name(DeviceClass value) { return value == DeviceClass::cpu ? "cpu" : "gpu"; }

const char* tracer_name(const DeviceInfo& device) { return wants_vectors(device) ? "wide" : "compact"; }

std::string bytes_text(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (bytes >= 1u << 30) return fmt::format("{:.1f} GiB", value / (1u << 30));
  if (bytes >= 1u << 20) return fmt::format("{:.1f} MiB", value / (1u << 20));
  return fmt::format("{:.0f} KiB", value / 1024);
}

/// The row of the device that a render without --device would use; null if there is none.
const DeviceInfo* default_device(const std::vector<DeviceInfo>& rows) {
  try {
    const DeviceInfo chosen = select_devices(rows, {}).front();
    const auto same = [&](const DeviceInfo& row) {
      return row.platform == chosen.platform && row.device == chosen.device;
    };
    return &*std::ranges::find_if(rows, same);
  } catch (const DeviceError&) {
    return nullptr;
  }
}

json device_json(const DeviceInfo& device, bool is_default) {
  json row = {{"platform", device.platform},
              {"platform_name", device.platform_name},
              {"platform_version", device.platform_version},
              {"usable", device.usable()},
              {"problem", device.problem.empty() ? json(nullptr) : json(device.problem)}};
  if (device.device < 0) return row;
  row.update({{"index", device.place()},
              {"device", device.device},
              {"name", device.name},
              {"vendor", device.vendor},
              {"driver", device.driver},
              {"version", device.version},
              {"c_version", device.c_version},
              {"type", device.type},
              {"class", class_name(device.device_class)},
              {"tracer", tracer_name(device)},
              {"compute_units", device.compute_units},
              {"clock_mhz", device.clock_mhz},
              {"native_vector_width", device.native_vector_width},
              {"preferred_vector_width", device.preferred_vector_width},
              {"global_memory", device.global_memory},
              {"max_allocation", device.max_allocation},
              {"local_memory", device.local_memory},
              {"cache", device.cache},
              {"max_work_group", device.max_work_group},
              {"max_sub_devices", device.max_sub_devices},
              {"timer_resolution_ns", device.timer_resolution_ns},
              {"host_unified_memory", device.host_unified_memory},
              {"little_endian", device.little_endian},
              {"compiler_available", device.compiler_available},
              {"available", device.available},
              {"extensions", extensions_that_matter(device)},
              {"estimate", device.estimate},
              {"default", is_default}});
  return row;
}

void print_details(const DeviceInfo& device) {
  const auto line = [](const char* what, const std::string& value) {
    fmt::print("      {:<12} {}\n", what, value);
  };
  line("type", fmt::format("{}, {} compute unit{} at {} MHz, vectors of {} floats (prefers {})", device.type,
                           device.compute_units, device.compute_units == 1 ? "" : "s", device.clock_mhz,
                           device.native_vector_width, device.preferred_vector_width));
  line("class", fmt::format("{}, tracer {} ({})", class_name(device.device_class), tracer_name(device),
                            wants_vectors(device) ? "many rays a work-item, in vectors" : "a ray a lane"));
  line("memory", fmt::format("{}, at most {} in one buffer, {} local", bytes_text(device.global_memory),
                             bytes_text(device.max_allocation), bytes_text(device.local_memory)));
  line("limits", fmt::format("work-groups of {}, {}", device.max_work_group,
                             device.max_sub_devices > 1
                                 ? fmt::format("{} sub-devices (--device {}:{}/N)", device.max_sub_devices,
                                               device.platform, device.device)
                                 : "no sub-devices"));
  line("language", fmt::format("{}; {}", device.c_version, device.version));
  line("driver", device.driver);
  line("extensions", fmt::format("{}", fmt::join(extensions_that_matter(device), " ")));
  line("estimate", fmt::format("{:.0f}", device.estimate));
}

void print_table(const std::vector<DeviceInfo>& rows, const DeviceInfo* chosen) {
  int platform = -1;
  for (const DeviceInfo& row : rows) {
    if (row.platform != platform)
      fmt::print("{} {} ({})\n", row.platform, row.platform_name, row.platform_version);
    platform = row.platform;
    if (row.device >= 0)
      fmt::print("  {}:{} {}{}\n", row.platform, row.device, row.name,
                 &row == chosen ? "  [the default]" : "");
    if (!row.problem.empty()) fmt::print("      not usable: {}\n", row.problem);
    if (row.device >= 0) print_details(row);
  }
}

/// Prints a table, or a JSON object of schema 1. A list without usable devices is no error.
int list(bool as_json) {
  const std::vector<DeviceInfo> rows = list_devices();
  const DeviceInfo* chosen = default_device(rows);
  if (as_json) {
    json all = json::array();
    for (const DeviceInfo& row : rows) all.push_back(device_json(row, &row == chosen));
    fmt::print("{}\n", json_text(json{{"schema", 1}, {"devices", all}}, 2));
  } else if (rows.empty()) {
    fmt::print("There is no OpenCL platform: install one (Debian: pocl-opencl-icd).\n");
  } else {
    print_table(rows, chosen);
  }
  return exit_done;
}

}  // namespace

void add_devices(Arguments& root, Command& chosen) {
  const auto as_json = std::make_shared<bool>(false);
  Arguments* app = root.add_subcommand("devices", "List every OpenCL platform and device");
  app->add_flag("--json", *as_json, "as JSON");
  app->callback([as_json, &chosen] {
    chosen = {.run = [as_json] { return list(*as_json); }, .in_first_thread = true, .only_prints = true};
  });
}

}  // namespace sundog
