// The --device grammar over rows of devices; knows no OpenCL.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <functional>
#include <optional>

#include "base/error.h"
#include "device/choice.h"
#include "device/devices.h"

namespace sundog {
namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::optional<unsigned> whole_number(std::string_view text) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

struct Spec {
  std::string text;     // as given
  std::string pattern;  // lower case, without ! and /N
  bool exclude = false;
  unsigned sub_units = 0;  // 0: the whole device
};

/// A final "/digits" is the sub-device's size; any other slash belongs to the part of "platform/device".
Spec parse_spec(const std::string& text) {
  Spec spec{text, lower(text), text.starts_with('!')};
  if (spec.exclude) spec.pattern.erase(0, 1);
  const std::size_t slash = spec.pattern.rfind('/');
  if (slash != std::string::npos) {
    const std::string tail = spec.pattern.substr(slash + 1);
    if (const auto units = whole_number(tail)) {
      if (*units == 0)
        throw UsageError(fmt::format("--device {}: /N wants 1 or more compute units, found 0", text));
      spec.sub_units = *units;
      spec.pattern.erase(slash);
    }
  }
  if (spec.pattern.empty())
    throw UsageError(
        fmt::format("--device \"{}\": wanted P:D, cpu, gpu, accelerator, all or part of \"platform/device\", "
                    "found nothing",
                    text));
  if (spec.exclude && spec.sub_units > 0)
    throw UsageError(
        fmt::format("--device {}: a sub-device cannot be taken away: write !{}", text, spec.pattern));
  return spec;
}

bool matches(const Spec& spec, const DeviceInfo& device) {
  const std::string& pattern = spec.pattern;
  if (pattern == "all" || pattern == device.type) return true;
  if (pattern == "cpu" || pattern == "gpu" || pattern == "accelerator") return false;
  if (const std::size_t colon = pattern.find(':'); colon != std::string::npos) {
    const auto platform = whole_number(pattern.substr(0, colon)),
               index = whole_number(pattern.substr(colon + 1));
    if (platform && index)
      return device.platform == static_cast<int>(*platform) && device.device == static_cast<int>(*index);
  }
  return lower(device.platform_name + "/" + device.name).find(pattern) != std::string::npos;
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

DeviceInfo with_sub_units(DeviceInfo device, const Spec& spec) {
  if (spec.sub_units == 0) return device;
  const auto refuse = [&](const std::string& why) {
    return DeviceError(fmt::format("--device {}: {} {}", spec.text, device.label(), why));
  };
  if (device.max_sub_devices == 0) throw refuse(fmt::format("cannot be split: drop the /{}", spec.sub_units));
  if (spec.sub_units > device.compute_units)
    throw refuse(fmt::format("has {} compute units", device.compute_units));
  device.estimate *= static_cast<double>(spec.sub_units) / device.compute_units;
  device.sub_units = spec.sub_units;
  return device;
}

/// The usable devices that one SPEC means. Throws DeviceError when there are none.
std::vector<DeviceInfo> matching(std::span<const DeviceInfo> all, const Spec& spec) {
  std::vector<DeviceInfo> found;
  for (const DeviceInfo& device : all)
    if (device.usable() && matches(spec, device)) found.push_back(with_sub_units(device, spec));
  if (found.empty())
    throw DeviceError(fmt::format("--device {}: no such device; {}", spec.text, candidates(all)));
  return found;
}

DeviceInfo fastest(std::span<const DeviceInfo> all) {
  const DeviceInfo* best = nullptr;
  for (const DeviceInfo& device : all)
    if (device.usable() && (!best || device.estimate > best->estimate)) best = &device;
  if (!best) throw DeviceError(fmt::format("no usable OpenCL device; {}", candidates(all)));
  return *best;
}

}  // namespace

std::string DeviceInfo::label() const {
  if (device < 0) return fmt::format("{} {}", platform, platform_name);
  const std::string part = sub_units > 0 ? fmt::format("/{}", sub_units) : "";
  const std::string where = host.empty() ? "" : fmt::format(" (rank {} on {})", rank, host);
  return fmt::format("{}:{}{} {} / {}{}", platform, device, part, platform_name, name, where);
}

std::vector<DeviceInfo> select_devices(std::span<const DeviceInfo> all,
                                       const std::vector<std::string>& specs) {
  if (specs.empty()) return {fastest(all)};
  std::vector<Spec> parsed;
  for (const std::string& spec : specs) parsed.push_back(parse_spec(spec));
  const bool only_exclusions = std::ranges::all_of(parsed, &Spec::exclude);
  if (only_exclusions) parsed.insert(parsed.begin(), parse_spec("all"));
  std::vector<DeviceInfo> chosen;
  for (const Spec& spec : parsed) {
    if (spec.exclude) continue;
    for (const DeviceInfo& device : matching(all, spec))
      if (std::ranges::none_of(chosen, [&](const DeviceInfo& other) { return same_device(other, device); }))
        chosen.push_back(device);
  }
  for (const Spec& spec : parsed)
    if (spec.exclude) std::erase_if(chosen, [&](const DeviceInfo& device) { return matches(spec, device); });
  if (chosen.empty())
    throw DeviceError(fmt::format("--device: nothing is left after the exclusions; {}", candidates(all)));
  return chosen;
}

std::vector<std::string> idle_exclusions(std::span<const DeviceInfo> all,
                                         const std::vector<std::string>& specs) {
  std::vector<std::string> warnings;
  for (const std::string& text : specs) {
    const Spec spec = parse_spec(text);
    const auto is_meant = [&](const DeviceInfo& device) {
      return device.device >= 0 && matches(spec, device);
    };
    if (spec.exclude && std::ranges::none_of(all, is_meant))
      warnings.push_back(
          fmt::format("--device '{}' takes nothing away: no device matches it; {}", text, candidates(all)));
  }
  return warnings;
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
