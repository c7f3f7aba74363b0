// Reads tuning results from JSON: the device's own, and files for `sundog tune --import`. Errors name the
// file and the place.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "device/build_options.h"
#include "render/device/tuning.h"
#include "scene/json/parse.h"

namespace sundog {
namespace {

constexpr const char* kept = "one as in an export of tunings";

/// Reads a string that scene_class() may return.
std::string scene_class_from(const JsonValue& value) {
  const std::string found = value.text();
  for (const char* kind : {"fields", "meshes", "solids"})
    for (const char* tracer : {"", "+wide", "+compact"})
      for (const Integrator& integrator : integrators)
        for (const char* rays : {"", "+rays"})
          if (found == fmt::format("{}{}{}{}", kind, tracer, integrator.tuning, rays)) return found;
  std::string ends;
  for (const Integrator& integrator : integrators)
    if (!integrator.tuning.empty())
      ends += fmt::format("{} for the integrator {}, ", integrator.tuning, integrator.name);
  value.wanted(
      "a class of scenes: solids, meshes or fields, then +wide or +compact where a tracer was asked for, " +
      ends + "then +rays where there are secondary rays");
}

WorkGroup work_group_from(const JsonValue& value) {
  const auto group = work_group_of(value.text());
  if (!group) value.wanted("a size such as \"64\" or \"8x8\", \"default\" or \"driver\"");
  return *group;
}

std::string options_from(const JsonValue& value) {
  const std::string text = value.text();
  if (!may_be_tuned(text)) value.wanted("options that sundog tune tries, such as \"-DNODE_LOOP=1\"");
  return text;
}

TuningEntry entry_from(JsonObject& entry) {
  constexpr Range milliseconds{.low = 0, .high = 10000};
  constexpr std::array<std::string_view, 2> kernels = {frame_kernel, surfaces_kernel};
  const auto whole = [&](const char* key, int most) {
    return static_cast<unsigned>(entry.at(key, kept).integer(0, most));
  };
  TuningEntry result;
  Tuning& tuning = result.tuning;
  result.kernel = entry.at("kernel", kept).choice(kernels);
  result.scene_class = scene_class_from(entry.at("class", kept));
  result.scene = entry.at("scene", kept).text();
  tuning.work_group = work_group_from(entry.at("work_group", kept));
  tuning.surfaces_group = work_group_from(entry.at("surfaces_group", kept));
  tuning.tile_w = whole("tile_w", 16);
  tuning.tile_h = whole("tile_h", 16);
  // Batch sizes for which vectors exist.
  constexpr std::array<unsigned, 5> batches = {0, 1, 4, 8, 16};
  const unsigned batch = tuning.tile_w * tuning.tile_h;
  if ((tuning.tile_w == 0) != (tuning.tile_h == 0) || std::ranges::find(batches, batch) == batches.end())
    entry.value().fail(
        fmt::format("wanted tile_w and tile_h both 0, or with a product of 1, 4, 8 or 16, found {} and {}",
                    tuning.tile_w, tuning.tile_h));
  tuning.packet_least = whole("packet_least", 64);
  tuning.launch_ms = entry.at("launch_ms", kept).number(milliseconds);
  tuning.tile_ms = entry.at("tile_ms", kept).number(milliseconds);
  if (const auto options = entry.find("options")) tuning.options = options_from(*options);
  result.default_ms = entry.at("default_ms", kept).number(at_least_0);
  result.tuned_ms = entry.at("tuned_ms", kept).number(at_least_0);
  return result;
}

}  // namespace

TuningFile read_tuning(const JsonValue& value) {
  constexpr int most_units = 1 << 20;
  return value.object("tuning", [](JsonObject& object) {
    object.at("schema", kept).integer(1, 1);
    TuningFile file;
    file.platform = object.at("platform", kept).text();
    file.device = object.at("device", kept).text();
    file.driver = object.at("driver", kept).text();
    file.kernels = object.at("kernels", kept).text();
    file.units = static_cast<unsigned>(object.at("units", kept).integer(0, most_units));
    for (const JsonValue& entry : object.at("entries", kept).items("tuning results"))
      file.entries.push_back(entry.object("entry", entry_from));
    return file;
  });
}

TuningFile read_tuning_file(const std::filesystem::path& file) {
  const JsonContext context{.file = file};
  const nlohmann::json json = read_json_file(file);
  return read_tuning(JsonValue(json, context));
}

}  // namespace sundog
