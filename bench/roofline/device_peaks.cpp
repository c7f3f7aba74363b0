// Runs kernels/entry/peaks.cl at all vector widths, doubles the work until a run takes 10 ms, and compares
// the results with the host's.
#include "bench/roofline/device_peaks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/clock.h"
#include "bench/report/machine.h"
#include "shared/types.h"

namespace sundog {
namespace {

constexpr std::size_t group = 64, reads = 16, steps = 8;  // as in peaks.cl
constexpr std::size_t widest = 16, part_bytes = group * reads * widest * sizeof(float);
constexpr std::array<unsigned, 5> widths{1, 2, 4, 8, 16};
constexpr double least_run_seconds = 0.01;  // of a run, to make the time of a launch negligible

double as_double(std::size_t n) { return static_cast<double>(n); }

/// Whole numbers from 0 to 7 in pseudo-random order.
std::vector<float> made_values(std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i)
    values[i] = static_cast<float>(static_cast<u32>(i) * 2654435761u >> 29);
  return values;
}

/// The sums that read_values() must return for one round through the values, by work-item.
std::vector<i32> sums_of(const std::vector<float>& values, unsigned width) {
  std::vector<i32> sums(values.size() / width / reads, 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t vector = i / width, part = vector / (group * reads), lane = vector % group;
    sums[part * group + lane] += static_cast<i32>(values[i]);
  }
  return sums;
}

/// The value that multiply_and_add() must write for a work-item.
i32 chain_sum(std::size_t item, unsigned width, unsigned chains, std::size_t rounds) {
  i32 sum = 0;
  for (unsigned c = 0; c < chains; ++c)
    for (unsigned lane = 0; lane < width; ++lane) {
      i32 x = static_cast<i32>((item & 7) + c + lane), y = static_cast<i32>((item >> 3 & 7) + lane);
      for (std::size_t step = 0; step < rounds * steps % 3; ++step) x = y - x, y = x - y;
      sum += y;
    }
  return sum;
}

KernelDefines defines_of(const std::string& type, unsigned width, unsigned chains) {
  KernelDefines defines{
      {"SCALAR", type}, {"WIDTH", fmt::format("{}", width)}, {"CHAINS", fmt::format("{}", chains)}};
  if (type == "half") defines["IS_HALF"] = "1";
  if (type == "int") defines["IS_INT"] = "1";
  return defines;
}

/// The scalar types that the device supports.
std::vector<std::string> types_of(const DeviceInfo& info) {
  std::vector<std::string> types{"float"};
  if (info.extensions.find("cl_khr_fp16") != std::string::npos) types.emplace_back("half");
  if (info.extensions.find("cl_khr_fp64") != std::string::npos) types.emplace_back("double");
  types.emplace_back("int");
  return types;
}

}  // namespace

/// The open device and all kernels' buffers.
struct DevicePeaks::Opened {
  Device device;
  std::vector<float> values;
  Buffer<float> input, copies;
  Buffer<i32> sums;
  i32 run = 0;  // number of the run, so that an earlier run's result is detected

  Opened(const DeviceInfo& info, unsigned megabytes) : device(info) {
    // At most a quarter of the device's largest allocation, in whole parts.
    const std::size_t bytes = std::min<std::size_t>(std::size_t{megabytes} << 20, info.max_allocation / 4);
    values = made_values(std::max<std::size_t>(2, bytes / part_bytes) * part_bytes / sizeof(float));
    input = device.upload(std::span<const float>(values));
    copies = device.make<float>(values.size());
    sums = device.make<i32>(std::max(values.size() / reads, items()));
  }
  /// Work-items that keep the device busy: PoCL gives a thread 32 groups at a time.
  std::size_t items() const { return std::max(1u, device.info().compute_units) * std::size_t{4096}; }
  Program build(const std::string& type, unsigned width, unsigned chains) {
    return device.build("entry/peaks.cl", defines_of(type, width, chains));
  }
  /// Seconds of that many launches, until the last has finished.
  template <class Launch>
  double timed(std::size_t times, const Launch& launch) {
    ++run;
    const Stopwatch clock;
    for (std::size_t i = 0; i < times; ++i) launch();
    device.finish();
    return clock.seconds();
  }
  std::vector<i32> read_sums(std::size_t count) {
    std::vector<i32> all(count);
    device.read(sums, std::span<i32>(all));
    return all;
  }
};

