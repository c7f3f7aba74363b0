// `sundog kernels`: lists the plain kernel files, prints one converted to lanes or why its values vary, or
// writes a scene's programs.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "app/options/command.h"
#include "app/options/option_helpers.h"
#include "app/process/environment.h"
#include "app/render/output_files.h"
#include "base/error.h"
#include "base/file.h"
#include "base/input.h"
#include "compile/compiled_scene.h"
#include "device/build_options.h"
#include "device/device_rules.h"
#include "device/embedded_kernels.h"
#include "device/kernel_source.h"
#include "lanes/lanes.h"
#include "render/device/halo_tracer.h"
#include "render/device/scene_programs.h"
#include "scene/load.h"

namespace sundog {
namespace {

struct KernelsCommand {
  std::string file;
  int lanes = 0;
  bool explains = false, lines = false;
  std::string scene, gpu, out;
};

/// The path of an embedded plain kernel unchanged; a user's file gets a path below plain/.
std::string plain_path(const std::string& file) {
  if (spmd::is_plain(file)) return file;
  return "plain/" + std::filesystem::path(file).filename().string();
}

std::string list_text() {
  std::string out;
  for (const EmbeddedKernel& kernel : embedded_kernels())
    if (spmd::is_plain(std::string(kernel.path)) && kernel.path.ends_with(".cl"))
      out += fmt::format("{}\n", kernel.path);
  return out;
}

std::string made_text(const KernelsCommand& c) {
  const std::string path = plain_path(c.file);
  const spmd::ReadFile read = [&](const std::string& wanted) {
    return wanted == path && wanted != c.file
               ? read_input(c.file)
               : embedded_kernel(wanted, value_of(program_environment()).kernels);
  };
  spmd::Lanes lanes(read, true);
  if (c.explains) return lanes.explained(path);
  return (c.lanes > 0 ? fmt::format("#define LANES {}\n", c.lanes) : "") + lanes.text(path, c.lines);
}

/// Writes the scene's programs as a GPU's compiler would receive them, without a device. Returns a line for
/// each: its file and build options.
std::string write_programs(const KernelsCommand& c) {
  const DeviceInfo device = typical_gpu(c.gpu);
  const HostEnvironment& environment = value_of(program_environment());
  const SceneDescription scene = load_for_command(c.scene, {}, {});
  std::vector<SceneProgram> programs = scene_programs(compile(scene), device);
  if (scene.environment.type == EnvironmentType::halo) programs.push_back(halo_program(device));
  std::error_code failed;
  std::filesystem::create_directories(c.out, failed);
  if (failed)
    throw IoError(fmt::format("{}: {}: name a folder that can be written", c.out, failed.message()));
  std::string list;
  for (auto& [entry, defines, generated] : programs) {
    defines.emplace("DEVICE_HAS_FMA", "1");
    const auto file = std::filesystem::path(c.out) / std::filesystem::path(entry).filename();
    const KernelText text{entry, defines, generated, environment.kernels};
    write_file(file, text.expanded());
    list += fmt::format("{} {}\n", file.string(), all_build_options(device, {}, text));
  }
  return list;
}

}  // namespace

void add_kernels(Arguments& root, Command& chosen) {
  Arguments* app =
      root.add_subcommand("kernels", "Print what is made of a plain kernel file: functions in lanes");
  const auto c = std::make_shared<KernelsCommand>();
  app->add_option("file", c->file, "a file of kernels/plain, or of your own (without it, the list)");
  value(app, "--lanes", "N", c->lanes, "1, 4, 8 or 16: begin with #define LANES N");
  app->add_flag("--explain", c->explains, "what varies from lane to lane in each function, and why");
  app->add_flag("--lines", c->lines, "with #line directives that name the plain file");
  value(app, "--scene", "FILE", c->scene,
        "write the programs of this scene to files, and list them with their build options");
  value(app, "--gpu", "MAKER", c->gpu, "of --scene: as a GPU of nvidia, amd or intel gets them");
  value(app, "--out", "FOLDER", c->out, "of --scene: the files' folder");
  app->callback([c, &chosen] {
    if (c->scene.empty() != c->gpu.empty() || c->scene.empty() != c->out.empty())
      throw UsageError("kernels: --scene, --gpu and --out go together");
    if (c->lanes != 0 && c->lanes != 1 && c->lanes != 4 && c->lanes != 8 && c->lanes != 16)
      throw UsageError(fmt::format("--lanes: wanted 1, 4, 8 or 16, found {}", c->lanes));
    const auto print = [c] {
      fmt::print("{}", !c->scene.empty() ? write_programs(*c)
                       : c->file.empty() ? list_text()
                                         : made_text(*c));
      return static_cast<int>(exit_done);
    };
    chosen = {.run = print, .only_prints = true};
  });
}

}  // namespace sundog
