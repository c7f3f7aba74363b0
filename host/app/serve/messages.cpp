// Makes the server's messages from scene descriptions, devices and snapshots of the session.
#include "app/serve/messages.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/render/stats.h"
#include "base/json_text.h"
#include "scene/integrators.h"
#include "scene/light_groups.h"

namespace sundog {
using nlohmann::json;

namespace {

constexpr std::size_t most_objects = 1000;

json to_json(const dvec3& v) { return {v.x, v.y, v.z}; }

json matrix_json(const dmat4& matrix) {
  json rows = json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) rows.push_back(matrix[column][row]);
  return rows;
}

std::string material_name(const SceneDescription& scene, int material) {
  return material >= 0 && material < std::ssize(scene.materials)
             ? scene.materials[static_cast<std::size_t>(material)].name
             : "";
}

json object_json(const SceneDescription& scene, const Object& object) {
  json row = {
      {"name", object.name}, {"at", object.place}, {"material", material_name(scene, object.material)}};
  if (const auto* shape = std::get_if<FieldShape>(&object.shape)) {
    const SdfDescription& field = scene.fields[static_cast<std::size_t>(shape->field)];
    row["interval"] = {{"min", to_json(field.lower)}, {"max", to_json(field.upper)}};
    row["world"] = matrix_json(object.world_from_object);
  }
  return row;
}

json device_row(const DeviceInfo& device, bool picked) {
  return {{"spec", device.spec()}, {"name", device.name},           {"platform", device.platform_name},
          {"type", device.type},   {"units", device.compute_units}, {"problem", device.problem},
          {"picked", picked}};
}

json activity_json(const DeviceActivity& device) {
  json kernels = json::array();
  for (const auto& [name, times] : device.kernels)
    kernels.push_back({{"name", name},
                       {"launches", times.launches},
                       {"ms", times.device_ms > 0 ? times.device_ms : times.host_ms},
                       {"group", fmt::format("{}x{}", times.local_x, times.local_y)}});
  return {{"spec", device.info.spec()},   {"name", device.info.name},    {"doing", device.doing},
          {"tiles", device.tiles},        {"pixels", device.pixels},     {"share", device.share},
          {"busy", device.busy_seconds},  {"messages", device.messages}, {"notes", device.notes},
          {"kernels", std::move(kernels)}};
}

}  // namespace

std::string message_text(const json& message) { return json_text(message); }

json devices_message(const std::vector<DeviceInfo>& all, const std::vector<DeviceInfo>& picked) {
  json rows = json::array();
  const auto same = [](const DeviceInfo& a, const DeviceInfo& b) {
    return a.platform == b.platform && a.device == b.device;
  };
  for (const DeviceInfo& device : all) {
    if (device.device < 0) continue;
    bool draws = false;
    for (const DeviceInfo& one : picked) draws = draws || same(device, one);
    rows.push_back(device_row(device, draws));
  }
  return {{"is", "devices"}, {"devices", std::move(rows)}};
}

json resolved_json(const SceneDescription& scene) {
  const Camera& camera = scene.camera;
  json objects = json::array();
  for (const Object& object : scene.objects) {
    if (objects.size() == most_objects) break;
    objects.push_back(object_json(scene, object));
  }
  const bool apart = integrator_of(scene.render.integrator).light_parts && !scene.render.caustics;
  const auto groups = apart ? light_groups(scene) : std::vector<std::string>();
  return {{"camera",
           {{"position", to_json(camera.position)},
            {"target", to_json(camera.target)},
            {"up", to_json(camera.up)},
            {"fov", camera.fov},
            {"orthographic", camera.orthographic}}},
          {"width", scene.image.width},
          {"height", scene.image.height},
          {"samples", scene.render.samples},
          {"objects", std::move(objects)},
          {"light_groups", groups},
          {"warnings", scene.warnings}};
}

json scene_message(const SceneDocument& document) {
  return {{"is", "scene"},
          {"version", document.version()},
          {"since", document.opened_version()},
          {"document", document.now()},
          {"opened", document.opened()},
          {"file", document.file().filename().string()},
          {"can_undo", document.can_undo()},
          {"can_redo", document.can_redo()},
          {"resolved", resolved_json(*document.scene())}};
}

json status_message(const Snapshot& now) {
  json devices = json::array();
  for (const DeviceActivity& device : now.devices) devices.push_back(activity_json(device));
  const SessionTimes& times = now.times;
  return {{"is", "status"},
          {"generation", now.generation},
          {"shown", now.shown},
          {"state", static_cast<int>(now.state)},
          {"text", state_text(now)},
          {"settled", now.state == SessionState::settled},
          {"failed", now.state == SessionState::failed},
          {"error", now.error},
          {"samples", now.samples},
          {"wanted_samples", now.wanted_samples},
          {"block", now.block},
          {"fraction", now.fraction},
          {"seconds", now.seconds},
          {"rays", rays_json(now.counts)},
          {"times",
           {{"compiled", times.compiled},
            {"ready", times.ready},
            {"first", times.first},
            {"full", times.full},
            {"settled", times.settled}}},
          {"work",
           {{"bvhs", now.work.compiled.bvhs},
            {"meshes", now.work.compiled.meshes},
            {"fields", now.work.compiled.fields},
            {"bytes_uploaded", now.work.bytes_uploaded},
            {"kernels_built", now.work.kernels_built}}},
          {"devices", std::move(devices)}};
}

json picked_message(const Picked& picked) {
  const SceneDescription& scene = *picked.scene;
  json message = {{"is", "picked"}, {"position", to_json(picked.position)}, {"object", nullptr}};
  if (picked.object < 0 || picked.object >= std::ssize(scene.objects)) return message;
  message["object"] = object_json(scene, scene.objects[static_cast<std::size_t>(picked.object)]);
  message["material"] = material_name(scene, picked.material);
  message["normal"] = to_json(picked.normal);
  message["depth"] = std::isfinite(picked.depth) ? json(picked.depth) : json(nullptr);
  return message;
}

}  // namespace sundog
