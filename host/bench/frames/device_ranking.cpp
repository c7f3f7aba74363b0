// See device_ranking.h.
#include "bench/frames/device_ranking.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/image_compare.h"
#include "bench/plain/whitted.h"

namespace sundog {
namespace {

constexpr double visible = 0.02;  // in linear colour

std::string short_name(const DeviceInfo& device) {
  return fmt::format("{}:{}{}", device.platform, device.device,
                     device.sub_units ? fmt::format("/{}", device.sub_units) : "");
}

std::string names(const std::vector<DeviceInfo>& devices) {
  std::string text;
  for (const DeviceInfo& device : devices) text += (text.empty() ? "" : " + ") + short_name(device);
  return devices.size() == 1 ? fmt::format("{} {}", text, devices[0].name) : text;
}

std::string shares_text(const DeviceTime& time) {
  std::string text;
  for (std::size_t i = 0; i < time.shares.size(); ++i)
    text += fmt::format("{}{} {:.0f} %", i ? ", " : "", short_name(time.devices[i]), 100 * time.shares[i]);
  return text;
}

double render_once(const CompiledScene& scene, DeviceTime& time, Image& image) {
  const RenderResult result = render(scene, time.devices);
  time.efficiency = result.efficiency;
  time.shares.clear();
  for (const DeviceReport& report : result.devices) {
    time.shares.push_back(report.share);
    if (report.retired) time.problem = report.messages.empty() ? "it was retired" : report.messages.back();
  }
  image = result.image;
  return result.times.render + result.times.readback;
}

void warm_up(const CompiledScene& scene, DeviceTime& time, Image& expected) {
  try {
    Image image;
    render_once(scene, time, image);
    if (expected.data.empty()) expected = image;
    time.differing = compare_images(image, expected, visible).over_tolerance;
    if (const std::string why = plain_difference(image, expected); !why.empty() && time.problem.empty())
      time.problem = fmt::format("{} pixels are not those of the first device", time.differing);
  } catch (const std::exception& error) {
    time.problem = error.what();
  }
}

double best_seconds(const std::vector<DeviceTime>& times) {
  for (const DeviceTime& time : times)
    if (time.problem.empty()) return time.seconds.median;
  return 0;
}

}  // namespace

std::vector<std::vector<DeviceInfo>> device_combinations(const std::vector<DeviceInfo>& devices) {
  std::vector<std::vector<DeviceInfo>> sets;
  for (const DeviceInfo& device : devices) sets.push_back({device});
  for (std::size_t i = 0; i < devices.size(); ++i)
    for (std::size_t k = i + 1; k < devices.size(); ++k) sets.push_back({devices[i], devices[k]});
  if (devices.size() > 2) sets.push_back(devices);
  return sets;
}

std::vector<DeviceTime> measure_devices(const CompiledScene& scene, const std::vector<DeviceInfo>& devices,
                                        int repeat, const std::function<void(const std::string&)>& on_step) {
  std::vector<DeviceTime> times;
  Image expected, image;
  for (const auto& set : device_combinations(devices)) {
    times.push_back({set, {}, 0, {}, 0, {}});
    on_step(names(set));
    warm_up(scene, times.back(), expected);
  }
  std::vector<std::vector<double>> seconds(times.size());
  for (int i = 0; i < repeat; ++i)
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (!times[k].problem.empty()) continue;
      on_step(fmt::format("{}, run {} of {}", names(times[k].devices), i + 1, repeat));
      seconds[k].push_back(render_once(scene, times[k], image));
    }
  for (std::size_t k = 0; k < times.size(); ++k) times[k].seconds = spread(seconds[k]);
  return times;
}

void add_device_tables(Report& report, const std::string& scene, std::vector<DeviceTime> times, int repeat) {
  std::ranges::stable_sort(times, [](const DeviceTime& a, const DeviceTime& b) {
    if (a.problem.empty() != b.problem.empty()) return a.problem.empty();
    return a.seconds.median < b.seconds.median;
  });
  Table table{scene + ": devices and their combinations, fastest first",
              {{"devices", ""},
               {"time", "ms"},
               {"of the best", ""},
               {"shares", ""},
               {"efficiency", ""},
               {"differing pixels", ""},
               {"problem", ""}},
              {}};
  BarPlot plot{scene + ": a frame by devices", "ms", {}};
  if (report.measurements.columns.empty())
    report.measurements.columns = {
        {"scene", ""},  {"devices", ""},    {"time", "ms"},           {"runs", ""},
        {"shares", ""}, {"efficiency", ""}, {"differing pixels", ""}, {"problem", ""}};
  for (const DeviceTime& time : times) {
    std::vector<Cell> row{names(time.devices)}, measured{scene, names(time.devices)};
    const Spread ms{1e3 * time.seconds.median, 1e3 * time.seconds.min, 1e3 * time.seconds.max};
    if (time.problem.empty()) {
      row.insert(row.end(), {ms, time.seconds.median / best_seconds(times), shares_text(time),
                             time.efficiency, static_cast<double>(time.differing)});
      measured.insert(measured.end(), {ms, static_cast<double>(repeat), shares_text(time), time.efficiency,
                                       static_cast<double>(time.differing)});
      plot.bars.push_back(
          {names(time.devices).substr(0, 40), ms, time.devices.size() > 1 ? shares_text(time) : ""});
    }
    row.resize(table.columns.size());
    measured.resize(report.measurements.columns.size());
    row.back() = measured.back() = time.problem.empty() ? Cell() : Cell(time.problem);
    table.rows.push_back(std::move(row));
    report.measurements.rows.push_back(std::move(measured));
  }
  report.parts.emplace_back(std::move(table));
  report.parts.emplace_back(std::move(plot));
}

}  // namespace sundog
