// `sundog compare A B`: the figures, a picture of the differences, and a status for scripts.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/options/commands.h"
#include "app/options/output_files.h"
#include "base/file.h"
#include "base/image_compare.h"
#include "base/image_io.h"

namespace sundog {
namespace {

using nlohmann::json;

/// JSON has no infinity.
json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json to_json(const CompareCommand& command, const Image& a, int channels, const ImageDifference& d) {
  return {{"schema", 1},
          {"a", command.a},
          {"b", command.b},
          {"width", a.width},
          {"height", a.height},
          {"alpha", channels == 4},
          {"pixels", d.pixels},
          {"mean", d.mean},
          {"rms", d.rms},
          {"max", number_or_null(d.max)},
          {"percentile_99", number_or_null(d.percentile_99)},
          {"psnr", number_or_null(d.psnr)},
          {"differing", d.differing},
          {"tolerance", command.tolerance},
          {"over_tolerance", d.over_tolerance},
          {"non_finite", d.non_finite},
          {"equal", d.differing == 0}};
}

void print_text(const CompareCommand& command, const ImageDifference& d) {
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
}

int report_sizes(const CompareCommand& command, const Image& a, const Image& b) {
  if (command.json)
    fmt::print("{}\n", json{{"schema", 1},
                            {"a", command.a},
                            {"b", command.b},
                            {"sizes", {{a.width, a.height}, {b.width, b.height}}},
                            {"equal", false}}
                           .dump(2));
  fmt::print(stderr,
             "sundog: {}: {}x{} pixels, but {} has {}x{}: images of different sizes cannot be compared\n",
             command.a, a.width, a.height, command.b, b.width, b.height);
  return exit_difference;
}

}  // namespace

int compare_command(const CompareCommand& command) {
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
  if (command.json)
    fmt::print("{}\n",
               to_json(command, a, channels, difference).dump(2, ' ', false, json::error_handler_t::replace));
  else
    print_text(command, difference);
  return difference.over_tolerance > 0 ? exit_difference : exit_done;
}

}  // namespace sundog
