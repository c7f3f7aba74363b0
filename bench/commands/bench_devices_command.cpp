// `sundog bench devices`: ranks devices and combinations of devices by the time of a scene's frame.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "app/options/devices.h"
#include "base/image_compare.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/frame_runner.h"
#include "bench/plain/whitted.h"
#include "bench/report/machine.h"
#include "bench/report/report.h"
#include "bench/runs/measure.h"

namespace sundog {
namespace {

constexpr double visible = 0.02;  // in linear colour

std::string joined(const std::vector<DeviceInfo>& devices, std::string (*name_of)(const DeviceInfo&)) {
  std::vector<std::string> all;
  for (const DeviceInfo& device : devices) all.push_back(name_of(device));
  return fmt::format("{}", fmt::join(all, " + "));
}
std::string names(const std::vector<DeviceInfo>& devices) { return joined(devices, device_title); }
/// The label of a bar, which has room for one name.
std::string short_names(const std::vector<DeviceInfo>& devices) {
  return devices.size() == 1 ? names(devices) : joined(devices, device_place);
}

/// Whether two devices, or parts of them, share a compute unit.
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

/// Open devices and reference pictures, shared by all combinations.
struct Common {
  std::map<std::string, std::shared_ptr<LocalWorker>> open;
  std::map<std::string, Image> alone;  // each device's own picture
  Image expected;                      // the first device's
};

/// Each device alone, each pair, and all together, but no device with a part of itself. Pure.
std::vector<std::vector<DeviceInfo>> device_combinations(const std::vector<DeviceInfo>& devices) {
  std::vector<std::vector<DeviceInfo>> sets;
  for (const DeviceInfo& device : devices) sets.push_back({device});
  for (std::size_t i = 0; i < devices.size(); ++i)
    for (std::size_t k = i + 1; k < devices.size(); ++k)
      if (is_possible({devices[i], devices[k]})) sets.push_back({devices[i], devices[k]});
  if (devices.size() > 2 && is_possible(devices)) sets.push_back(devices);
  return sets;
}

/// A combination's rate divided by the sum of its devices' rates alone; idle devices count too. Nothing if a
/// time is unknown. Pure.
std::optional<double> combined_efficiency(double seconds, const std::vector<double>& alone) {
  double rate = 0;
  for (const double own : alone) {
    if (own <= 0) return {};
    rate += 1 / own;
  }
  if (seconds <= 0 || rate <= 0) return {};
  return 1 / seconds / rate;
}

bool is_part(const std::string& spec) {
  const std::size_t slash = spec.rfind('/');
  return slash != std::string::npos && slash + 1 < spec.size() &&
         spec.find_first_not_of("0123456789", slash + 1) == std::string::npos;
}

/// The devices to measure, which may include a device and parts of it.
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
    // A part that is the whole device counts once.
    const auto same = [&](const DeviceInfo& whole) { return whole.label() == part.label(); };
    if (std::ranges::none_of(all, same)) all.push_back(part);
  }
  return all;
}

class DeviceRanking {
 public:
  DeviceRanking(std::string scene_name, std::shared_ptr<const CompiledScene> scene,
                const std::vector<DeviceInfo>& devices, const std::vector<DeviceInfo>& unusable)
      : name_(std::move(scene_name)), scene_(std::move(scene)) {
    const auto common = std::make_shared<Common>();
    std::vector<std::vector<DeviceInfo>> sets = device_combinations(devices);
    for (const DeviceInfo& device : unusable) sets.push_back({device});
    for (const auto& set : sets) {
      const auto made = std::make_shared<Combination>();
      made->devices = set;
      combinations_.push_back(made);
      Subject& subject = subjects_.emplace_back();
      subject.name = fmt::format("{}, {}", name_, names(set));
      subject.devices = set;
      subject.prepare = [made, common, flat = scene_] { made->open(flat, *common); };
      subject.run = [made] { return made->frames->run(); };
      subject.check = [made, common] { return made->check(*common); };
    }
  }

  /// Times frames of all combinations in turn, on devices that are opened once. A combination has a problem
  /// if its picture differs from the first device's by more than rounding, or in any bit if its devices alone
  /// all draw the same bits.
  void measure(const MeasureOptions& options) { sundog::measure(subjects_, options); }
  /// Adds the ranking, bars and measurements.
  void add_to(Report& report) const {
    std::vector<std::size_t> order(subjects_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) {
      return std::tuple(!subjects_[i].is_good(), subjects_[i].seconds().median, i);
    });
    Table table{name_ + ": devices and their combinations, fastest first",
                {{"devices", ""},
                 {"time", "ms"},
                 {"of the best", ""},
                 {"shares", ""},
                 {"efficiency", ""},
                 {"differing pixels", ""}},
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
            {short_names(made.devices), ms, made.devices.size() > 1 ? made.shares_text(subject) : ""});
      }
      add_row(table, shown, subject);
      add_measured(report, subject, {{"scene", "", name_}, devices}, more);
    }
    report.parts.emplace_back(std::move(table));
    report.parts.emplace_back(std::move(plot));
  }

 private:
  struct Combination {
    std::vector<DeviceInfo> devices;
    std::shared_ptr<FrameRunner> frames;
    std::vector<std::vector<double>> shares;  // of each run, the first included
    std::uint64_t differing = 0;              // most pixels that visibly differ from the first device's

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
      if (common.expected.data.empty()) common.expected = image;  // no device has drawn alone
      const auto differs = compare_images(image, common.expected, visible).over_tolerance;
      differing = std::max(differing, differs);
      if (!plain_difference(image, common.expected).empty())
        return fmt::format("{} pixels are not those of the first device", differs);
      // Devices that draw the same bits alone must draw them together.
      const Image& own = common.alone[devices[0].label()];
      const bool same_bits = std::ranges::all_of(devices, [&](const DeviceInfo& device) {
        const auto found = common.alone.find(device.label());
        return found != common.alone.end() && same_bits_of(found->second, own);
      });
      return same_bits && !same_bits_of(image, own) ? "its image is not that of its first run" : "";
    }

    /// Each device's median share over the runs that count.
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
  std::optional<double> efficiency(const Combination& combination) const {
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

  std::string name_;
  std::shared_ptr<const CompiledScene> scene_;
  std::vector<std::shared_ptr<Combination>> combinations_;
  std::vector<Subject> subjects_;
};

int bench_devices_command(const BenchOptions& asked) {
  BenchRun run("devices", "Devices and their combinations", asked);
  BenchOptions options = asked;
  if (options.devices.empty()) options.devices = devices_of_environment();
  if (options.devices.empty()) options.devices = {"all"};
  const std::vector<DeviceInfo> devices = wholes_and_parts(options);
  run.add_devices(devices);
  const std::vector<DeviceInfo> unusable = unusable_bench_devices(options);
  run.head().times_frames = true;
  run.head().notes.emplace_back(
      "Medians of frames after one to warm up; the combinations take turns, devices are opened once, and "
      "building kernels does not count. A share is a part of the picture's pixels. A pixel differs if it is "
      "more than 0.02 (linear color) from the first device's; more than one pixel in 200 is a problem. "
      "Efficiency is the combination's frames a second over the sum of its devices' alone, by the medians.");
  for (const std::string& file : options.scenes)
    run.measure(
        std::make_shared<DeviceRanking>(scene_name(options, file), run.compiled(file), devices, unusable));
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
