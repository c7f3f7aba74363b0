// `sundog bench quality`: error by time of samplers and integrators, against a reference.
#include <fmt/format.h>

#include <memory>

#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/options/output_files.h"
#include "base/error.h"
#include "base/image_io.h"
#include "bench/commands/bench_run.h"
#include "bench/quality/quality.h"

namespace sundog {
namespace {

struct QualityOptions : BenchOptions {
  std::string reference, integrators, samplers = "auto,sobol,independent", counts = "1,4,16,64",
                                      goal = "0.02";
};

/// Every integrator with every sampler; without --integrators the scene's own.
std::vector<QualityWay> quality_ways(const QualityOptions& options, const std::string& file) {
  std::vector<std::string> integrators = split_names(options.integrators);
  if (integrators.empty()) integrators.push_back(bench_description(file, options).render.integrator);
  const std::vector<std::string> samplers = split_names(options.samplers);
  if (samplers.empty()) throw UsageError("--samplers: wanted names with commas between, such as auto,sobol");
  std::vector<QualityWay> ways;
  for (const std::string& integrator : integrators)
    for (const std::string& sampler : samplers) ways.push_back({integrator, sampler});
  return ways;
}

int bench_quality(const QualityOptions& options) {
  QualityPlan plan;
  plan.counts = parse_list("--counts", options.counts, 1, 65536);
  plan.goal = parse_real("--goal", options.goal, 1e-9, 1e9);
  check_output_files({options.json, options.csv, options.html}, {options.reference});
  plan.reference = read_image(options.reference);
  if (plan.reference.channels < 3)
    throw UsageError(fmt::format("{}: wanted a picture with colours", options.reference));
  BenchRun run("quality", "Error by time", options);
  run.head().facts.emplace_back("reference", options.reference);
  run.head().notes.push_back(fmt::format(
      "Median of {} frames after one to warm up; ways and counts take turns, and the image of each "
      "run was compared to the bit before its time counted. The error is the root mean square "
      "difference from the reference, in linear color. The perceived difference is the mean of "
      "FLIP (Andersson and others 2020) at 67 pixels a degree, where values above 1 count as 1.",
      options.repeat));
  const std::vector<DeviceInfo> devices = run.devices();
  for (const std::string& file : options.scenes)
    for (const DeviceInfo& device : devices) {
      plan.scene = scene_name(file);
      plan.device = device;
      plan.ways = quality_ways(options, file);
      plan.compile_for = [&run, file](const QualityWay& way, int samples) {
        return run.compiled(file, {fmt::format("/render/samples={}", samples), "/render/adaptive/threshold=0",
                                   fmt::format("/render/integrator={}", way.integrator),
                                   fmt::format("/render/sampler={}", way.sampler)});
      };
      run.measure(std::make_shared<QualityTimes>(plan));
    }
  return run.publish();
}

}  // namespace

void add_bench_quality(Arguments& bench, Command& chosen) {
  const auto options = std::make_shared<QualityOptions>();
  Arguments* app = add_bench_command(bench, chosen, "quality", "Error by time of samplers and integrators",
                                     options, bench_quality);
  add_bench_size(app, *options);
  value(app, "--reference", "FILE", options->reference, "the picture that counts as right, such as an EXR")
      ->required();
  value(app, "--integrators", "LIST", options->integrators, "integrators (default: the scene's own)");
  value(app, "--samplers", "LIST", options->samplers, "samplers (default auto,sobol,independent)");
  value(app, "--counts", "LIST", options->counts, "samples a pixel (default 1,4,16,64)");
  value(app, "--goal", "E", options->goal, "the rms error to whose time ways are compared (default 0.02)");
}

}  // namespace sundog
