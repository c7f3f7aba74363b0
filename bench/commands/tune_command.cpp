// `sundog tune`: finds and keeps what is fastest on a device; --show, --forget, --export and --import what is
// kept.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/options/command.h"
#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/process/environment.h"
#include "base/cache_folder.h"
#include "base/error.h"
#include "base/file.h"
#include "bench/commands/bench_options.h"
#include "bench/commands/tune_devices.h"
#include "render/device/tuning.h"
#include "scene/json/parse.h"

namespace sundog {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::vector<fs::path> kept_files() {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(tuning_folder(*program_environment()), none))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<TuningFile> kept() {
  std::vector<TuningFile> all;
  for (const fs::path& file : kept_files()) {
    try {
      all.push_back(read_tuning_file(file));
    } catch (const SceneError& error) {
      fmt::print(stderr, "sundog: warning: {}\n", error.what());
    }
  }
  return all;
}

std::string label(const TuningFile& file) {
  const std::string units = file.units > 0 ? fmt::format("/{}", file.units) : "";
  return fmt::format("{} / {}{}", file.platform, file.device, units);
}

int show() {
  const std::vector<TuningFile> files = kept();
  if (files.empty())
    fmt::print("There are no results in {}.\n", tuning_folder(*program_environment()).string());
  const std::string kernels = kernels_hash(*program_environment());
  for (const TuningFile& file : files) {
    fmt::print("{}, driver {}{}\n", label(file), file.driver,
               file.kernels == kernels ? "" : ": for other kernels, not used");
    for (const TuningEntry& entry : file.entries)
      fmt::print("  {:<14} {}: {}: {} ms, {} ms with the defaults ({})\n", entry.scene_class, entry.kernel,
                 tuning_text(entry.tuning), number_text(entry.tuned_ms), number_text(entry.default_ms),
                 entry.scene);
  }
  return exit_done;
}

int forget(const TuneOptions& options) {
  std::vector<fs::path> files = kept_files();
  if (!options.bench.devices.empty()) {
    files.clear();
    for (const DeviceInfo& device : bench_devices(options.bench)) files.push_back(tuning_path(device));
  }
  std::size_t removed = 0;
  std::error_code kept;
  for (const fs::path& file : files) removed += fs::remove(file, kept);
  fmt::print("{} file{} removed from {}\n", removed, removed == 1 ? "" : "s",
             tuning_folder(*program_environment()).string());
  return exit_done;
}

int export_all(const std::string& path) {
  json list = json::array();
  std::size_t entries = 0;
  for (const TuningFile& file : kept()) {
    list.push_back(to_json(file));
    entries += file.entries.size();
  }
  write_file(path, list.dump(2) + "\n");
  fmt::print("{}: {} result{} of {} device{}\n", path, entries, entries == 1 ? "" : "s", list.size(),
             list.size() == 1 ? "" : "s");
  return exit_done;
}

/// Only what is for a device of this machine, with the same driver, is of use: the others are skipped, with
/// the reason.
int import_all(const std::string& path) {
  const JsonContext context{.file = path};
  const json list = read_json_file(path);
  std::vector<TuningFile> files;
  for (const JsonValue& value : JsonValue(list, context).items("what `sundog tune --export` writes"))
    files.push_back(read_tuning(value));
  const std::string kernels = kernels_hash(*program_environment());
  const std::vector<DeviceInfo> devices = list_devices();
  for (const TuningFile& file : files) {
    const auto here = std::ranges::find_if(devices, [&](const DeviceInfo& device) {
      return device.platform_name == file.platform && device.name == file.device &&
             device.driver == file.driver;
    });
    const std::string why = file.kernels != kernels ? "it was measured with other kernels"
                            : here == devices.end() ? "there is no such device on this machine"
                                                    : "";
    if (why.empty()) {
      DeviceInfo device = *here;
      device.sub_units = file.units;
      for (const TuningEntry& entry : file.entries) keep_tuning(device, entry);
    }
    fmt::print("{}: {}\n", label(file), why.empty() ? "imported" : "skipped: " + why);
  }
  return exit_done;
}

int run_tune(const TuneOptions& options) {
  if (!(options.budget >= 0 && options.budget <= 1e6))
    throw UsageError(fmt::format("--budget {}: wanted seconds, from 0 to 1000000", options.budget));
  if (!options.import_from.empty()) import_all(options.import_from);
  if (!options.export_to.empty()) return export_all(options.export_to);
  if (options.forget) return forget(options);
  if (options.show) return show();
  if (!options.import_from.empty()) return exit_done;
  if (const std::string why = cache_refusal(program_environment()->cache); !why.empty()) throw IoError(why);
  return options.worker.empty() ? tune_devices(options) : tune_one_device(options);
}

}  // namespace

void add_tune(Arguments& root, Command& chosen) {
  const auto options = std::make_shared<TuneOptions>();
  Arguments* app =
      root.add_subcommand("tune", "Find the fastest settings of a device and keep them; `render` uses them");
  value(app, "SCENE", "FILE", options->bench.scenes,
        std::string(scene_help) + " (default: two built-in scenes)");
  values(app, "--device", "SPEC", options->bench.devices, device_help);
  values(app, "--set", "POINTER=VALUE", options->bench.overrides, "change the scenes, as in /camera/fov=30");
  outside_files(app, options->bench.outside_files);
  value(app, "--budget", "SECONDS", options->budget, "seconds for a device, with compilation (default 60)");
  app->add_option("--worker", options->worker)->hidden();
  app->add_flag("--show", options->show, "print the results that are kept");
  app->add_flag("--forget", options->forget, "remove the results of --device, or all");
  value(app, "--export", "FILE", options->export_to, "write all results to this file");
  value(app, "--import", "FILE", options->import_from,
        "read results that --export wrote, for devices of this machine");
  app->callback([options, &chosen] { chosen = Command{[options] { return run_tune(*options); }}; });
}

}  // namespace sundog
