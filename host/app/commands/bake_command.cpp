// `sundog bake`: bakes a map of a detailed model for a plain one. Reads two models or scenes; writes a PNG
// that the plain model's texture coordinates address.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>

#include "app/bake/bake.h"
#include "app/options/command.h"
#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/process/exit_status.h"
#include "app/process/progress.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/file.h"
#include "base/image_io.h"

namespace sundog {
namespace {

struct BakeOptions {
  std::string high, low, out, size = "1024", kind = "normal", cage;
  std::vector<std::string> devices;
  bool outside_files = false, quiet = false;
};

BakeKind parse_kind(const std::string& text) {
  if (text == "normal") return BakeKind::normal;
  if (text == "height") return BakeKind::height;
  if (text == "occlusion") return BakeKind::occlusion;
  throw UsageError(fmt::format("--kind '{}': wanted normal, height or occlusion", text));
}

/// A tenth of the diagonal of the plain model's bounding box.
double usual_cage(const std::vector<LowTriangle>& triangles) {
  dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const LowTriangle& triangle : triangles)
    for (const LowCorner& corner : triangle.corner) {
      lower = glm::min(lower, corner.position);
      upper = glm::max(upper, corner.position);
    }
  return 0.1 * glm::length(upper - lower);
}

void check_map_name(const std::string& name) {
  if (!is_png(name))
    throw UsageError(fmt::format("{}: wanted a name that ends with .png: maps are written as PNG", name));
  check_writable(name);
}

void warn(const std::string& text) { fmt::print(stderr, "sundog: warning: {}\n", text); }

void warn_of_coverage(const BakeOptions& options, const Coverage& coverage) {
  const auto percent = [&](std::size_t count) {
    return 100.0 * static_cast<double>(count) /
           static_cast<double>(std::max<std::size_t>(coverage.covered, 1));
  };
  if (coverage.shared > 0)
    warn(fmt::format("{}: {} texels ({:.2g} %) lie in several triangles; the first counts", options.low,
                     coverage.shared, percent(coverage.shared)));
  if (coverage.outside > 0)
    warn(fmt::format("{}: {} triangles have texture coordinates outside of [0, 1], which are taken modulo 1",
                     options.low, coverage.outside));
}

void report(const BakeOptions& options, const BakeSettings& settings, const Coverage& coverage,
            const BakedMap& map) {
  if (map.missed > 0)
    warn(fmt::format("{} of {} texels met nothing within {:.4g} of {}; a greater --cage may reach it",
                     map.missed, coverage.covered, settings.cage, options.low));
  if (options.quiet) return;
  fmt::print("{}: {}x{}, {} texels of {} baked\n", options.out, coverage.size, coverage.size,
             coverage.covered - map.missed, coverage.texels.size());
  if (settings.kind == BakeKind::height)
    fmt::print(
        "heights {:.4g} to {:.4g}; black is {:.6g}, white {:.6g}: \"displacement\" {{\"height\": {:.6g}, "
        "\"middle\": 0.5}}\n",
        map.lowest, map.highest, -settings.cage, settings.cage, 2 * settings.cage);
}

int bake_map(const BakeOptions& options) {
  BakeSettings settings;
  settings.kind = parse_kind(options.kind);
  const int size = parse_number("--size", options.size, 1, 16384);
  if (!options.cage.empty()) settings.cage = parse_amount("--cage", options.cage);
  check_output_files({options.out}, {options.high, options.low});
  check_map_name(options.out);
  const auto load = [&](const std::string& file) {
    return read_apart_from({options.out}, [&] { return load_geometry(file, options.outside_files); });
  };
  const SceneDescription low = load(options.low);
  const std::vector<LowTriangle> triangles = low_triangles(low);
  const CompiledScene high = compile(load(options.high));
  if (high.info.instance_count == 0)
    throw SceneError(options.high, "", "has nothing to bake: wanted meshes or solids");
  if (settings.cage == 0) settings.cage = usual_cage(triangles);
  const Coverage coverage = cover(triangles, size);
  if (coverage.covered == 0)
    throw SceneError(options.low, "",
                     "its texture coordinates cover no texel of the map: unwrap it, or give a "
                     "greater --size");
  warn_of_coverage(options, coverage);
  const std::vector<DeviceInfo> devices = pick_devices(options.devices);
  Device device(devices.front());
  RayTracer tracer(device, high);
  ProgressBar bar(!options.quiet);
  const Stopwatch clock;
  const BakedMap map = bake(high, tracer, triangles, coverage, settings, [&](std::size_t done) {
    bar.update({done, coverage.texels.size(), clock.seconds()});
  });
  bar.erase();
  if (map.missed == coverage.covered)
    throw SceneError(
        options.high, "",
        fmt::format("no ray from {} met it within {:.4g}: give a greater --cage, or put both models "
                    "at one place",
                    options.low, settings.cage));
  write_file(options.out, encode_png(map.image));
  report(options, settings, coverage, map);
  return exit_done;
}

}  // namespace

void add_bake(Arguments& root, Command& chosen) {
  const auto options = std::make_shared<BakeOptions>();
  Arguments* app = root.add_subcommand(
      "bake", "Bake a map of a detailed model for the texture coordinates of a plain one");
  value(app, "HIGH", "FILE", options->high, "the detailed model, or a scene of meshes and solids")
      ->required();
  value(app, "LOW", "FILE", options->low, "the plain model, whose meshes have texture coordinates")
      ->required();
  value(app, "-o,--out", "FILE", options->out, "the map: .png")->required();
  value(app, "--size", "N", options->size, "texels a side (default 1024)");
  value(app, "--kind", "NAME", options->kind,
        "normal (default), height (16 bits, 0.5 is the plain surface) or occlusion");
  value(app, "--cage", "D", options->cage,
        "how far off the plain surface the detailed one is looked for (default: a tenth of its size)");
  values(app, "--device", "SPEC", options->devices, device_help);
  outside_files(app, options->outside_files);
  app->add_flag("-q,--quiet", options->quiet, "no progress bar and no summary");
  app->callback([options, &chosen] { chosen = Command{[options] { return bake_map(*options); }}; });
}

}  // namespace sundog
