// Builds scenes in code and renders their pixels.
#include "scenes.h"

#include <algorithm>
#include <memory>

#include "catch.h"
#include "devices.h"
#include "render/session/render_session.h"
#include "scene/load.h"

namespace scenes {

using namespace sundog;

SceneDescription line_of_sight(glm::dvec3 position, glm::dvec3 target, glm::dvec3 up) {
  SceneDescription scene;
  scene.camera.position = position;
  scene.camera.target = target;
  scene.camera.up = up;
  scene.camera.fov = 1e-3;
  scene.image.width = scene.image.height = 1;
  scene.render.cutoff = 0;
  scene.media.push_back({"world", 1, {0, 0, 0}, 0});
  LightDescription ambient;
  ambient.type = LightType::ambient;
  scene.lights.push_back(ambient);
  return scene;
}

SceneDescription shipped_small(const std::string& name) {
  SceneDescription scene = load_scene(SUNDOG_SOURCE_DIR "/scenes/" + name + ".json");
  scene.image.width = 37;
  scene.image.height = 26;
  scene.render.samples = std::min(scene.render.samples, 3);
  scene.render.max_depth = std::min(scene.render.max_depth, 5);
  return scene;
}

namespace {

int add(SceneDescription& scene, const MaterialDescription& material) {
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

/// Whether the scene's general kernels are those of most test scenes: it has no rare features.
bool shares_kernels(const CompiledScene& scene) {
  const SceneFeatures& has = scene.features;
  return scene.field_source.empty() && scene.pattern_source.empty() && !has.maps && !has.fog && !has.lens &&
         !has.camera_motion && !has.object_motion && !has.dispersion && !has.layers;
}

/// A session for each of test_devices(), in that order. Sessions stay open, so that a process loads each
/// kernel once.
std::vector<std::unique_ptr<RenderSession>>& open_sessions() {
  static std::vector<std::unique_ptr<RenderSession>> sessions;
  return sessions;
}

/// The session of one of test_devices(); null for other devices: sub-devices, and devices with another
/// environment.
RenderSession* session_on(const DeviceInfo& device) {
  const std::vector<DeviceInfo>& devices = test_devices();
  const auto same = [&](const DeviceInfo& one) {
    return one.label() == device.label() && one.environment == device.environment;
  };
  const auto found = std::ranges::find_if(devices, same);
  if (found == devices.end()) return nullptr;
  open_sessions().resize(devices.size());
  auto& session = open_sessions()[static_cast<std::size_t>(found - devices.begin())];
  if (!session) session = std::make_unique<RenderSession>(std::vector{*found});
  return session.get();
}

MaterialDescription dark() {
  MaterialDescription material;
  material.ambient = material.diffuse = material.specular = {0, 0, 0};
  return material;
}

}  // namespace

int add_glow(SceneDescription& scene, glm::dvec3 color) {
  MaterialDescription material = dark();
  material.ambient = color;
  return add(scene, material);
}

int add_dielectric(SceneDescription& scene, double ior, glm::dvec3 absorption, int priority) {
  MaterialDescription material = dark();
  material.type = MaterialType::dielectric;
  material.reflection = material.transmission = {1, 1, 1};
  material.medium = static_cast<int>(scene.media.size());
  scene.media.push_back({"medium" + std::to_string(material.medium), ior, absorption, priority});
  return add(scene, material);
}

int add_white(SceneDescription& scene) {
  MaterialDescription material = dark();
  material.diffuse = {1, 1, 1};
  return add(scene, material);
}

int add_mirror(SceneDescription& scene, double reflection, glm::dvec3 glow) {
  MaterialDescription material = dark();
  material.reflection = glm::dvec3(reflection);
  material.ambient = glow;
  return add(scene, material);
}

void place(SceneDescription& scene, Shape shape, int material, const glm::dmat4& world_from_object) {
  Object object;
  object.shape = shape;
  object.material = material;
  object.world_from_object = world_from_object;
  scene.objects.push_back(object);
}

RenderResult render_on(const DeviceInfo& device, const SceneDescription& scene,
                       const RenderOptions& options) {
  const auto compiled = std::make_shared<const CompiledScene>(compile(scene));
  RenderOptions chosen = options;
  if (device.native_vector_width > 1 && shares_kernels(*compiled)) chosen.kernels = KernelChoice::general;
  RenderSession* session = session_on(device);
  return session ? session->render(compiled, chosen) : render(compiled, {device}, chosen);
}

void close_sessions() { open_sessions().clear(); }

glm::dvec3 pixel_on(const DeviceInfo& device, const SceneDescription& scene) {
  const auto pixel = [&](const SceneDescription& of) {
    const RenderResult result = render_on(device, of);
    return glm::dvec3(result.image.data.at(0), result.image.data.at(1), result.image.data.at(2));
  };
  const glm::dvec3 color = pixel(scene);
  if (device.native_vector_width > 1) {  // other devices use the compact tracer anyway
    SceneDescription compact = scene;
    compact.render.tracer = Tracer::compact;
    const glm::dvec3 other = pixel(compact);
    for (int c = 0; c < 3; ++c) REQUIRE(other[c] == Approx(color[c]).epsilon(1e-5).margin(1e-6));
  }
  return color;
}

}  // namespace scenes
