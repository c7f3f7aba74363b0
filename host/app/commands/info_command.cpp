// `sundog info SCENE`: prints a scene's contents and sizes; uses no device.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "app/options/command.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/process/scene_figures.h"
#include "app/process/warnings.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/json_text.h"
#include "scene/json/override.h"

namespace sundog {
namespace {

using nlohmann::json;

struct InfoCommand {
  std::string scene;
  bool outside_files = false;          // as for render
  std::vector<std::string> overrides;  // "JSON_POINTER=VALUE"
  bool json = false;
};

/// {"point": 2, "spot": 1} as "2 point, 1 spot".
std::string counts_text(const json& counts) {
  std::string text;
  for (const auto& [name, count] : counts.items())
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.get<int>(), name);
  return text.empty() ? "none" : text;
}

std::string point_text(const json& point) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", point[0].get<double>(), point[1].get<double>(),
                     point[2].get<double>());
}

void print_image(const json& image) {
  const auto number = [&](const char* key) { return image[key].get<int>(); };
  const bool smaller = image["width"] != image["file_width"] || image["height"] != image["file_height"];
  fmt::print("image      {}: {}x{}{}, {} bits, {}, {:.2f} MiB\n", image["name"].get<std::string>(),
             number("width"), number("height"),
             smaller ? fmt::format(" (of {}x{})", number("file_width"), number("file_height")) : "",
             number("bits"), image["use"].get<std::string>(), image["bytes"].get<double>() / (1 << 20));
}

void print_text(const json& figures) {
  const auto number = [&](const char* key) { return figures[key].get<std::uint64_t>(); };
  const auto mebibytes = [&](const char* key) { return figures["bytes"][key].get<double>() / (1 << 20); };
  const json& bvh = figures["bvh"];
  fmt::print("triangles  {} ({} as placed) in {} meshes\n", number("triangles"), number("placed_triangles"),
             number("meshes"));
  fmt::print("objects    {} ({} unbounded)\n", counts_text(figures["objects"]), number("unbounded"));
  fmt::print("instances  {}\n", number("instances"));
  fmt::print("lights     {}\n", counts_text(figures["lights"]));
  fmt::print("materials  {}, media {}\n", number("materials"), number("media"));
  fmt::print("BVH        {} nodes, {} blocks of 8 triangles ({:.2f} filled), built in {:.0f} ms\n",
             bvh["nodes"].get<std::uint64_t>(), bvh["blocks"].get<std::uint64_t>(),
             bvh["mean_block_fill"].get<double>(), 1000 * bvh["build_seconds"].get<double>());
  fmt::print("SAH cost   {:.2f}: {}\n", bvh["sah_cost"].get<double>(),
             bvh["sah_cost_unit"].get<std::string>());
  fmt::print("memory     {:.2f} MiB: BVH {:.2f}, shading {:.2f}, images {:.2f}, tables {:.2f}\n",
             mebibytes("total"), mebibytes("bvh"), mebibytes("shading"), mebibytes("images"),
             mebibytes("tables"));
  for (const json& image : figures["images"]) print_image(image);
  for (const json& field : figures["field_bounds"])
    fmt::print("field      {}: {} to {}\n", field["name"].get<std::string>(), point_text(field["min"]),
               point_text(field["max"]));
  if (const json& bounds = figures["bounds"]; bounds.is_null())
    fmt::print("bounds     none\n");
  else
    fmt::print("bounds     {} to {}\n", point_text(bounds["min"]), point_text(bounds["max"]));
}

/// Compiles the scene; an error at a place that an option changed becomes a UsageError.
CompiledScene compile_overridden(const SceneDescription& scene, const InfoCommand& command) {
  try {
    return compile(scene);
  } catch (const SceneError& error) {
    for (const std::string& setting : command.overrides)
      if (error.file == scene_file_name(command.scene) && concerns(setting, error.place))
        throw UsageError(error.what());
    throw;
  }
}

int print_figures(const InfoCommand& command) {
  for (const std::string& setting : command.overrides) check_override(setting);
  const SceneDescription scene =
      load_for_command(command.scene, command.overrides, {.outside_files = command.outside_files});
  print_warnings(scene.warnings);
  const CompiledScene flat = compile_overridden(scene, command);
  json figures = scene_figures(scene, flat);
  figures["schema"] = 1;
  if (command.json)
    fmt::print("{}\n", json_text(figures, 2));
  else
    print_text(figures);
  return exit_done;
}

}  // namespace

void add_info(Arguments& root, Command& chosen) {
  const auto command = std::make_shared<InfoCommand>();
  Arguments* app = root.add_subcommand("info", "What a scene holds: triangles, lights, BVH figures, bytes");
  value(app, "SCENE", "FILE", command->scene, scene_help)->required();
  values(app, "--set", "POINTER=VALUE", command->overrides,
         "change the scene, as in /render/spatial_splits=true");
  outside_files(app, command->outside_files);
  app->add_flag("--json", command->json, "as JSON");
  app->callback([command, &chosen] {
    chosen = {
        .run = [command] { return print_figures(*command); }, .in_first_thread = true, .only_prints = true};
  });
}

}  // namespace sundog
