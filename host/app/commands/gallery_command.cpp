// `sundog gallery`: renders scenes (by default those that come with sundog) to pictures on one page. Writes a
// PNG for each into a folder, and index.html after each picture, so that an interrupt leaves a complete page.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "app/options/command.h"
#include "app/options/devices.h"
#include "app/options/option_helpers.h"
#include "app/options/option_values.h"
#include "app/process/exit_status.h"
#include "app/process/progress.h"
#include "app/process/spawn_self.h"
#include "app/process/warnings.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/file.h"
#include "base/image_io.h"
#include "bench/report/gallery_page.h"
#include "bench/report/machine.h"
#include "render/device/tuning.h"
#include "render/session/render_session.h"

namespace sundog {
namespace {

namespace fs = std::filesystem;

struct GalleryOptions {
  std::string folder, size, samples;
  std::vector<std::string> scenes, devices;
  bool outside_files = false, quiet = false;
};

/// The scenes that come with sundog: beside an installed program, or in the source tree of a build.
std::vector<std::string> shipped_scenes() {
  std::error_code failed;
  const fs::path here = program_file().parent_path();
  for (const char* place : {"../share/sundog/scenes", "../../scenes"}) {
    const fs::path folder = here / place;
    if (!fs::exists(folder / "scene.schema.json", failed)) continue;
    std::vector<std::string> scenes;
    for (const auto& entry : fs::directory_iterator(folder, failed))
      if (entry.path().extension() == ".json" && entry.path().filename() != "scene.schema.json")
        scenes.push_back(fs::weakly_canonical(entry.path(), failed).string());
    std::ranges::sort(scenes);
    return scenes;
  }
  throw UsageError("gallery: the scenes that come with sundog are not beside it: name scenes after DIR");
}

std::string stem(const std::string& scene) { return fs::path(scene).stem().string(); }

/// Throws UsageError for two scenes of the same name, whose pictures would be the same file.
void check_names(const std::vector<std::string>& scenes) {
  std::set<std::string> names;
  for (const std::string& scene : scenes)
    if (!names.insert(stem(scene)).second)
      throw UsageError(fmt::format(
          "gallery: {}: another scene has the name {} too, and pictures are named after scenes: rename one",
          scene, stem(scene)));
}

void make_folder(const std::string& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw IoError(fmt::format("{}: cannot be made: {}", folder, failed.message()));
}

std::vector<std::string> overrides_of(const GalleryOptions& options) {
  std::vector<std::string> all;
  if (!options.size.empty()) all = parse_image_size(options.size);
  if (!options.samples.empty()) all.push_back(render_setting("--samples", "samples", options.samples));
  return all;
}

std::string command_of(const GalleryOptions& options, const std::string& scene) {
  std::string text =
      fmt::format("sundog render {} -o {}", shell_word(scene), shell_word(stem(scene) + ".png"));
  if (!options.size.empty()) text += " --size " + options.size;
  if (!options.samples.empty()) text += " --samples " + options.samples;
  return text;
}

/// The files of the page and of all pictures.
std::vector<std::string> output_files(const GalleryOptions& options) {
  const fs::path folder = options.folder;
  std::vector<std::string> files = {(folder / "index.html").string()};
  for (const std::string& scene : options.scenes) files.push_back((folder / (stem(scene) + ".png")).string());
  return files;
}

GalleryPicture make_picture(const GalleryOptions& options, const std::string& scene, RenderSession& session) {
  const SceneDescription description = load_for_command(
      scene, overrides_of(options), {.outside_files = options.outside_files}, output_files(options));
  if (!options.quiet) print_warnings(description.warnings);
  const auto flat = std::make_shared<const CompiledScene>(compile(description));
  ProgressBar bar(!options.quiet);
  RenderOptions frame;
  frame.channels = 3;
  frame.tuning = [flat](const DeviceInfo& device) { return saved_tuning(device, *flat); };
  frame.on_progress = [&](const RenderProgress& now) { bar.update(now); };
  const RenderResult result = session.render(flat, frame);
  bar.erase();

  GalleryPicture picture;
  picture.name = stem(scene);
  picture.file = picture.name + ".png";
  picture.command = command_of(options, scene);
  picture.width = static_cast<int>(flat->info.width);
  picture.height = static_cast<int>(flat->info.height);
  picture.samples = description.render.samples;
  picture.seconds = result.times.render;
  picture.rays = {{"primary", result.counts[COUNT_PRIMARY]},
                  {"reflection", result.counts[COUNT_REFLECTION]},
                  {"refraction", result.counts[COUNT_REFRACTION]},
                  {"shadow", result.counts[COUNT_SHADOW]}};
  write_image(shown_in(picture.file, result.image, description.image.tone_map),
              fs::path(options.folder) / picture.file);
  return picture;
}

int gallery(GalleryOptions options) {
  if (options.scenes.empty()) options.scenes = shipped_scenes();
  check_names(options.scenes);
  overrides_of(options);
  check_output_files(output_files(options), options.scenes);
  make_folder(options.folder);
  const fs::path page = fs::path(options.folder) / "index.html";
  check_writable(page);
  const std::vector<DeviceInfo> devices = pick_devices(options.devices);
  Gallery all{"sundog gallery", {{"sundog", SUNDOG_VERSION}}, {}};
  for (const DeviceInfo& device : devices) all.facts.emplace_back("device", device_fact(device));
  const Facts machine = machine_facts();
  all.facts.insert(all.facts.end(), machine.begin(), machine.end());
  if (const std::string note = busy_note(); !note.empty()) all.facts.emplace_back("load", note);
  RenderSession session(devices);
  for (const std::string& scene : options.scenes) {
    all.pictures.push_back(make_picture(options, scene, session));
    write_file(page, gallery_html(all));
    if (!options.quiet)
      fmt::print("{:3} of {}  {}  {:.3g} s\n", all.pictures.size(), options.scenes.size(),
                 all.pictures.back().name, all.pictures.back().seconds);
  }
  if (!options.quiet) fmt::print("{}\n", page.string());
  return exit_done;
}

}  // namespace

void add_gallery(Arguments& root, Command& chosen) {
  const auto options = std::make_shared<GalleryOptions>();
  Arguments* app =
      root.add_subcommand("gallery", "Render scenes to pictures on one page, for any web server");
  value(app, "DIR", "DIR", options->folder, "folder for index.html and the pictures")->required();
  app->add_option("SCENE", options->scenes, "scenes and models (default: the scenes that come with sundog)")
      ->type_name("FILE");
  values(app, "--device", "SPEC", options->devices, device_help);
  value(app, "--size", "WxH", options->size, "width and height in pixels (default: each scene's)");
  value(app, "--samples", "N", options->samples, "samples a pixel (default: each scene's)");
  outside_files(app, options->outside_files);
  app->add_flag("-q,--quiet", options->quiet, "no progress and no names");
  app->callback([options, &chosen] { chosen = Command{[options] { return gallery(*options); }}; });
}

}  // namespace sundog
