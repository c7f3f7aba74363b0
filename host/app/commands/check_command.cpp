// `sundog check`: a health report on drivers, caches and devices. This process makes no OpenCL call: a child
// process checks each driver and device, so that a crash or hang becomes a line of the report.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/options/command.h"
#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/process/child_process.h"
#include "app/process/environment.h"
#include "app/process/warnings.h"
#include "base/cache_folder.h"
#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "bench/rays/self_check.h"
#include "bench/report/machine.h"
#include "device/machine_topology.h"

namespace sundog {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Whether files can be created in the folder or, if it does not exist, in its nearest existing parent.
bool can_write(fs::path folder) {
  std::error_code none;
  while (!folder.empty() && !fs::exists(folder, none) && folder.has_parent_path())
    folder = folder.parent_path();
  return ::access(folder.c_str(), W_OK) == 0;
}

json folder_figures(const char* what, const fs::path& folder) {
  std::uintmax_t files = 0, bytes = 0;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.is_regular_file(none)) ++files, bytes += entry.file_size(none);
  return {{"what", what},
          {"folder", folder.string()},
          {"files", files},
          {"bytes", bytes},
          {"writable", !folder.empty() && can_write(folder)}};
}

std::string text_of(const json& object, const char* key) {
  return object.contains(key) && object.at(key).is_string() ? object.at(key).get<std::string>() : "";
}

/// A row's problem and advice, as indented lines.
std::string problem_text(const json& row) {
  std::string text;
  for (const char* key : {"problem", "advice"})
    if (const std::string line = text_of(row, key); !line.empty()) text += fmt::format("      {}\n", line);
  return text;
}

std::string device_text(const json& device) {
  const std::string name = device.contains("index")
                               ? fmt::format("{} {} / {}", text_of(device, "index"),
                                             text_of(device, "platform"), text_of(device, "name"))
                               : text_of(device, "platform");
  const std::string part = device.contains("sub_units")
                               ? fmt::format(", {} of its units", device.at("sub_units").get<unsigned>())
                               : "";
  std::string text = fmt::format("  {:<10}  {}{}\n", text_of(device, "status"), name, part);
  if (device.contains("driver"))
    text += fmt::format("      driver {}; {}\n", text_of(device, "driver"), text_of(device, "version"));
  if (device.contains("pixels") && device.at("pixels") > 0)
    text += fmt::format(
        "      {} kernel files in {:.2f} s, picture in {:.2f} s; {} of {} pixels differ visibly from plain "
        "C++\n",
        device.at("kernels").get<int>(), device.at("build_seconds").get<double>(),
        device.at("render_seconds").get<double>(), device.at("differing").get<std::uint64_t>(),
        device.at("pixels").get<std::uint64_t>());
  return text + problem_text(device);
}

/// For the binary cache and the tuning results: folder, number of files, bytes, and whether it is writable.
json cache_figures() {
  const fs::path cache = program_environment()->cache;
  const char* setting = std::getenv("SUNDOG_KERNEL_CACHE");
  json kernels = folder_figures("kernels", cache.empty() ? cache : cache / "kernels");
  kernels["off"] = setting && std::string_view(setting) == "off";
  return json::array({kernels, folder_figures("tuning", cache.empty() ? cache : cache / "tuning")});
}

/// The report as text, from its JSON.
std::string check_text(const json& report) {
  std::string text = fmt::format("sundog {}, built by {}\n\nDrivers ({})\n", text_of(report, "sundog"),
                                 text_of(report, "compiler"), text_of(report, "vendors"));
  for (const json& driver : report.at("drivers"))
    text += fmt::format("  {:<20}  {}, {} device{}\n{}", text_of(driver, "file"), text_of(driver, "library"),
                        driver.at("devices").get<int>(), driver.at("devices") == 1 ? "" : "s",
                        problem_text(driver));
  if (report.at("drivers").empty()) text += "  none: install one (Debian: pocl-opencl-icd)\n";
  if (const std::string note = text_of(report, "note"); !note.empty()) text += "  " + note + "\n";
  text += "\nCaches\n";
  for (const json& cache : report.at("caches"))
    text += fmt::format(
        "  {:<10}  {}, {} files, {:.1f} MiB{}{}\n", text_of(cache, "what"), text_of(cache, "folder"),
        cache.at("files").get<std::uint64_t>(), cache.at("bytes").get<double>() / (1 << 20),
        cache.at("writable") == true ? "" : ", cannot be written: set XDG_CACHE_HOME to a folder that can",
        cache.value("off", false) ? ", off by SUNDOG_KERNEL_CACHE" : "");
  if (const std::string why = cache_refusal(program_environment()->cache); !why.empty())
    text += fmt::format("  {}\n", why);
  text += "\nDevices\n";
  for (const json& device : report.at("devices")) text += device_text(device);
  return text + problem_text(report);
}

