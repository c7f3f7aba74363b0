// Implements the --device grammar on rows of devices, without OpenCL.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/names.h"
#include "base/numbers.h"
#include "device/choice.h"
#include "device/devices.h"
#include "device/driver_folder.h"

namespace sundog {
namespace {

/// Numbers as patterns match no device, because they occur in many names.
bool is_number(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string_view::npos;
}

struct Spec {
  std::string text;     // as given
  std::string pattern;  // in lower case, without ! and /N
  bool exclude = false;
  bool may_miss = false;   // an exclusion with a trailing ?
  unsigned sub_units = 0;  // 0: the whole device
};

/// A trailing "/digits" is the sub-device's size; other slashes belong to "platform/device".
Spec parse_spec(const std::string& text) {
  Spec spec{text, lower_case(text), text.starts_with('!')};
  if (spec.exclude) spec.pattern.erase(0, 1);
  spec.may_miss = spec.exclude && spec.pattern.ends_with('?');
  if (spec.may_miss) spec.pattern.pop_back();
  const std::size_t slash = spec.pattern.rfind('/');
  if (slash != std::string::npos) {
    const std::string tail = spec.pattern.substr(slash + 1);
    if (const auto units = whole_number<unsigned>(tail)) {
      if (*units == 0)
        throw UsageError(fmt::format("the device spec {}: /N wants 1 or more compute units, found 0", text));
      spec.sub_units = *units;
      spec.pattern.erase(slash);
    }
  }
  if (spec.pattern.empty())
    throw UsageError(fmt::format(
        "the device spec \"{}\": wanted P:D, cpu, gpu, accelerator, all or part of \"platform/device\", "
        "found nothing",
        text));
  if (spec.exclude && spec.sub_units > 0)
    throw UsageError(
        fmt::format("the device spec {}: a sub-device cannot be taken away: write !{}", text, spec.pattern));
  return spec;
}

/// Common names that occur in no platform's or device's name.
bool is_called(const std::string& name, const DeviceInfo& device) {
  if (name == "pocl") return is_pocl(device);
  const std::string vendor = lower_case(device.vendor);
  if (name == "amd") return vendor.find("advanced micro devices") != std::string::npos;
  return (name == "nvidia" || name == "intel") && vendor.find(name) != std::string::npos;
}

bool matches(const Spec& spec, const DeviceInfo& device) {
  const std::string& pattern = spec.pattern;
  if (pattern == "all" || pattern == device.type) return true;
  if (pattern == "cpu" || pattern == "gpu" || pattern == "accelerator") return false;
  if (const std::size_t colon = pattern.find(':'); colon != std::string::npos) {
    const auto platform = whole_number<unsigned>(pattern.substr(0, colon)),
               index = whole_number<unsigned>(pattern.substr(colon + 1));
    if (platform && index)
      return device.platform == static_cast<int>(*platform) && device.device == static_cast<int>(*index);
  }
  if (is_number(pattern)) return false;
  return is_called(pattern, device) ||
         lower_case(device.platform_name + "/" + device.name).find(pattern) != std::string::npos;
}

std::string candidates(std::span<const DeviceInfo> all) {
  std::string list;
  for (const DeviceInfo& row : all) {
    list += list.empty() ? "" : "; ";
    list += row.label();
    if (!row.problem.empty()) list += fmt::format(" ({})", row.problem);
  }
  return list.empty() ? "there is no OpenCL platform: install one (Debian: pocl-opencl-icd)"
                      : "there is: " + list;
}

bool same_device(const DeviceInfo& a, const DeviceInfo& b) {
  return a.platform == b.platform && a.device == b.device;
}

/// Why a device cannot provide the /N part beside those already chosen; empty if it can.
std::string refusal(const DeviceInfo& device, const Spec& spec, const std::vector<DeviceInfo>& chosen) {
  unsigned taken = 0;
  for (const DeviceInfo& other : chosen) {
    if (!same_device(other, device)) continue;
    if (other.sub_units == 0) return fmt::format("{} is already taken as a whole", device.label());
    taken += other.sub_units;
  }
  const std::string units =
      fmt::format("{} compute unit{}", device.compute_units, device.compute_units == 1 ? "" : "s");
  if (spec.sub_units > device.compute_units) return fmt::format("{} has {}", device.label(), units);
  if (taken + spec.sub_units > device.compute_units)
    return fmt::format("{} has {}, of which {} {} already taken", device.label(), units, taken,
                       taken == 1 ? "is" : "are");
  if (device.max_sub_devices == 0 && spec.sub_units < device.compute_units)
    return fmt::format("{} cannot be split: drop the /{}", device.label(), spec.sub_units);
  return {};
}

/// A sub-device of the next free units; the device itself if it cannot be split and all units are wanted.
DeviceInfo part(DeviceInfo device, unsigned units, const std::vector<DeviceInfo>& chosen) {
  if (units == device.compute_units && device.max_sub_devices < 2) return device;
  for (const DeviceInfo& other : chosen)
    if (same_device(other, device)) device.first_unit += other.sub_units;
  device.estimate *= static_cast<double>(units) / device.compute_units;
  device.sub_units = units;
  return device;
}

/// The usable devices that one SPEC matches. Throws DeviceError if there are none.
std::vector<DeviceInfo> matching(std::span<const DeviceInfo> all, const Spec& spec) {
  std::vector<DeviceInfo> found;
  for (const DeviceInfo& device : all)
    if (device.usable() && matches(spec, device)) found.push_back(device);
  const char* several =
      spec.text.find(',') == std::string::npos ? "" : "several are chosen by several specs; ";
  if (found.empty())
    throw DeviceError(fmt::format(
        "the device spec {}: {}; {}{}", spec.text,
        is_number(spec.pattern) ? "a number alone means no device, an index P:D does" : "no such device",
        several, candidates(all)));
  return found;
}

bool matches_any(const std::vector<Spec>& specs, const DeviceInfo& device, bool exclude) {
  return std::ranges::any_of(
      specs, [&](const Spec& spec) { return spec.exclude == exclude && matches(spec, device); });
}

struct Selection {
  std::vector<DeviceInfo> devices;
  std::vector<std::string> warnings;
};

/// Adds the matches of one SPEC in `candidates`. Warns about matches that cannot provide the requested part
/// if another can.
void add(Selection& selection, const Spec& spec, const std::vector<DeviceInfo>& candidates) {
  std::vector<DeviceInfo>& chosen = selection.devices;
  std::vector<std::string> refused;
  for (const DeviceInfo& device : candidates) {
    if (spec.sub_units == 0) {
      if (std::ranges::none_of(chosen, [&](const DeviceInfo& other) { return same_device(other, device); }))
        chosen.push_back(device);
    } else if (const std::string why = refusal(device, spec, chosen); !why.empty()) {
      refused.push_back(fmt::format("the device spec {}: {}", spec.text, why));
    } else {
      chosen.push_back(part(device, spec.sub_units, chosen));
    }
  }
  if (!refused.empty() && refused.size() == candidates.size())
    throw DeviceError(fmt::format("{}", fmt::join(refused, "; ")));
  for (const std::string& why : refused) selection.warnings.push_back(why + "; it is left out");
}

/// Throws for an exclusion without effect, which would leave a render on the unwanted device.
void check_exclusions(std::span<const DeviceInfo> all, const std::vector<Spec>& specs) {
  for (const Spec& spec : specs)
    if (spec.exclude && !spec.may_miss && std::ranges::none_of(all, [&](const DeviceInfo& device) {
          return device.device >= 0 && matches(spec, device);
        }))
      throw DeviceError(fmt::format(
          "the device spec {0}: takes nothing away, no device matches it (where it may be missing, "
          "write '{0}?'); {1}",
          spec.text, candidates(all)));
}

DeviceInfo fastest(std::span<const DeviceInfo> all) {
  const DeviceInfo* best = nullptr;
  for (const DeviceInfo& device : all)
    if (device.usable() && (!best || device.estimate > best->estimate)) best = &device;
  if (!best) throw DeviceError(fmt::format("no usable OpenCL device; {}", candidates(all)));
  return *best;
}

}  // namespace

std::string DeviceInfo::place() const { return fmt::format("{}:{}", platform, device); }

std::string DeviceInfo::spec() const {
  return sub_units > 0 ? fmt::format("{}/{}", place(), sub_units) : place();
}

std::string DeviceInfo::label() const {
  if (device < 0) return fmt::format("{} {}", platform, platform_name);
  const std::string from = first_unit > 0 ? fmt::format("@{}", first_unit) : "",
                    where = host.empty() ? "" : fmt::format(" (rank {} on {})", rank, host);
  return fmt::format("{}{} {} / {}{}", spec(), from, platform_name, name, where);
}

std::vector<DeviceInfo> select_devices(std::span<const DeviceInfo> all, const std::vector<std::string>& specs,
                                       std::vector<std::string>* warnings) {
  if (specs.empty()) return {fastest(all)};
  std::vector<Spec> parsed;
  for (const std::string& spec : specs) parsed.push_back(parse_spec(spec));
  check_exclusions(all, parsed);
  const bool only_exclusions = std::ranges::all_of(parsed, &Spec::exclude);
  if (only_exclusions) parsed.insert(parsed.begin(), parse_spec("all"));
  const auto excluded = [&](const DeviceInfo& device) { return matches_any(parsed, device, true); };
  Selection selection;
  for (const Spec& spec : parsed) {
    if (spec.exclude) continue;
    std::vector<DeviceInfo> found = matching(all, spec);
    std::erase_if(found, excluded);
    add(selection, spec, found);
  }
  if (selection.devices.empty())
    throw DeviceError(fmt::format("no device is left after the exclusions; {}", candidates(all)));
  if (warnings) *warnings = selection.warnings;
  return selection.devices;
}

std::vector<DeviceInfo> unusable_devices(std::span<const DeviceInfo> all,
                                         const std::vector<std::string>& specs) {
  std::vector<Spec> parsed;
  for (const std::string& spec : specs) parsed.push_back(parse_spec(spec));
  std::vector<DeviceInfo> found;
  std::ranges::copy_if(all, std::back_inserter(found), [&](const DeviceInfo& device) {
    return !device.usable() && matches_any(parsed, device, false) && !matches_any(parsed, device, true);
  });
  return found;
}

std::string choice_text(std::span<const DeviceInfo> all, const DeviceInfo& chosen) {
  std::string others;
  for (const DeviceInfo& device : all)
    if (device.usable() && !same_device(device, chosen))
      others +=
          fmt::format("{}{} ({:.0f})", others.empty() ? ", before " : ", ", device.label(), device.estimate);
  return fmt::format("{} (estimate {:.0f}){}", chosen.label(), chosen.estimate, others);
}

}  // namespace sundog
