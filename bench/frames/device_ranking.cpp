// See device_ranking.h.
#include "bench/frames/device_ranking.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "base/image_compare.h"
#include "bench/frames/frame_runner.h"
#include "bench/plain/whitted.h"
#include "bench/report/machine.h"

namespace sundog {
namespace {

constexpr double visible = 0.02;  // in linear colour

std::string names(const std::vector<DeviceInfo>& devices) {
  std::vector<std::string> places;
  for (const DeviceInfo& device : devices) places.push_back(device_place(device));
  const std::string text = fmt::format("{}", fmt::join(places, " + "));
  return devices.size() == 1 ? fmt::format("{} {}", text, devices[0].name) : text;
}

/// Whether two choices have a compute unit in common.
bool overlap(const DeviceInfo& a, const DeviceInfo& b) {
  if (a.platform != b.platform || a.device != b.device) return false;
  const auto end = [](const DeviceInfo& device) {
    return device.first_unit + (device.sub_units ? device.sub_units : device.compute_units);
  };
  return a.first_unit < end(b) && b.first_unit < end(a);
}

bool is_possible(const std::vector<DeviceInfo>& devices) {
  for (std::size_t i = 0; i < devices.size(); ++i)
    for (std::size_t k = i + 1; k < devices.size(); ++k)
      if (overlap(devices[i], devices[k])) return false;
  return true;
}

/// Open devices, and reference pictures, for all combinations.
struct Common {
  std::map<std::string, std::shared_ptr<LocalWorker>> open;
  std::map<std::string, Image> alone;  // each device's own picture
  Image expected;                      // the first device's
};

}  // namespace

struct DeviceRanking::Combination {
  std::vector<DeviceInfo> devices;
  std::shared_ptr<FrameRunner> frames;
  std::vector<std::vector<double>> shares;  // of each run, the first one too
  std::uint64_t differing = 0;              // pixels visibly unlike those of the first device, at most

  void open(const std::shared_ptr<const CompiledScene>& scene, Common& common) {
    std::vector<std::shared_ptr<LocalWorker>> workers;
    for (const DeviceInfo& device : devices) {
      auto& worker = common.open[device.label()];
      if (!worker) worker = frame_worker(device, scene);
      workers.push_back(worker);
    }
    frames = std::make_shared<FrameRunner>(std::move(workers), scene);
    if (devices.size() > 1) return;
    const Image& own = common.alone[devices[0].label()] = confirmed_image(*frames);
    if (common.expected.data.empty()) common.expected = own;
  }

  std::string check(Common& common) {
    std::vector<double>& run = shares.emplace_back();
    for (const DeviceReport& report : frames->last().devices) run.push_back(report.share);
    const Image image = frames->image();
    const auto differs = compare_images(image, common.expected, visible).over_tolerance;
    differing = std::max(differing, differs);
    if (!plain_difference(image, common.expected).empty())
      return fmt::format("{} pixels are not those of the first device", differs);
    // Devices that draw the same bits alone draw them together.
    const Image& own = common.alone[devices[0].label()];
    const bool same_bits = std::ranges::all_of(devices, [&](const DeviceInfo& device) {
      const auto found = common.alone.find(device.label());
      return found != common.alone.end() && same_bits_of(found->second, own);
    });
    return same_bits && !same_bits_of(image, own) ? "its image is not that of its first run" : "";
  }

  /// The median over the runs that count.
  std::vector<double> median_shares(const MeasuredWay& way) const {
    std::vector<double> medians;
    for (std::size_t i = 0; i < devices.size(); ++i) {
      std::vector<double> of_device;
      for (const std::vector<double>& run : way.counted(shares)) of_device.push_back(run[i]);
      medians.push_back(spread(of_device).median);
    }
    return medians;
  }

