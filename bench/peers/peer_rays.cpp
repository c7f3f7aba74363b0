// Loads a model, chooses a part of the device, and frames the model for its rays.
#include "peer_rays.h"

#include <nlohmann/json.hpp>

#include "base/environment.h"
#include "base/file.h"
#include "models/model.h"
#include "render/device/kernel_config.h"
#include "scene/load.h"

namespace sundog {
namespace {

/// A model's objects without lights, or a .json scene unchanged.
SceneDescription scene_of_model(const std::string& path) {
  if (lower_extension(path) == ".json") return load_scene(path, {}, {.outside_files = true});
  Model model = load_model(path, {.for_paths = false});
  SceneDescription scene;
  scene.file = path;
  scene.media.resize(1);
  scene.materials = std::move(model.materials);
  scene.meshes = std::move(model.meshes);
  scene.objects = std::move(model.objects);
  return scene;
}

CompiledScene compiled(const SceneDescription& description, const std::string& tracer) {
  CompiledScene scene = compile(description);
  if (tracer != "auto") scene.tracer = tracer == "wide" ? Tracer::wide : Tracer::compact;
  return scene;
}

/// A CPU is cut to options.threads compute units; a GPU is used as a whole.
DeviceInfo chosen_device(const RayOptions& options) {
  DeviceInfo info = select_devices(enumerate_devices(plain_environment()), {options.device}).at(0);
  info.sub_units = info.type == "cpu" && options.threads < info.compute_units ? options.threads : 0;
  return info;
}

}  // namespace

void add_ray_options(Arguments& app, RayOptions& options) {
  add_peer_options(app, options);
  app.add_option("--device", options.device, "SPEC of the device");
  app.add_option("--size", options.size, "pixels along each side of the image");
  app.add_option("--kinds", options.kinds, "kinds of rays; all without it")->one_of(ray_kinds);
}

PeerModel::PeerModel(const std::string& model, const RayOptions& options)
    : path(model),
      description(scene_of_model(model)),
      scene(compiled(description, options.tracer)),
      device(chosen_device(options)),
      tracer(device, scene) {}

const char* PeerModel::tracer_name() const {
  return traces_compact(scene, device.info()) ? "compact" : "wide";
}

std::vector<RaySet> PeerModel::rays(const RayOptions& options) {
  const TraceFunction trace = [&](std::span<const Ray> given) { return tracer.trace(given); };
  const Viewpoint view = framing_viewpoint(scene, {0.25f, 0.2f, 1.0f}, trace);
  return frame_rays(scene, view, options.size, trace, options.kinds);
}

nlohmann::json PeerModel::facts() const {
  return {{"model", path},
          {"triangles", scene.figures.triangles},
          {"device", device.info().label()},
          {"driver", device.info().driver},
          {"tracer", tracer_name()}};
}

}  // namespace sundog
