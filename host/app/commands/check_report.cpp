// See check_report.h.
#include "app/commands/check_report.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/process/environment.h"
#include "base/cache_folder.h"
#include "base/file.h"

namespace sundog {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Whether files can be made in the folder, or the folder itself in the nearest one above it.
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

/// Problem and advice, as lines below what they belong to.
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

}  // namespace

json cache_figures() {
  const fs::path cache = program_environment()->cache;
  const char* setting = std::getenv("SUNDOG_KERNEL_CACHE");
  json kernels = folder_figures("kernels", cache.empty() ? cache : cache / "kernels");
  kernels["off"] = setting && std::string_view(setting) == "off";
  return json::array({kernels, folder_figures("tuning", cache.empty() ? cache : cache / "tuning")});
}

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

}  // namespace sundog