  std::string shares_text(const MeasuredWay& way) const {
    std::vector<std::string> parts;
    const std::vector<double> medians = median_shares(way);
    for (std::size_t i = 0; i < devices.size(); ++i)
      parts.push_back(fmt::format("{} {:.0f} %", device_place(devices[i]), 100 * medians[i]));
    return fmt::format("{}", fmt::join(parts, ", "));
  }
};

std::vector<std::vector<DeviceInfo>> device_combinations(const std::vector<DeviceInfo>& devices) {
  std::vector<std::vector<DeviceInfo>> sets;
  for (const DeviceInfo& device : devices) sets.push_back({device});
  for (std::size_t i = 0; i < devices.size(); ++i)
    for (std::size_t k = i + 1; k < devices.size(); ++k)
      if (is_possible({devices[i], devices[k]})) sets.push_back({devices[i], devices[k]});
  if (devices.size() > 2 && is_possible(devices)) sets.push_back(devices);
  return sets;
}

std::optional<double> combined_efficiency(double seconds, const std::vector<double>& alone) {
  double rate = 0;
  for (const double own : alone) {
    if (own <= 0) return {};
    rate += 1 / own;
  }
  if (seconds <= 0 || rate <= 0) return {};
  return 1 / seconds / rate;
}

DeviceRanking::DeviceRanking(std::string scene_name, std::shared_ptr<const CompiledScene> scene,
                             const std::vector<DeviceInfo>& devices)
    : name_(std::move(scene_name)), scene_(std::move(scene)) {
  const auto common = std::make_shared<Common>();
  for (const auto& set : device_combinations(devices)) {
    const auto made = std::make_shared<Combination>();
    made->devices = set;
    combinations_.push_back(made);
    Subject& subject = subjects_.emplace_back();
    subject.name = fmt::format("{}, {}", name_, names(set));
    subject.prepare = [made, common, flat = scene_] { made->open(flat, *common); };
    subject.run = [made] { return made->frames->run(); };
    subject.check = [made, common] { return made->check(*common); };
  }
}

DeviceRanking::~DeviceRanking() = default;

void DeviceRanking::measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }

std::optional<double> DeviceRanking::efficiency(const Combination& combination) const {
  std::vector<double> alone;
  double seconds = 0;
  for (const DeviceInfo& device : combination.devices)
    for (std::size_t i = 0; i < subjects_.size(); ++i)
      if (combinations_[i]->devices.size() == 1 && combinations_[i]->devices[0].label() == device.label())
        alone.push_back(subjects_[i].is_good() ? subjects_[i].seconds().median : 0);
  for (std::size_t i = 0; i < subjects_.size(); ++i)
    if (combinations_[i].get() == &combination && subjects_[i].is_good())
      seconds = subjects_[i].seconds().median;
  return combined_efficiency(seconds, alone);
}

void DeviceRanking::add_to(Report& report) const {
  std::vector<std::size_t> order(subjects_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    if (subjects_[a].is_good() != subjects_[b].is_good()) return subjects_[a].is_good();
    return subjects_[a].seconds().median < subjects_[b].seconds().median;
  });
  Table table{name_ + ": devices and their combinations, fastest first",
              {{"devices", ""},
               {"time", "ms"},
               {"of the best", ""},
               {"shares", ""},
               {"efficiency", ""},
               {"differing pixels", ""},
               {"problem", ""}},
              {}};
  BarPlot plot{name_ + ": a frame by devices", "ms", {}};
  const double best = order.empty() ? 0 : subjects_[order.front()].seconds().median;
  for (const std::size_t i : order) {
    const Subject& subject = subjects_[i];
    const Combination& made = *combinations_[i];
    const Field devices{"devices", "", names(made.devices)};
    std::vector<Field> shown{devices}, more;
    if (subject.is_good()) {
      const Spread ms = scaled(subject.seconds(), 1e3);
      more = {{"shares", "", made.shares_text(subject)},
              {"efficiency", "", efficiency(made)},
              {"differing pixels", "", static_cast<double>(made.differing)}};
      shown.insert(shown.end(), {{"time", "ms", ms}, {"of the best", "", ms.median / (1e3 * best)}});
      shown.insert(shown.end(), more.begin(), more.end());
      plot.bars.push_back(
          {names(made.devices).substr(0, 40), ms, made.devices.size() > 1 ? made.shares_text(subject) : ""});
    }
    add_row(table, shown, subject);
    add_measured(report, subject, {{"scene", "", name_}, devices}, more);
  }
  report.parts.emplace_back(std::move(table));
  report.parts.emplace_back(std::move(plot));
}

}  // namespace sundog