struct CheckOptions {
  std::vector<std::string> devices;
  std::string worker;  // "P:D" or "P:D/N": this is the child that checks this device
  int timeout = 600;
  bool json = false;
};

constexpr const char* status_names[] = {"ok", "differs", "failed"};

json check_json(const SelfCheck& check) {
  return {{"status", status_names[static_cast<int>(check.status)]},
          {"kernels", check.kernels},
          {"build_seconds", check.build_seconds},
          {"render_seconds", check.render_seconds},
          {"pixels", check.pixels},
          {"differing", check.differing},
          {"greatest_difference", check.greatest},
          {"problem", check.problem.empty() ? json(nullptr) : json(check.problem)},
          {"log", check.log.empty() ? json(nullptr) : json(check.log)}};
}

/// Prints a line and flushes it, because what follows may crash the process.
void print_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

int work(const std::string& spec) {
  const DeviceInfo device = select_devices(list_devices(), {spec}).front();
  const SelfCheck check =
      check_device(device, [](const std::string& stage) { print_line("stage " + stage); });
  print_line("result " + json_text(check_json(check)));
  return exit_done;
}

std::string end_text(const ChildResult& child, double seconds) {
  if (child.timed_out) return fmt::format("did not come back within {:.0f} s", seconds);
  if (child.signal) return fmt::format("crashed (signal {}, {})", child.signal, strsignal(child.signal));
  return fmt::format("ended with status {}", child.status);
}

/// The devices that `sundog devices --json` lists in a child process; stores a `problem` if it fails.
json listed_devices(const std::vector<std::string>& variables, double seconds, std::string& problem) {
  std::string text;
  const ChildResult child = run_self({"devices", "--json"}, variables, seconds,
                                     [&](const std::string& line) { text += line + "\n"; });
  const json list = json::parse(text, nullptr, false);
  if (child.status == 0 && list.is_object()) return list.at("devices");
  problem = end_text(child, seconds);
  return json::array();
}

/// Adds "advice" to each row, which depends on whether another row works. `unasked`: some rows were left out.
void add_advice(json& rows, bool unasked, const auto& advice_on, const auto& is_sound) {
  const Others others = std::ranges::any_of(rows, is_sound) ? Others::sound
                        : unasked                           ? Others::unasked
                                                            : Others::none;
  for (json& row : rows) {
    const json& problem = row.at("problem");
    const std::string text = problem.is_string() ? advice_on(problem, others) : "";
    row["advice"] = text.empty() ? json(nullptr) : json(text);
  }
}

/// Reports on stderr that a check begins and how it ended, because some drivers take minutes.
json told(const std::string& what, const std::function<json()>& look, const auto& result_text) {
  tell(fmt::format("checking {}\n", what));
  const Stopwatch clock;
  json result = look();
  tell(fmt::format("  {}: {}, after {:.1f} s\n", what, result_text(result), clock.seconds()));
  return result;
}

fs::path vendors_folder() {
  const char* own = std::getenv("OCL_ICD_VENDORS");
  return own && *own ? own : "/etc/OpenCL/vendors";
}

json check_driver(const fs::path& file, double seconds) {
  std::string problem, library;
  try {
    library = read_file(file);
  } catch (const IoError& error) {
    problem = error.what();
  }
  library = library.substr(0, library.find('\n'));
  json rows = json::array();
  if (problem.empty()) rows = listed_devices({"OCL_ICD_VENDORS=" + file.string()}, seconds, problem);
  const auto devices = std::ranges::count_if(rows, [](const json& row) { return row.contains("index"); });
  if (problem.empty() && rows.empty()) problem = "cannot be loaded, or has no platform";
  return {{"file", file.filename().string()},
          {"library", library},
          {"devices", devices},
          {"problem", problem.empty() ? json(nullptr) : json(problem)}};
}

/// Checks each .icd file by itself.
json check_drivers(const fs::path& folder, double seconds) {
  json drivers = json::array();
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".icd") files.push_back(entry.path());
  std::ranges::sort(files);
  for (const fs::path& file : files)
    drivers.push_back(told(
        "the driver " + file.filename().string(), [&] { return check_driver(file, seconds); },
        [](const json& driver) { return driver.at("problem").is_null() ? "listed" : "failed"; }));
  add_advice(drivers, false, driver_advice,
             [](const json& driver) { return driver.at("devices") > 0 && driver.at("problem").is_null(); });
  return drivers;
}

json check_one(const std::string& index, double seconds) {
  json result;
  std::string stage = "starting";
  const ChildResult child = run_self({"check", "--worker", index}, {}, seconds, [&](const std::string& line) {
    if (line.starts_with("stage ")) stage = line.substr(6);
    if (line.starts_with("result ")) result = json::parse(line.substr(7), nullptr, false);
  });
  if (result.is_object()) return result;
  SelfCheck failed;
  failed.problem = fmt::format("{} while {}", end_text(child, seconds), stage);
  return check_json(failed);
}

