// Reads /proc/cpuinfo, uname() and getloadavg(); a fact that cannot be read is "unknown" or empty.
#include "bench/report/machine.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <regex>
#include <thread>

#include "base/environment.h"

namespace sundog {
namespace {

std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name"))
      if (const std::size_t colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  return "unknown";
}

std::string system_name() {
  utsname names{};
  return ::uname(&names) == 0 ? fmt::format("{} {}, {}", names.sysname, names.release, names.machine)
                              : "unknown";
}

std::string time_text() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &parts);
  return text.data();
}

unsigned units_of(const DeviceInfo& device) {
  return device.sub_units > 0 ? device.sub_units : device.compute_units;
}

}  // namespace

Facts machine_facts() {
  return {{"processor",
           fmt::format("{}, {} logical cores", processor_name(), std::thread::hardware_concurrency())},
          {"system", system_name()},
          {"load before", load_text()},
          {"clock before", clock_text()},
          {"time", time_text()}};
}

std::string load_text() {
  std::array<double, 1> load{};
  return ::getloadavg(load.data(), 1) == 1 ? fmt::format("{:.1f}", load[0]) : "unknown";
}

std::string clock_text() {
  std::ifstream in("/proc/cpuinfo");
  std::vector<double> clocks;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("cpu MHz"))
      if (const std::size_t colon = line.find(": "); colon != std::string::npos)
        clocks.push_back(std::strtod(line.c_str() + colon + 2, nullptr));
  if (clocks.empty()) return {};
  const auto [least, most] = std::ranges::minmax(clocks);
  return fmt::format("{:.0f} to {:.0f} MHz", least, most);
}

std::string busy_note() {
  constexpr double disturbing = 0.25;  // of a core, for each core
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  std::array<double, 1> load{};
  if (::getloadavg(load.data(), 1) != 1 || load[0] < disturbing * cores) return {};
  return fmt::format(
      "Other programs were using the machine before the start (load {:.1f} on {} logical cores): times may "
      "be longer and vary more than on an idle machine.",
      load[0], cores);
}

std::string compiler_text() { return fmt::format("{} ({})", SUNDOG_COMPILER, SUNDOG_COMPILER_OPTIONS); }

std::string pocl_fact(const HostEnvironment& environment) {
  const std::string value = environment.driver("POCL_WORK_GROUP_SPECIALIZATION");
  const bool on = value != "0";  // PoCL's own default
  return fmt::format("POCL_WORK_GROUP_SPECIALIZATION={}: a kernel is compiled {}", value,
                     on ? "again for each work-group size" : "once for all work-group sizes");
}

std::string device_place(const DeviceInfo& device) {
  const std::string label = device.label();
  return label.substr(0, label.find(' '));
}

std::string device_title(const std::string& label, const std::string& name) {
  static const std::regex noise(R"(\((R|TM|C)\)| (CPU|Processor)\b| @ .*| \(.*\)$)");
  constexpr std::size_t most = 40;  // letters
  std::string title = label.substr(0, label.find(' ')) + " " + std::regex_replace(name, noise, "");
  if (title.size() > most) title = title.substr(0, most - 3) + "...";
  return title;
}

std::string device_title(const DeviceInfo& device) {
  return device_title(device.label(), device.name.empty() ? device.platform_name : device.name);
}

void add_device_row(Table& table, const DeviceInfo& device) {
  const auto number = [](auto value) { return Cell(static_cast<double>(value)); };
  add_row(table, {{"label", "", device.label()},
                  {"platform", "", device.platform_name},
                  {"platform version", "", device.platform_version},
                  {"name", "", device.name},
                  {"driver", "", device.driver},
                  {"version", "", device.version},
                  {"type", "", device.type},
                  {"compute units", "", number(units_of(device))},
                  {"compute units of the whole", "", number(device.compute_units)},
                  {"clock", "MHz", number(device.clock_mhz)},
                  {"memory", "bytes", number(device.global_memory)}});
}

std::string device_fact(const DeviceInfo& device) {
  const unsigned units = units_of(device);
  return fmt::format("{}, {} compute unit{}, driver {}", device.label(), units, units == 1 ? "" : "s",
                     device.driver);
}

}  // namespace sundog
