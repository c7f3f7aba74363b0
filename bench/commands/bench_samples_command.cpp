// `sundog bench samples`: time and error by samples a pixel.
#include <fmt/format.h>

#include <memory>

#include "app/options/option_helpers.h"
#include "base/error.h"
#include "bench/commands/bench_run.h"
#include "bench/frames/sample_scaling.h"

namespace sundog {
namespace {

struct SamplesOptions : BenchOptions {
  std::string counts = "1,5,17,26";
  int reference = 0;                        // 0: four times the most
  std::string adaptive = "0.01,0.02,0.05";  // thresholds
};

/// Even frames of each count; adaptive frames, with up to four times the greatest count a pixel; subsampled
/// frames of each count.
std::vector<SampleWay> sample_ways(const SamplesOptions& options, const std::vector<int>& counts) {
  std::vector<SampleWay> ways;
  for (const int samples : counts)
    ways.push_back({"even",
                    std::to_string(samples),
                    {fmt::format("/render/samples={}", samples), "/render/adaptive/threshold=0"}});
  for (const std::string& threshold : split_names(options.adaptive))
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
  BenchRun run("samples", "Time and error by samples a pixel", options);
  run.head().notes.push_back(fmt::format(
      "Median of {} frames after one to warm up; the ways take turns, and the image of each run was compared "
      "to the bit before its time counted. The error is the root mean square difference from the same "
      "device's picture with {} samples, in linear color; a pixel is visibly wrong if it is off by more than "
      "0.02. With independent samples \"error x sqrt(samples)\" would stay constant; these samples are "
      "spread evenly over the pixel and do better.",
      options.repeat, reference));
  const std::vector<DeviceInfo> devices = run.devices();
  for (const std::string& file : options.scenes)
    for (const DeviceInfo& device : devices) {
      const auto compile_with = [&run, file](const std::vector<std::string>& overrides) {
        return run.compiled(file, overrides);
      };
      run.measure(std::make_shared<SampleTimes>(
          SampleScaling{scene_name(file), compile_with, device, sample_ways(options, counts), reference}));
    }
  return run.publish();
}

}  // namespace

void add_bench_samples(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<SamplesOptions>();
  Arguments* app = add_bench_command(bench, chosen, "samples", "Time and error by samples a pixel", options,
                                     bench_samples);
  add_bench_size(app, *options);
  value(app, "--counts", "LIST", options->counts, "samples a pixel (default 1,5,17,26)");
  value(app, "--reference", "N", options->reference,
        "samples of the picture that counts as right (default: four times the most)")
      ->range(2, 1 << 18);
  value(app, "--adaptive", "LIST", options->adaptive,
        "thresholds of the adaptive frames (default 0.01,0.02,0.05)");
}

}  // namespace sundog
