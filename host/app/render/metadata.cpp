// Collects program, settings, devices and time under PNG's or OpenEXR's names.
#include "app/render/metadata.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>

#include "app/process/revision.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/numbers.h"

namespace sundog {
namespace {

std::string settings_text(const RenderCommand& command, const SceneDescription& scene) {
  std::string text =
      fmt::format("{}x{} pixels, samples {}, max_depth {}, integrator {}", scene.image.width,
                  scene.image.height, scene.render.samples, scene.render.max_depth, scene.render.integrator);
  if (command.frame) text += fmt::format(", frame {}", *command.frame);
  if (command.denoise) text += ", denoised";
  for (const std::string& setting : command.overrides) text += ", " + setting;
  return text;
}

std::string devices_text(const RenderResult& result) {
  std::vector<std::string> names;
  for (const DeviceReport& report : result.devices)
    if (report.pixels > 0)
      names.push_back(
          fmt::format("{}/{} ({})", report.info.platform_name, report.info.name, report.info.driver));
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::time_t time_of_picture() {
  constexpr std::time_t most = 253402300799;  // the end of the year 9999
  const char* set = std::getenv("SOURCE_DATE_EPOCH");
  if (!set || !*set) return std::time(nullptr);
  const std::time_t seconds = whole_number<std::time_t>(set).value_or(-1);
  if (seconds < 0 || seconds > most)
    throw UsageError(fmt::format(
        "SOURCE_DATE_EPOCH={:.40}: wanted a time for --metadata, whole seconds since 1970 from 0 to {}", set,
        most));
  return seconds;
}

ImageTexts metadata(const RenderCommand& command, const SceneDescription& scene, const RenderResult& result) {
  const std::string program = fmt::format("sundog {} ({})", SUNDOG_VERSION, build_revision());
  const std::string settings = settings_text(command, scene), devices = devices_text(result);
  const std::tm utc = fmt::gmtime(time_of_picture());
  if (drops_alpha(format_name(command)))  // PNG's registered keywords, and two more
    return {{"Software", program},
            {"Source", command.scene},
            {"Settings", settings},
            {"Device", devices},
            {"Creation Time", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", utc)}};
  return {{"software", program},
          {"scene", command.scene},
          {"settings", settings},
          {"device", devices},
          {"capDate", fmt::format("{:%Y:%m:%d %H:%M:%S}", utc)}};  // OpenEXR's standard attribute
}

}  // namespace sundog
