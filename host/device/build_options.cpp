// Joins sundog's options, the device rule's, the entry's, the caller's and the environment's; the last two
// replace those of a rule by the same name.
#include "device/build_options.h"

#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <sstream>

#include "base/environment.h"
#include "device/device_rules.h"

namespace sundog {
namespace {

// Always requests argument information, so that tests check the program that renders.
constexpr const char* own_options = "-cl-std=CL1.2 -cl-kernel-arg-info";

/// An option up to its value.
std::string name_of(const std::string& option) { return option.substr(0, option.find('=')); }

/// Appends those of `more` that `stronger` does not have by the same name, nor takes away.
void append_options(std::string& options, std::string_view more, const std::string& stronger) {
  std::istringstream words{std::string(more)};
  for (std::string option; words >> option;)
    if (option[0] != '!' && stronger.find(name_of(option)) == std::string::npos) options += " " + option;
}

}  // namespace

std::string all_build_options(const DeviceInfo& device, const BuildWish& wish, std::string_view entry) {
  const HostEnvironment& environment = value_of(device.environment);
  const DeviceRule& rule = rule_of(device);
  const std::string of_entry(rule.of_entry(entry));
  const std::string &users = environment.build_options, stronger = users + " " + wish.options;
  std::string options = own_options;
  append_options(options, rule.options, stronger + " " + of_entry);
  append_options(options, of_entry, stronger);
  append_options(options, wish.options, users);
  return users.empty() ? options : options + " " + users;
}

std::vector<std::vector<std::string>> options_to_try(const DeviceInfo& device, std::string_view entry) {
  const std::string usual = all_build_options(device, {}, entry);
  std::map<std::string, std::vector<std::string>> by_name;
  std::istringstream words{std::string(rule_of(device).tries)};
  for (std::string option; words >> option;)
    if (all_build_options(device, {option}, entry) != usual)
      by_name[name_of(option[0] == '!' ? option.substr(1) : option)].push_back(option);
  std::vector<std::vector<std::string>> all;
  for (auto& [name, options] : by_name) all.push_back(std::move(options));
  return all;
}

std::string portable_options(const DeviceInfo& device, const std::string& options) {
  const DeviceRule& rule = rule_of(device);
  const std::string own = fmt::format("{} {} {}", rule.options, rule.of_tracer, rule.of_paths);
  std::istringstream words{options};
  std::string kept;
  for (std::string option; words >> option;)
    if (!option.starts_with("-cl-") || own.find(option) == std::string::npos)
      kept += (kept.empty() ? "" : " ") + option;
  return kept;
}

void bypass_driver_caches() {
  setenv("CUDA_CACHE_DISABLE", "1", 0);            // NVIDIA's
  setenv("AMD_COMGR_CACHE", "0", 0);               // AMD's
  setenv("NEO_CACHE_PERSISTENT", "0", 0);          // Intel's
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);  // Mesa's
}

}  // namespace sundog
