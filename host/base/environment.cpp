// Reads the process's environment variables; no other source below `app` does.
#include "base/environment.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <thread>

#include "base/clock.h"
#include "base/error.h"
#include "base/faults.h"
#include "base/numbers.h"

namespace sundog {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

double seconds_of(const char* name, double otherwise) {
  const std::string text = variable(name);
  if (text.empty()) return otherwise;
  const double seconds = whole_number<double>(text).value_or(0);
  if (!(seconds > 0 && std::isfinite(seconds)))
    throw UsageError(name + ("=" + text) + ": wanted seconds above 0; set another limit, or unset it");
  return seconds;
}

std::filesystem::path cache_directory() {
  // The XDG specification says to ignore relative paths.
  if (const std::filesystem::path xdg = variable("XDG_CACHE_HOME"); xdg.is_absolute()) return xdg / "sundog";
  if (const std::filesystem::path home = variable("HOME"); home.is_absolute())
    return home / ".cache" / "sundog";
  return {};
}

constexpr const char* usual_folders = "/usr/local/bin:/usr/bin:/bin";

std::map<std::string, std::string> driver_variables() {
  std::map<std::string, std::string> result = {
      // PoCL specialises kernels for each local size and for grids below 65536, and compiles once more to
      // return the binary. A single version was as fast for every kernel measured.
      {"POCL_WORK_GROUP_SPECIALIZATION", "0"},
      // Intel's driver compiles each kernel a second time, for 16 work-items at once, which takes nine tenths
      // of the compile time. Without it, pictures are equal to the bit and the wide tracer is as fast; the
      // compact tracer is slower.
      {"CL_CONFIG_USE_VECTORIZER", "False"},
      {"PATH", usual_folders},
  };
  for (const char* name :
       {"POCL_WORK_GROUP_SPECIALIZATION", "CL_CONFIG_USE_VECTORIZER", "PATH", "POCL_EXTRA_BUILD_FLAGS",
        "POCL_WORK_GROUP_METHOD", "POCL_CACHE_DIR", "HWLOC_SYNTHETIC", "HWLOC_XMLFILE", "HWLOC_FSROOT"})
    if (const char* value = std::getenv(name)) result[name] = value;
  // PoCL aborts the process if it finds no linker.
  if (std::string& path = result["PATH"]; !has_program(path, "ld")) path += std::string(":") + usual_folders;
  return result;
}

}  // namespace

std::string HostEnvironment::driver(const std::string& name) const {
  const auto found = drivers.find(name);
  return found == drivers.end() ? std::string() : found->second;
}

bool has_program(const std::string& path, const std::string& name) {
  std::istringstream folders(path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
  return false;
}

const HostEnvironment& value_of(const EnvironmentPtr& environment) {
  static const HostEnvironment none;
  return environment ? *environment : none;
}

std::optional<ProgramEnd> wait_for_end(StartedProgram& program, double seconds) {
  const Stopwatch clock;
  std::optional<ProgramEnd> end;
  while (!(end = program.ended()) && clock.seconds() < seconds)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return end;
}

HostEnvironment read_environment(const std::function<void(const std::string& kind)>& end_process) {
  HostEnvironment environment;
  environment.cache = cache_directory();
  environment.kernel_cache = variable("SUNDOG_KERNEL_CACHE") != "off";
  environment.kernels = variable("SUNDOG_KERNEL_DIR");
  environment.dump_folder = variable("SUNDOG_DUMP_KERNELS");
  environment.build_options = variable("SUNDOG_BUILD_OPTIONS");
  environment.build_log = variable("SUNDOG_BUILD_LOG");
  environment.launch_limit = seconds_of("SUNDOG_LAUNCH_LIMIT", 0);
  environment.silence_limit = seconds_of("SUNDOG_SILENCE_LIMIT", 10);
  if (const std::string faults = variable("SUNDOG_FAULTS"); !faults.empty())
    environment.faults = std::make_shared<Faults>(faults, end_process);
  environment.drivers = driver_variables();
  return environment;
}

void set_variable(const std::string& name, const std::string& value, bool replaces) {
  if (const char* present = std::getenv(name.c_str()); present && (replaces ? present == value : *present))
    return;
  static auto& kept = *new std::vector<std::vector<char*>>;  // lists that a getenv() may still be reading
  const std::string start = name + "=";
  std::vector<char*> list{::strdup((start + value).c_str())};
  for (char** entry = environ; entry && *entry; ++entry)
    if (!std::string_view(*entry).starts_with(start)) list.push_back(*entry);
  list.push_back(nullptr);
  kept.push_back(std::move(list));
  std::atomic_ref(environ).store(kept.back().data(), std::memory_order_release);
}

EnvironmentPtr plain_environment() { return std::make_shared<const HostEnvironment>(read_environment()); }

}  // namespace sundog
