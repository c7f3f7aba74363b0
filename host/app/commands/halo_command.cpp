// `sundog halo`: traces the halo of a scene, or a common display, on a device. Writes a picture of the sky
// and prints statistics.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/options/command.h"
#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/options/picture_options.h"
#include "app/process/exit_status.h"
#include "app/process/standard_streams.h"
#include "app/process/trace_halo_map.h"
#include "app/process/warnings.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/image_io.h"
#include "base/json_text.h"
#include "base/names.h"
#include "compile/steps.h"

namespace sundog {
namespace {

using std::numbers::pi;

struct HaloOptions {
  PictureOptions picture;
  std::string scene, view = "equirectangular", size = "1024", altitude, rays;
  std::vector<std::string> devices, overrides;
  bool sky = false, json = false, quiet = false, outside_files = false;
};

/// A common display: plates, some columns, and randomly oriented crystals.
EnvironmentDescription usual_halo() {
  EnvironmentDescription e;
  e.type = EnvironmentType::halo;
  e.sun_altitude = 20;
  e.sun_azimuth = 0;
  e.halo.crystals = {{HALO_PLATE, 0.3, 1.5, 1, 2}, {HALO_COLUMN, 2, 1, 1, 1}, {HALO_RANDOM, 1, 1, 1, 2}};
  return e;
}

EnvironmentDescription read_halo(const HaloOptions& options) {
  if (options.scene.empty()) {
    if (!options.overrides.empty()) throw UsageError("--set changes a scene: wanted a SCENE with it");
    return usual_halo();
  }
  const SceneDescription scene = load_for_command(
      options.scene, options.overrides, {.outside_files = options.outside_files}, {options.picture.out});
  print_warnings(scene.warnings);
  if (scene.environment.type != EnvironmentType::halo)
    throw SceneError(options.scene, "/environment", "wanted an environment of the type \"halo\"");
  return scene.environment;
}

EnvironmentDescription halo_of(const HaloOptions& options) {
  EnvironmentDescription e = read_halo(options);
  if (!options.altitude.empty()) {
    const Range limits = limits_of("halo_sun", "altitude");
    e.sun_altitude = parse_real("--altitude", options.altitude, limits.low, limits.high);
  }
  if (!options.rays.empty()) {
    const Range limits = limits_of("halo_environment", "rays");
    e.halo.rays =
        parse_number("--rays", options.rays, static_cast<int>(limits.low), static_cast<int>(limits.high));
  }
  return e;
}

/// The direction of a pixel: x towards the sun, z up. Equirectangular: the sun's azimuth is in the middle,
/// the zenith in the top row. Fisheye (equal angles): the zenith is in the centre, the sun below it, the
/// horizon a circle.
dvec3 direction_of(bool fisheye, int width, int height, int x, int y) {
  double zenith = pi * (y + 0.5) / height, azimuth = 2 * pi * (x + 0.5) / width - pi;
  if (fisheye) {
    const double right = 2 * (x + 0.5) / width - 1, down = 2 * (y + 0.5) / height - 1;
    zenith = std::hypot(right, down) * pi / 2;
    azimuth = std::atan2(right, down);
  }
  return {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
}

/// Looks up the radiance of a scene's environment by direction.
class SkyPicture {
 public:
  SkyPicture(EnvironmentDescription e, const HaloMap& map) {
    e.sun_azimuth = 0;
    const Halo halo{Halo(), &map};  // owns nothing
    flat_ = compile_lights({.environment = &e, .halo = {&halo}});
  }
  dvec3 along(const dvec3& d) const {
    const int width = static_cast<int>(flat_.environments[0].width),
              height = static_cast<int>(flat_.environments[0].height);
    const int x = static_cast<int>((std::atan2(d.y, d.x) / (2 * pi) + 0.5) * width),
              y = static_cast<int>(std::acos(std::clamp(d.z, -1.0, 1.0)) / pi * height);
    const float4& p = flat_.environment[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) *
                                            static_cast<std::size_t>(width) +
                                        static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
    return {p.x, p.y, p.z};
  }

 private:
  Lights flat_;
};

Image picture_of(const HaloOptions& options, const EnvironmentDescription& e, const HaloMap& map, int rows) {
  const bool fisheye = options.view == "fisheye";
  Image image(fisheye ? rows : 2 * rows, rows, 3);
  const auto sky = options.sky ? std::make_unique<SkyPicture>(e, map) : nullptr;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const dvec3 d = direction_of(fisheye, image.width, image.height, x, y);
      if (fisheye && d.z < 0) continue;
      const dvec3 light = sky ? sky->along(d) : halo_radiance(map, d);
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>(light[c]);
    }
  return image;
}

void report(const HaloOptions& options, const EnvironmentDescription& e, const TracedHalo& traced,
            const Image& image) {
  const HaloMap& map = traced.map;
  const double rate = static_cast<double>(traced.rays) / std::max(traced.seconds, 1e-9);
  if (options.json) {
    const nlohmann::ordered_json figures = {{"schema", 1},
                                            {"out", options.picture.out},
                                            {"view", options.view},
                                            {"width", image.width},
                                            {"height", image.height},
                                            {"sun_altitude", e.sun_altitude},
                                            {"cells", map.side},
                                            {"device", traced.device},
                                            {"rays", traced.rays},
                                            {"seconds", traced.seconds},
                                            {"rays_per_second", rate},
                                            {"passed", map.passed},
                                            {"turned", map.turned},
                                            {"kept", map.kept}};
    fmt::print("{}\n", json_text(figures, 2));
  } else if (!options.quiet) {
    fmt::print("{}: {}x{}, {} rays in {:.2f} s ({:.2f} million a second) on {}\n", options.picture.out,
               image.width, image.height, traced.rays, traced.seconds, rate / 1e6, traced.device);
    fmt::print("light: {:.2f} % turned, {:.2f} % passed straight through, {:.2f} % given up inside\n",
               100 * map.turned, 100 * map.passed, 100 * map.kept);
  }
}

int make_picture(const HaloOptions& options) {
  static const std::vector<std::string> views = {"equirectangular", "fisheye"};
  if (std::ranges::count(views, options.view) == 0)
    throw UsageError(
        fmt::format("--view {}: {}", options.view,
                    did_you_mean(options.view, views, "wanted one of equirectangular, fisheye", "")));
  const int rows = parse_number("--size", options.size, 16, 8192);
  const ToneMap tone_map = parse_tone_map(options.picture);
  if (is_standard_stream(options.picture.out)) throw UsageError("-o -: wanted the name of an image file");
  check_output_files({options.picture.out}, {options.scene});
  check_picture(options.picture, false);
  const EnvironmentDescription e = halo_of(options);
  const std::vector<DeviceInfo> devices = pick_devices(options.devices);
  const TracedHalo traced = trace_halo_map(e, devices, options.quiet || options.json);
  const Image image = shown_in(options.picture.out, picture_of(options, e, traced.map, rows), tone_map,
                               dithers(options.picture));
  write_image(image, options.picture.out, {}, file_options(options.picture));
  warn_of_halves(options.picture.out, image, file_options(options.picture));
  report(options, e, traced, image);
  return exit_done;
}

}  // namespace

void add_halo(Arguments& root, Command& chosen) {
  const auto options = std::make_shared<HaloOptions>();
  Arguments* app = root.add_subcommand("halo", "The light that ice crystals send, as a picture of the sky");
  value(app, "SCENE", "FILE", options->scene,
        "a scene whose environment is a halo (default: plates, columns and others, the sun 20 degrees high)");
  value(app, "-o,--out", "FILE", options->picture.out, "image file: .png, .jpg, .exr, .hdr or .pfm")
      ->required();
  value(app, "--view", "NAME", options->view,
        "equirectangular (default; the sun's azimuth in the middle) or fisheye (the zenith in the middle)");
  value(app, "--size", "N", options->size, "rows of the picture (default 1024)");
  app->add_flag("--sky", options->sky,
                "the sky as a scene shows it; without: the crystals' light alone, a steradian's part of 1");
  value(app, "--altitude", "DEGREES", options->altitude, "the sun's height above the horizon");
  value(app, "--rays", "N", options->rays, "rays of sunlight that meet crystals");
  values(app, "--set", "POINTER=VALUE", options->overrides,
         "change the scene, as in /environment/cells=2048");
  add_tone_options(app, options->picture);
  app->add_flag("--float", options->picture.full_floats,
                "keep an .exr's colours as 32-bit floats (default: half)");
  values(app, "--device", "SPEC", options->devices, device_help);
  outside_files(app, options->outside_files);
  app->add_flag("--json", options->json, "print the figures as JSON");
  app->add_flag("-q,--quiet", options->quiet, "no progress bar and no summary");
  app->callback([options, &chosen] { chosen = Command{[options] { return make_picture(*options); }}; });
}

}  // namespace sundog
