// `sundog bench samples`: time and error by samples a pixel.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/bench/bench_options.h"
#include "app/options/option_helpers.h"
#include "base/error.h"
#include "bench/frames/sample_scaling.h"
#include "bench/frames/sample_ways.h"

namespace sundog {
namespace {

/// "a,b" -> a, b: JSON numbers, which the scene's reader checks.
std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    if (comma > at) parts.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

struct SamplesOptions : BenchOptions {
  std::string counts = "1,5,17,26";
  int reference = 0;                        // 0: four times the most
  std::string adaptive = "0.01,0.02,0.05";  // thresholds
};

/// Frames whose samples go where they are needed: adaptive ones up to four times the most that all pixels
/// get, and subsampled ones of each count.
std::vector<SampleWay> sample_ways(const SamplesOptions& options, const std::vector<int>& counts) {
  std::vector<SampleWay> ways;
  for (const std::string& threshold : split_list(options.adaptive))
    ways.push_back(
        {"adaptive",
         threshold,
         {fmt::format("/render/samples={}", 4 * counts.back()), "/render/adaptive/threshold=" + threshold}});
  for (const int samples : counts)
    ways.push_back({"subsampled",
                    std::to_string(samples),
                    {fmt::format("/render/samples={}", samples), "/render/adaptive/threshold=0",
                     "/render/subsample/on=true"}});
  return ways;
}

int bench_samples(const SamplesOptions& options) {
  const std::vector<int> counts = parse_list("--counts", options.counts, 1, 65536);
  const int reference = options.reference > 0 ? options.reference : 4 * counts.back();
  if (reference <= counts.back())
    throw UsageError(fmt::format("--reference {}: wanted more than the {} samples that are compared with it",
                                 reference, counts.back()));
  Report report = new_report("samples", "Time and error by samples a pixel", options);
  const std::vector<DeviceInfo> devices = bench_devices(options);
  add_device_facts(report, devices);
  for (const std::string& file : options.scenes)
    for (const DeviceInfo& device : devices) {
      SampleScaling plan;
      plan.scene = scene_name(file);
      plan.device = device;
      plan.counts = counts;
      plan.reference = reference;
      plan.repeat = options.repeat;
      plan.compile_for = [&](int samples) {
        return bench_scene(file, options,
                           {fmt::format("/render/samples={}", samples), "/render/adaptive/threshold=0"});
      };
      const auto on_step = [&](const std::string& step) { show_step(options, step); };
      const std::vector<SampleTime> even = measure_samples(plan, on_step);
      add_sample_tables(report, plan, even);
      SampleWays ways{plan, {}, sample_ways(options, counts)};
      ways.compile_with = [&](const std::vector<std::string>& overrides) {
        return bench_scene(file, options, overrides);
      };
      add_way_tables(report, ways, even, measure_ways(ways, even, on_step));
    }
  report.notes.push_back(
      fmt::format("Median of {} frames after one to warm up; the counts take turns, and the image of each "
                  "run was compared to "
                  "the bit before its time counted. The error is the root mean square difference from the "
                  "same device's picture "
                  "with {} samples, in linear color; a pixel is visibly wrong if it is off by more than "
                  "0.02. With independent "
                  "samples \"error x sqrt(samples)\" would stay constant; these samples are spread evenly "
                  "over the pixel and do "
                  "better.",
                  options.repeat, reference));
  return publish(report, options);
}

}  // namespace

void add_bench_samples(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<SamplesOptions>();
  Arguments* app = bench.add_subcommand("samples", "Time and error by samples a pixel");
  add_bench_options(app, *options);
  add_bench_size(app, *options);
  value(app, "--counts", "LIST", options->counts, "samples a pixel (default 1,5,17,26)");
  app->add_option("--reference", options->reference,
                  "samples of the picture that counts as right (default: four times the most)")
      ->type_name("N")
      ->range(2, 1 << 18);
  value(app, "--adaptive", "LIST", options->adaptive,
        "thresholds of the adaptive frames (default 0.01,0.02,0.05)");
  app->callback([options, &chosen] { chosen = RunLater{[options] { return bench_samples(*options); }}; });
}

}  // namespace sundog