/// The row as a DeviceInfo, with the members that pick_devices() reads.
DeviceInfo as_device(const json& row) {
  DeviceInfo device;
  device.platform = row.at("platform");
  device.platform_name = row.at("platform_name");
  device.problem = row.at("usable") == true ? "" : row.at("problem").get<std::string>();
  if (!row.contains("index")) return device;
  device.device = row.at("device");
  device.name = row.at("name");
  device.vendor = row.at("vendor");
  device.type = row.at("type");
  device.compute_units = row.at("compute_units");
  device.max_sub_devices = row.at("max_sub_devices");
  device.estimate = row.at("estimate");
  return device;
}

/// The requested rows (all without --device); adds "sub_units" for a sub-device.
json wanted_rows(const json& rows, const std::vector<std::string>& specs) {
  if (specs.empty()) return rows;
  std::vector<DeviceInfo> all;
  for (const json& row : rows) all.push_back(as_device(row));
  json wanted = json::array();
  for (const DeviceInfo& device : pick_devices(all, specs))
    for (json row : rows)
      if (row.value("index", "") == device.place()) {
        if (device.sub_units > 0) row["sub_units"] = device.sub_units;
        wanted.push_back(std::move(row));
      }
  return wanted;
}

std::string spec_of(const json& row) {
  const std::string index = row.at("index");
  return row.contains("sub_units") ? fmt::format("{}/{}", index, row.at("sub_units").get<unsigned>()) : index;
}

/// `unasked`: there are usable devices besides these rows.
json check_devices(const json& rows, bool unasked, const CheckOptions& options) {
  json devices = json::array();
  for (const json& row : rows) {
    json device = {{"platform", row.at("platform_name")}};
    for (const char* key : {"index", "sub_units", "name", "driver", "version"})
      if (row.contains(key)) device[key] = row.at(key);
    if (row.at("usable") == true) {
      device.update(told(
          fmt::format("{} {}", spec_of(row), row.at("name").get<std::string>()),
          [&] { return check_one(spec_of(row), options.timeout); },
          [](const json& result) { return result.at("status").get<std::string>(); }));
    } else {
      device.update({{"status", "not usable"}, {"problem", row.at("problem")}});
    }
    devices.push_back(std::move(device));
  }
  add_advice(devices, unasked, advice, [](const json& device) { return device.at("status") == "ok"; });
  return devices;
}

int exit_status(const json& devices) {
  const auto has = [&](const char* status) {
    return std::ranges::any_of(devices, [&](const json& device) { return device.at("status") == status; });
  };
  if (has("differs")) return exit_difference;
  return has("failed") || !has("ok") ? exit_device : exit_done;
}

std::ptrdiff_t usable(const json& rows) {
  return std::ranges::count_if(rows, [](const json& row) { return row.at("usable") == true; });
}

int check(const CheckOptions& options) {
  const fs::path folder = vendors_folder();
  std::string problem;
  const json rows = listed_devices({}, options.timeout, problem);
  const json wanted = wanted_rows(rows, options.devices);
  json report = {
      {"schema", 1},
      {"sundog", SUNDOG_VERSION},
      {"compiler", compiler_text()},
      {"vendors", folder.string()},
      {"note", topology_note()},
      {"drivers", check_drivers(folder, options.timeout)},
      {"caches", cache_figures()},
      {"devices", check_devices(wanted, usable(wanted) < usable(rows), options)},
      {"problem", problem.empty() ? json(nullptr)
                                  : json("listing the devices " + problem + ": `sundog devices` says why")}};
  const std::string text = options.json ? json_text(report, 2) + "\n" : check_text(report);
  fmt::print("{}", text);
  return exit_status(report.at("devices"));
}

}  // namespace

void add_check(Arguments& root, Command& chosen) {
  const auto options = std::make_shared<CheckOptions>();
  Arguments* app =
      root.add_subcommand("check", "Check drivers, caches and devices; exit status 6 when a picture differs");
  values(app, "--device", "SPEC", options->devices,
         "only these devices: P:D, cpu, gpu, accelerator, all, part of a name, or !SPEC to take away "
         "(!SPEC?: if it is there); /N for N compute units (default: SUNDOG_DEVICE, or every device)");
  value(app, "--timeout", "N", options->timeout, "seconds that one device may take (default 600)")
      ->range(1, 86400);
  app->add_flag("--json", options->json, "as JSON");
  app->add_option("--worker", options->worker)->hidden();
  app->callback([options, &chosen] {
    if (options->devices.empty()) options->devices = devices_of_environment();
    chosen = Command{[options] { return options->worker.empty() ? check(*options) : work(options->worker); }};
  });
}

}  // namespace sundog
