// Sums counters of RAPL, or else of hwmon, and of NVML, which is loaded at run time; if one device has none,
// the sum is unknown.
#include "device/energy.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace sundog {
namespace {

namespace fs = std::filesystem;

constexpr double micro = 1e-6, milli = 1e-3;

/// The number in a file of sysfs; below 0 if it cannot be read.
double read_number(const fs::path& file) {
  std::ifstream in(file);
  double value = -1;
  return in >> value ? value : -1;
}

std::string read_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) all.push_back(entry.path());
  std::ranges::sort(all);
  return all;
}

/// Functions of NVIDIA's management library (its API reference, "Device Queries").
struct Nvml {
  using Handle = void*;
  int (*start)() = nullptr;
  int (*by_uuid)(const char* uuid, Handle* device) = nullptr;
  int (*by_index)(unsigned index, Handle* device) = nullptr;
  int (*energy)(Handle, unsigned long long* millijoules) = nullptr;
  int (*clock)(Handle, unsigned type, unsigned* mhz) = nullptr;
  std::string problem;
};

const Nvml& nvml() {
  static const Nvml loaded = [] {
    Nvml calls;
    void* library = ::dlopen("libnvidia-ml.so.1", RTLD_NOW | RTLD_LOCAL);
    const auto find = [&](auto& call, const char* name) {
      if (library) call = reinterpret_cast<std::decay_t<decltype(call)>>(::dlsym(library, name));
      if (!call) calls.problem = "libnvidia-ml.so.1 cannot be loaded, or is too old";
    };
    find(calls.start, "nvmlInit_v2");
    find(calls.by_uuid, "nvmlDeviceGetHandleByUUID");
    find(calls.by_index, "nvmlDeviceGetHandleByIndex_v2");
    find(calls.energy, "nvmlDeviceGetTotalEnergyConsumption");
    find(calls.clock, "nvmlDeviceGetClockInfo");
    if (calls.problem.empty() && calls.start() != 0) calls.problem = "NVML does not start";
    return calls;
  }();
  return loaded;
}

/// Finds the device by the identity that OpenCL reports, or as the only one; null if neither works.
Nvml::Handle nvml_device(const DeviceInfo& device) {
  Nvml::Handle handle = nullptr, second = nullptr;
  const std::string& id = device.identity;
  if (id.size() == 32) {
    const std::string uuid = fmt::format("GPU-{}-{}-{}-{}-{}", id.substr(0, 8), id.substr(8, 4),
                                         id.substr(12, 4), id.substr(16, 4), id.substr(20));
    if (nvml().by_uuid(uuid.c_str(), &handle) == 0) return handle;
  }
  const bool is_only = nvml().by_index(0, &handle) == 0 && nvml().by_index(1, &second) != 0;
  return is_only ? handle : nullptr;
}

}  // namespace

EnergyMeter::EnergyMeter(std::span<const DeviceInfo> devices, const std::string& system) {
  std::string problem;
  bool has_processor = false;
  std::vector<std::pair<int, int>> seen;
  for (const DeviceInfo& device : devices) {
    if (!device.host.empty() && problem.empty()) problem = device.label() + " is another process's";
    if (const std::pair place(device.platform, device.device); std::ranges::count(seen, place) == 0) {
      seen.push_back(place);
      has_processor = has_processor || device.type == "cpu";
      if (device.type != "cpu" && problem.empty()) problem = add_gpu(device);
    }
  }
  if (has_processor && problem.empty()) problem = add_processors(system);
  std::vector<std::string> names;
  for (Counter& counter : counters_) {
    counter.last = counter.joules();
    names.push_back(counter.name);
    if (counter.last < 0 && problem.empty()) problem = counter.name + " cannot be read";
  }
  if (!problem.empty()) counters_.clear();
  source_ = problem.empty() ? fmt::format("{}", fmt::join(names, ", ")) : "not known: " + problem;
}

std::string EnergyMeter::add_processors(const std::string& system) {
  std::string problem = "no counter under /sys/class/powercap or /sys/class/hwmon, as in a virtual machine";
  const auto add = [&](const std::string& name, const fs::path& file, double wraps_at) {
    if (read_number(file) < 0)
      problem = fmt::format("{} is not for every user to read (as root: chmod a+r)", file.string());
    else
      counters_.push_back({name, [file] { return micro * read_number(file); }, wraps_at});
  };
  // intel-rapl:0 is a package, also on AMD processors; intel-rapl:0:0 is a part of it.
  for (const fs::path& zone : entries(fs::path(system) / "class/powercap"))
    if (const std::string name = zone.filename().string();
        name.starts_with("intel-rapl:") && std::ranges::count(name, ':') == 1)
      add("RAPL " + read_line(zone / "name"), zone / "energy_uj",
          micro * std::max(0.0, read_number(zone / "max_energy_range_uj")));
  const auto is_package = [](const Counter& counter) { return counter.name.starts_with("RAPL package"); };
  // A "psys" zone includes the packages.
  if (std::ranges::any_of(counters_, is_package))
    std::erase_if(counters_, [&](const Counter& counter) {
      return counter.name.starts_with("RAPL ") && !is_package(counter);
    });
  if (counters_.empty())
    for (const fs::path& chip : entries(fs::path(system) / "class/hwmon"))
      for (const fs::path& file : entries(chip)) {
        const std::string name = file.filename().string();
        if (!name.starts_with("energy") || !name.ends_with("_input")) continue;
        const std::string label = read_line(chip / (name.substr(0, name.find('_')) + "_label"));
        if (label.starts_with("Esocket"))
          add(fmt::format("hwmon {} {}", read_line(chip / "name"), label), file, 0);
      }
  const bool any = std::ranges::any_of(counters_, [](const Counter& counter) {
    return counter.name.starts_with("RAPL") || counter.name.starts_with("hwmon");
  });
  return any ? "" : problem;
}

std::string EnergyMeter::add_gpu(const DeviceInfo& device) {
  const bool is_nvidia = device.vendor.find("NVIDIA") != std::string::npos;
  if (!is_nvidia) return fmt::format("nothing here counts that of {}", device.label());
  if (!nvml().problem.empty()) return nvml().problem;
  Nvml::Handle handle = nvml_device(device);
  unsigned long long millijoules = 0;
  if (!handle || nvml().energy(handle, &millijoules) != 0)
    return fmt::format("NVML does not count that of {}", device.label());
  counters_.push_back({"NVML " + device.name, [handle] {
                         unsigned long long now = 0;
                         return nvml().energy(handle, &now) == 0 ? milli * static_cast<double>(now) : -1.0;
                       }});
  if (!clock_)
    clock_ = [handle] {
      constexpr unsigned multiprocessors = 1;
      unsigned mhz = 0;
      return nvml().clock(handle, multiprocessors, &mhz) == 0 ? static_cast<double>(mhz) : 0.0;
    };
  return "";
}

double EnergyMeter::joules() {
  double sum = 0;
  for (Counter& counter : counters_) {
    const double now = counter.joules();
    if (now < 0) return -1;
    counter.sum += now - counter.last + (now < counter.last ? counter.wraps_at : 0);
    counter.last = now;
    sum += counter.sum;
  }
  return counters_.empty() ? -1 : sum;
}

nlohmann::json energy_json(double joules, double seconds, const std::string& source) {
  const auto known = [&](double value) { return joules >= 0 ? nlohmann::json(value) : nlohmann::json(); };
  return {{"joules", known(joules)}, {"watts", known(joules / seconds)}, {"counted_by", source}};
}

}  // namespace sundog