/// A built kernel: runs it `times` times and returns the seconds; checks the last result.
struct DevicePeaks::Work {
  std::function<double(std::size_t times)> run;
  std::function<bool(std::size_t times)> is_right;
};

DevicePeaks::DevicePeaks(DeviceInfo device, unsigned megabytes)
    : info_(std::move(device)), megabytes_(megabytes) {}

void DevicePeaks::add(Peak peak, double amount, const std::function<Work()>& make) {
  const std::string chains = peak.chains > 0 ? fmt::format(", {} chains", peak.chains) : "";
  Subject& subject = subjects_.emplace_back();
  subject.devices = {info_};
  subject.name = fmt::format("{} on {}, width {}{}", peak.what, device_title(info_), peak.width, chains);
  const auto& shared = peaks_.emplace_back(std::make_shared<Peak>(std::move(peak)));
  const auto work = std::make_shared<Work>();
  subject.prepare = [=, peak = shared] {
    *work = make();
    work->run(1);
    // Makes the time of a launch negligible.
    peak->times = 1;
    while (work->run(peak->times) < least_run_seconds && peak->times < (1u << 20)) peak->times *= 2;
    peak->amount = amount * as_double(peak->times);
  };
  subject.run = [work, peak = shared] { return work->run(peak->times); };
  subject.check = [work, peak = shared] { return work->is_right(peak->times) ? "" : "its result is wrong"; };
}

void DevicePeaks::add_reads(const char* what, unsigned width, bool cached) {
  const double bytes = as_double(opened_->values.size()) * sizeof(float);
  add({what, "GB/s", width}, bytes, [o = opened_, width, cached] {
    auto kernel = o->build("float", width, 1).kernel<Buffer<float>, Buffer<i32>, u32, i32>("read_values");
    const std::size_t parts = cached ? 2 * widest / width : o->values.size() / (width * group * reads);
    const LaunchSize size{o->values.size() / width / reads, 1, group, 1};
    const auto run = [=](std::size_t times) mutable {
      return o->timed(
          times, [&] { o->device.run(kernel, size, o->input, o->sums, static_cast<u32>(parts), o->run); });
    };
    const auto is_right = [=, expected = sums_of(o->values, width)](std::size_t) {
      const std::vector<i32> sums = o->read_sums(expected.size());
      for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i] != expected[i % (parts * group)] + o->run) return false;
      return true;
    };
    return Work{run, is_right};
  });
}

void DevicePeaks::add_copies(unsigned width) {
  const double bytes = 2 * as_double(opened_->values.size()) * sizeof(float);
  add({"copy memory", "GB/s", width}, bytes, [o = opened_, width] {
    auto kernel = o->build("float", width, 1).kernel<Buffer<float>, Buffer<float>, i32>("copy_values");
    const LaunchSize size{o->values.size() / width, 1, group, 1};
    const auto run = [=](std::size_t times) mutable {
      return o->timed(times, [&] { o->device.run(kernel, size, o->input, o->copies, o->run); });
    };
    const auto is_right = [=](std::size_t) {
      std::vector<float> copies(o->values.size());
      o->device.read(o->copies, std::span<float>(copies));
      const auto run_number = static_cast<float>(o->run);
      return std::ranges::equal(copies, o->values, {}, {}, [=](float value) { return value + run_number; });
    };
    return Work{run, is_right};
  });
}

void DevicePeaks::add_operations(const std::string& type, unsigned width, unsigned chains) {
  const double operations = as_double(steps * 4 * width * chains * opened_->items());
  add({type, "Gop/s", width, chains}, operations, [o = opened_, type, width, chains] {
    auto kernel = o->build(type, width, chains).kernel<Buffer<i32>, i32, u32, i32>("multiply_and_add");
    const LaunchSize size{o->items(), 1, group, 1};
    const auto run = [=](std::size_t rounds) mutable {
      return o->timed(1, [&] { o->device.run(kernel, size, o->sums, -1, static_cast<u32>(rounds), o->run); });
    };
    const auto is_right = [=](std::size_t rounds) {
      const std::vector<i32> sums = o->read_sums(o->items());
      for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i] != chain_sum(i, width, chains, rounds) + o->run) return false;
      return true;
    };
    return Work{run, is_right};
  });
}

