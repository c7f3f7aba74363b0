// Builds every kernel, compares a small picture with plain C++, and chooses advice by a problem's words.
#include "bench/rays/self_check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/error.h"
#include "base/image_compare.h"
#include "bench/plain/whitted.h"
#include "compile/compiled_scene.h"
#include "device/embedded_kernels.h"
#include "render/device/kernel_config.h"
#include "render/render.h"
#include "scene/load.h"

namespace sundog {
namespace {

// A visible difference, and one in how many pixels may have one: rounding moves rays on silhouettes and on
// borders of checkers to either side.
constexpr double visible_difference = 0.02;
constexpr std::uint64_t pixels_per_flip = 200;

constexpr const char* scene_text = R"({
  "camera": {"position": [0.4, 1.6, 5.5], "target": [0, -0.2, 0]},
  "image": {"width": 64, "height": 48, "background": {"bottom": [0.5, 0.6, 0.7], "top": [0.1, 0.2, 0.5]}},
  "render": {"samples": 2},
  "lights": [{"type": "ambient"}, {"type": "point", "position": [-3, 5, 4]}],
  "media": {
    "glass": {"ior": 1.5, "absorption": [0.1, 0.05, 0.02]},
    "liquid": {"ior": 1.33, "absorption": [0.4, 0.9, 1.2]}
  },
  "materials": {
    "floor": {"color": {"checker": [[1, 1, 1], [0.125, 0.375, 0.25]]}},
    "glass": {"type": "dielectric", "medium": "glass"},
    "liquid": {"type": "dielectric", "medium": "liquid"},
    "mirror": {"reflection": 0.7, "specular": {"coefficient": 0.5}},
    "matt": {"diffuse": {"color": [0.8, 0.4, 0.2], "coefficient": 1}}
  },
  "objects": [
    {"type": "plane", "point": [0, -1, 0], "normal": [0, 1, 0], "material": "floor"},
    {"type": "sphere", "center": [-0.9, -0.1, 0.6], "radius": 0.9, "material": "glass"},
    {"type": "sphere", "center": [-0.9, -0.1, 0.6], "radius": 0.5, "material": "liquid"},
    {"type": "sphere", "center": [1.1, -0.2, -0.4], "radius": 0.8, "material": "mirror"},
    {"type": "mesh", "mesh": "pyramid", "material": "matt", "transform": [{"translate": [0.5, 0, 1.4]}]}
  ]
})";

/// A four-sided pyramid.
Mesh pyramid() {
  Mesh mesh;
  mesh.positions = {{-0.6f, -1, -0.6f}, {0.6f, -1, -0.6f}, {0.6f, -1, 0.6f}, {-0.6f, -1, 0.6f}, {0, 0.4f, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}};
  return mesh;
}

/// Builds every kernel file in entry/ as a render would.
void build_kernels(Device& device, const CompiledScene& scene, SelfCheck& check,
                   const std::function<void(const std::string&)>& on_stage) {
  const Stopwatch clock;
  const KernelConfig config = make_kernel_config(scene, device.info());
  for (const EmbeddedKernel& file : embedded_kernels()) {
    if (!file.path.starts_with("entry/")) continue;
    on_stage(fmt::format("building {}", file.path));
    device.build(std::string(file.path), config.defines(), nullptr, config.generated);
    ++check.kernels;
  }
  check.build_seconds = clock.seconds();
}

void compare(const CompiledScene& scene, const Image& image, SelfCheck& check) {
  const ImageDifference difference = compare_images(image, render_plain(scene), visible_difference);
  check.pixels = difference.pixels;
  check.differing = difference.over_tolerance;
  check.greatest = difference.max;
  const bool same =
      difference.over_tolerance * pixels_per_flip <= difference.pixels && difference.non_finite == 0;
  check.status = same ? SelfCheck::Status::ok : SelfCheck::Status::differs;
}

}  // namespace

SceneDescription self_check_scene() {
  const auto mesh = std::make_shared<const Mesh>(pyramid());
  return load_scene_document(nlohmann::json::parse(scene_text), "self-check", {}, {{"pyramid", mesh}});
}

SelfCheck check_device(const DeviceInfo& info, const std::function<void(const std::string&)>& on_stage) {
  SelfCheck check;
  try {
    on_stage("opening the device");
    const CompiledScene scene = compile(self_check_scene());
    {
      Device device(info);
      build_kernels(device, scene, check, on_stage);
    }
    on_stage("rendering");
    const Stopwatch clock;
    const Image image = render(scene, {info}).image;
    check.render_seconds = clock.seconds();
    on_stage("comparing");
    compare(scene, image, check);
  } catch (const BuildError& error) {
    check.problem = error.what();
    check.log = error.log;
  } catch (const std::exception& error) {
    check.problem = error.what();
  }
  return check;
}

std::string advice(const std::string& problem, Others others) {
  const auto says = [&](const char* part) { return problem.find(part) != std::string::npos; };
  const bool can_leave = others != Others::none;
  std::string leave =
      others == Others::sound ? "leave it out: --device '!P:D'"
      : others == Others::unasked
          ? "leave it out, --device '!P:D', if one of those that were not asked for is sound: `sundog check` "
            "looks at all"
          : "no other device here is sound: install another driver (Debian: pocl-opencl-icd)";
  if (says("where PoCL writes") || says("what PoCL writes") || says("raise the limit") || says("no linker") ||
      says("RUSTICL_ENABLE"))
    return "";
  if (says("no device"))
    return "its driver finds no hardware that it serves: remove its package, or leave it";
  if (says("crashed") || says("did not come back"))
    return (can_leave ? "update or remove its driver; until then " : "update its driver; ") + leave;
  if (says("did not build") || says("no kernels"))
    return "a fault of its compiler or of sundog: SUNDOG_DUMP_KERNELS=FOLDER keeps the program for a "
           "report; " +
           (can_leave ? "until then " + leave : leave);
  if (says("cannot be loaded")) return "install the library, or remove the .icd file";
  if (says("OpenCL C")) return "it is too old; a newer driver may speak OpenCL C 1.2";
  if (says("MEM_OBJECT") || says("OUT_OF"))
    return "other programs may hold its memory: close them and try again";
  return leave;
}

std::string driver_advice(const std::string& problem, Others others) {
  // Listing devices loads every driver, so --device cannot exclude one that ends the process.
  if (problem.find("crashed") == std::string::npos && problem.find("did not come back") == std::string::npos)
    return advice(problem, others);
  return others == Others::none
             ? "update it, or install another driver (Debian: pocl-opencl-icd)"
             : "update or remove it; until then name a folder with the other .icd files by OCL_ICD_VENDORS";
}

}  // namespace sundog
