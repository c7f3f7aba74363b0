// Joins sundog's options, the device rule's, the entry's, a tuning's, the caller's and the environment's;
// each of the last four replaces options of the same name from the sources before it, except sundog's own.
#include "device/build_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "base/environment.h"
#include "device/device_rules.h"

namespace sundog {
namespace {

// Always requests argument information, so that tests check the program that renders.
constexpr const char* own_options = "-cl-std=CL1.2 -cl-kernel-arg-info";

std::vector<std::string> words(std::string_view options) {
  std::istringstream text{std::string(options)};
  return {std::istream_iterator<std::string>(text), {}};
}

/// An option without its value and without the leading "!".
std::string name_of(std::string option) {
  if (option.starts_with('!')) option.erase(0, 1);
  return option.substr(0, option.find('='));
}

/// Appends the options of `more`, except any that `stronger` sets or removes by name.
void append_options(std::string& options, std::string_view more, const std::string& stronger) {
  std::set<std::string> names;
  for (const std::string& option : words(stronger)) names.insert(name_of(option));
  for (const std::string& option : words(more))
    if (option[0] != '!' && !names.contains(name_of(option))) options += " " + option;
}

}  // namespace

std::string all_build_options(const DeviceInfo& device, const BuildWish& wish, const KernelText& text) {
  const DeviceRule& rule = rule_of(device);
  const std::string of_program(rule.of_program(text)),
      &users = value_of(device.environment).build_options,
      tuned = text.entry.starts_with("entry/render_") ? wish.tuned : std::string();
  const std::string stronger = users + " " + wish.options + " " + tuned;
  std::string options = own_options;
  append_options(options, rule.options, stronger + " " + of_program);
  append_options(options, of_program, stronger);
  append_options(options, tuned, users + " " + wish.options);
  append_options(options, wish.options, users);
  append_options(options, users, "");
  return options;
}

std::vector<std::vector<std::string>> options_to_try(const DeviceInfo& device, std::string_view entry,
                                                     bool compact) {
  const KernelText text{.entry = std::string(entry)};
  const std::string usual = all_build_options(device, {}, text);
  std::map<std::string, std::vector<std::string>> by_name;
  const DeviceRule& rule = rule_of(device);
  for (const std::string& option : words(fmt::format("{} {}", rule.tries, compact ? rule.tries_compact : "")))
    if (all_build_options(device, {.tuned = option}, text) != usual)
      by_name[name_of(option)].push_back(option);
  std::vector<std::vector<std::string>> all;
  for (auto& [name, options] : by_name) all.push_back(std::move(options));
  return all;
}

bool may_be_tuned(std::string_view options) {
  return std::ranges::all_of(words(options), [](const std::string& option) {
    return std::ranges::any_of(device_rules(), [&](const DeviceRule& rule) {
      return std::ranges::count(words(fmt::format("{} {}", rule.tries, rule.tries_compact)), option) > 0;
    });
  });
}

std::string portable_options(const DeviceInfo& device, const std::string& options) {
  const DeviceRule& rule = rule_of(device);
  std::string all = fmt::format("{} {}", rule.options, rule.tries);
  for (const ProgramOptions& program : rule.of_programs) all += fmt::format(" {}", program.options);
  const std::vector<std::string> own = words(all);
  std::string kept;
  for (const std::string& option : words(options))
    if (!option.starts_with("-cl-") || std::ranges::count(own, option) == 0)
      kept += (kept.empty() ? "" : " ") + option;
  return kept;
}

void bypass_driver_caches() {
  set_variable("CUDA_CACHE_DISABLE", "1");    // NVIDIA's
  set_variable("AMD_COMGR_CACHE", "0");       // AMD's
  set_variable("NEO_CACHE_PERSISTENT", "0");  // Intel's
}

}  // namespace sundog
