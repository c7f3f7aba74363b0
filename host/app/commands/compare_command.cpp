// `sundog compare A B`: compares two images. Prints statistics, writes a picture of the differences, and
// returns a status for scripts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/options/command.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/render/output_files.h"
#include "base/file.h"
#include "base/image_compare.h"
#include "base/image_io.h"
#include "base/json_text.h"

namespace sundog {
namespace {

using nlohmann::json;

struct CompareCommand {
  std::string a, b, diff;
  double tolerance = 0;
  bool json = false;
};

/// Replaces non-finite numbers, which JSON lacks, by null.
json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json to_json(const ImageDifference& d) {
  return {{"mean", d.mean},
          {"rms", d.rms},
          {"max", number_or_null(d.max)},
          {"percentile_99", number_or_null(d.percentile_99)},
          {"psnr", number_or_null(d.psnr)},
          {"differing", d.differing},
          {"over_tolerance", d.over_tolerance},
          {"non_finite", d.non_finite}};
}

/// Differences between the additional layers of two EXR files.
struct ComparedLayers {
  std::map<std::string, ImageDifference> both;
  std::vector<std::string> other;  // layers that one file lacks, or has with other channels
};

ComparedLayers compare_layers(const CompareCommand& command) {
  const AovImages a = read_aovs(command.a), b = read_aovs(command.b);
  ComparedLayers layers;
  for (const auto& [name, image] : a) {
    const auto found = b.find(name);
    if (found != b.end() && found->second.channels == image.channels)
      layers.both[name] = compare_images(image, found->second, command.tolerance, image.channels);
    else
      layers.other.push_back(name);
  }
  for (const auto& [name, image] : b)
    if (!a.contains(name)) layers.other.push_back(name);
  return layers;
}

void print_json(const CompareCommand& command, const Image& a, int channels, const ImageDifference& d,
                const ComparedLayers& layers) {
  json figures = to_json(d);
  bool equal = d.differing == 0;
  json others = json::object();
  for (const auto& [name, difference] : layers.both) {
    others[name] = to_json(difference);
    equal = equal && difference.differing == 0;
  }
  figures.update({{"schema", 1},
                  {"a", command.a},
                  {"b", command.b},
                  {"width", a.width},
                  {"height", a.height},
                  {"alpha", channels == 4},
                  {"pixels", d.pixels},
                  {"tolerance", command.tolerance},
                  {"layers", others},
                  {"layers_not_compared", layers.other},
                  {"equal", equal}});
  fmt::print("{}\n", json_text(figures, 2));
}

void print_text(const CompareCommand& command, const ImageDifference& d, const ComparedLayers& layers) {
  const auto percent = [&](std::uint64_t count) {
    return fmt::format("{} of {} ({:.3g} %)", count, d.pixels,
                       100 * static_cast<double>(count) / static_cast<double>(d.pixels));
  };
  fmt::print("mean              {:.6g}\n", d.mean);
  fmt::print("rms               {:.6g}\n", d.rms);
  fmt::print("99th percentile   {:.6g}\n", d.percentile_99);
  fmt::print("max               {:.6g}\n", d.max);
  fmt::print("PSNR              {:.2f} dB\n", d.psnr);
  fmt::print("pixels differing  {}\n", percent(d.differing));
  fmt::print("pixels over {:<5.3g} {}\n", command.tolerance, percent(d.over_tolerance));
  if (d.non_finite > 0) fmt::print("pixels not finite {}\n", percent(d.non_finite));
  for (const auto& [name, layer] : layers.both)
    fmt::print("layer {}: max {:.6g}, pixels differing {}, over {:.3g} {}\n", name, layer.max,
               percent(layer.differing), command.tolerance, percent(layer.over_tolerance));
  for (const std::string& name : layers.other) fmt::print("layer {}: not in both files alike\n", name);
}

int report_sizes(const CompareCommand& command, const Image& a, const Image& b) {
  if (command.json)
    fmt::print("{}\n", json_text({{"schema", 1},
                                  {"a", command.a},
                                  {"b", command.b},
                                  {"sizes", {{a.width, a.height}, {b.width, b.height}}},
                                  {"equal", false}},
                                 2));
  fmt::print(stderr,
             "sundog: {}: {}x{} pixels, but {} has {}x{}: images of different sizes cannot be compared\n",
             command.a, a.width, a.height, command.b, b.width, b.height);
  return exit_difference;
}

int compare(const CompareCommand& command) {
  check_output_files({command.diff}, {command.a, command.b});
  if (!command.diff.empty()) {
    check_image_path(command.diff, false);
    check_writable(command.diff);
  }
  const auto [a, a_has_alpha] = read_image_in_file(command.a);
  const auto [b, b_has_alpha] = read_image_in_file(command.b);
  if (a.width != b.width || a.height != b.height) return report_sizes(command, a, b);
  const int channels = a_has_alpha && b_has_alpha ? 4 : 3;
  const ImageDifference difference = compare_images(a, b, command.tolerance, channels);
  if (!command.diff.empty()) write_image(difference_image(a, b, channels), command.diff);
  const ComparedLayers layers = compare_layers(command);
  if (command.json)
    print_json(command, a, channels, difference, layers);
  else
    print_text(command, difference, layers);
  const bool layers_pass =
      std::ranges::all_of(layers.both, [](const auto& layer) { return layer.second.over_tolerance == 0; });
  return difference.over_tolerance > 0 || !layers_pass ? exit_difference : exit_done;
}

}  // namespace

void add_compare(Arguments& root, Command& chosen) {
  const auto command = std::make_shared<CompareCommand>();
  const auto tolerance = std::make_shared<std::string>("0");
  Arguments* app = root.add_subcommand("compare", "Compare two images; exit status 6 when they differ");
  value(app, "A", "FILE", command->a, "image file: .png, .jpg, .exr, .hdr or .pfm")->required();
  value(app, "B", "FILE", command->b, "image file")->required();
  value(app, "--tolerance", "T", *tolerance,
        "greatest difference that passes, in linear colour (1 is white; default 0)");
  value(app, "--diff", "FILE", command->diff, "write a picture that shows where they differ");
  app->add_flag("--json", command->json, "print the figures as JSON");
  app->callback([command, tolerance, &chosen] {
    command->tolerance = parse_tolerance(*tolerance);
    chosen = {.run = [command] { return compare(*command); }, .in_first_thread = true};
  });
}

}  // namespace sundog
