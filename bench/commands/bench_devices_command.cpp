// `sundog bench devices`: which device, or which devices together, draw a scene fastest.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/device_ranking.h"

namespace sundog {
namespace {

bool is_part(const std::string& spec) {
  const std::size_t slash = spec.rfind('/');
  return slash != std::string::npos && slash + 1 < spec.size() &&
         spec.find_first_not_of("0123456789", slash + 1) == std::string::npos;
}

/// A whole device and parts of it may be measured, one after the other.
std::vector<DeviceInfo> wholes_and_parts(BenchOptions options) {
  std::vector<std::string> wholes = options.devices;
  std::vector<std::string> parts, exclusions;
  std::ranges::copy_if(wholes, std::back_inserter(parts), is_part);
  std::erase_if(wholes, is_part);
  std::ranges::copy_if(wholes, std::back_inserter(exclusions),
                       [](const auto& spec) { return spec.starts_with('!'); });
  if (parts.empty() || wholes.size() == exclusions.size()) return bench_devices(options);
  options.devices = wholes;
  std::vector<DeviceInfo> all = bench_devices(options);
  options.devices = parts;
  options.devices.insert(options.devices.end(), exclusions.begin(), exclusions.end());
  for (const DeviceInfo& part : bench_devices(options)) {
    // A part that is the whole device stands once.
    const auto same = [&](const DeviceInfo& whole) { return whole.label() == part.label(); };
    if (std::ranges::none_of(all, same)) all.push_back(part);
  }
  return all;
}

int bench_devices_command(const BenchOptions& asked) {
  BenchRun run("devices", "Devices and their combinations", asked);
  BenchOptions options = asked;
  if (options.devices.empty()) options.devices = devices_of_environment();
  if (options.devices.empty()) options.devices = {"all"};
  const std::vector<DeviceInfo> devices = wholes_and_parts(options);
  run.add_devices(devices);
  run.head().notes.push_back(fmt::format(
      "Median of {} frames after one to warm up; the combinations take turns, devices are opened once, and "
      "building kernels does not count. A share is a part of the picture's pixels. A pixel differs if it is "
      "more than 0.02 (linear color) from the first device's; more than one pixel in 200 is a problem. "
      "Efficiency is the combination's frames a second over the sum of its devices' alone, by the medians.",
      options.repeat));
  for (const std::string& file : options.scenes)
    run.measure(std::make_shared<DeviceRanking>(scene_name(file), run.compiled(file), devices));
  return run.publish();
}

}  // namespace

void add_bench_devices(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<BenchOptions>();
  add_bench_size(add_bench_command(bench, chosen, "devices",
                                   "Rank devices and their combinations, with the share of each", options,
                                   bench_devices_command),
                 *options);
}

}  // namespace sundog