void DevicePeaks::add_launches() {
  add({"launch", "us"}, 1, [o = opened_] {
    auto kernel = o->build("float", 1, 1).kernel<Buffer<i32>, i32>("start");
    const auto run = [=](std::size_t times) mutable {
      double seconds = 0;
      for (std::size_t i = 0; i < times; ++i)
        seconds += o->timed(1, [&] { o->device.run(kernel, {1, 1, 1, 1}, o->sums, o->run); });
      return seconds;
    };
    return Work{run, [=](std::size_t) { return o->read_sums(1)[0] == o->run; }};
  });
}

void DevicePeaks::measure(const MeasureOptions& options) {
  subjects_.resize(1);
  subjects_.front().name = fmt::format("peaks of {}", device_title(info_));
  if (!prepared(subjects_, options, [&] { opened_ = std::make_shared<Opened>(info_, megabytes_); })) return;
  subjects_.clear();
  for (const unsigned width : widths) {
    add_reads("read memory", width, false);
    add_reads("read cache", width, true);  // 128 KiB
    add_copies(width);
  }
  for (const std::string& type : types_of(info_))
    for (const unsigned chains : {1u, 8u})
      for (const unsigned width : widths) add_operations(type, width, chains);
  add_launches();
  for (std::size_t i = 0; i < subjects_.size() && !options.is_stopped(); ++i) {
    if (options.on_step) options.on_step(subjects_[i].name + ", building", 0);
    // A failure here repeats at the first run, which reports it as a row.
    std::vector<Subject> one{subjects_[i]};
    if (!prepared(one, options, subjects_[i].prepare)) continue;
    subjects_[i].prepare = {};
    // With the number in its name, runs of an earlier report count only if they did as much work.
    if (peaks_[i]->times > 0) subjects_[i].name += fmt::format(", {} times", peaks_[i]->times);
  }
  sundog::measure(subjects_, options);
}

std::optional<Spread> DevicePeaks::figure(std::size_t index) const {
  const Subject& subject = subjects_[index];
  if (index >= peaks_.size() || !subject.is_good()) return {};
  const Peak& peak = *peaks_[index];
  std::vector<double> figures;
  for (const double seconds : subject.seconds().runs)
    figures.push_back(peak.is_rate() ? 1e-9 * peak.amount / seconds : 1e6 * seconds / peak.amount);
  return spread(figures);
}

std::optional<Spread> DevicePeaks::best(const std::string& what) const {
  std::optional<Spread> most;
  for (std::size_t i = 0; i < peaks_.size(); ++i)
    if (const auto rate = figure(i);
        peaks_[i]->what == what && rate && (!most || rate->median > most->median))
      most = rate;
  return most;
}

Table DevicePeaks::table() const {
  Table table{fmt::format("Peaks of {}", device_title(info_)), {{"", ""}, {"chains", ""}, {"unit", ""}}, {}};
  for (const unsigned width : widths) table.columns.push_back({fmt::format("width {}", width), ""});
  std::vector<std::pair<std::string, unsigned>> rows;
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    const Peak& peak = *peaks_[i];
    const std::pair key{peak.what, peak.chains};
    auto row = std::ranges::find(rows, key);
    if (row == rows.end()) {
      row = rows.insert(row, key);
      table.rows.push_back({peak.what, peak.chains ? Cell(double{0} + peak.chains) : Cell(), peak.unit});
      table.rows.back().resize(table.columns.size());
    }
    const auto column = static_cast<std::size_t>(std::ranges::find(widths, peak.width) - widths.begin());
    if (const auto rate = figure(i))
      table.rows[static_cast<std::size_t>(row - rows.begin())][3 + column] = *rate;
  }
  return table;
}

void DevicePeaks::add_to(Report& report) const {
  for (std::size_t i = 0; i < subjects_.size(); ++i) {
    std::vector<Field> key{{"device", "", device_title(info_)}}, results;
    if (i < peaks_.size()) {
      const Peak& peak = *peaks_[i];
      const auto measured = figure(i);
      const auto of = [&](const char* unit) {
        return measured && peak.unit == unit ? Cell(*measured) : Cell();
      };
      key.insert(key.end(), {{"measured", "", peak.what},
                             {"width", "", double{0} + peak.width},
                             {"chains", "", peak.chains ? Cell(double{0} + peak.chains) : Cell()}});
      results = {{"bandwidth", "GB/s", of("GB/s")},
                 {"operations", "Gop/s", of("Gop/s")},
                 {"launch", "us", of("us")}};
    }
    add_measured(report, subjects_[i], key, results);
  }
  report.parts.emplace_back(table());
}

}  // namespace sundog
